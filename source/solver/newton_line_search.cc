// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: steps along Newton's directions, and what follows the shells.

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>

#include <algorithm>
#include <utility>

namespace tanktread
{
  double
  NewtonSolver::distance_allowed(const Progress &progress) const
  {
    // Positions within a small part of a cell, which shrinks with the solver's tolerance, are as good as any. A node of the fluid that changes sides makes the
    // residual jump, and now and then shell and node would chase each other for ever, since no shape agrees with either side: then larger parts have to do.
    constexpr unsigned int patience = 8, more_patience = 10;
    const double           h = level_.finest_cell();
    if (progress.n_moves < patience)
      return std::min(0.002 * h, 100. * parameters_.newton_tolerance);
    return progress.n_moves < more_patience ? 0.02 * h : 0.06 * h;
  }


  bool
  NewtonSolver::follow_shells(State &state, Progress &progress)
  {
    const Timings::Scope scope(timings_, "Residual");
    const double         tolerance = distance_allowed(progress);
    const bool           moves     = trial_points() == Points::stay && level_.coupling().distance(level_.shells(state)) > tolerance;
    const bool           mixes     = level_.viscosity_distance(state) > tolerance;
    if (moves)
      level_.move_points(state);
    if (mixes)
      level_.set_viscosity(state);
    progress.n_moves += moves || mixes;
    const bool sweeps = !progress.settled && level_.has_viscosities() && trial_points() == Points::stay;
    if (sweeps)
      level_.update_jumps(state);
    return moves || mixes || sweeps;
  }


  bool
  NewtonSolver::has_to_follow(const ShellFields &x, const Progress &progress)
  {
    if (trial_points() == Points::follow)
      return false;
    if (level_.has_viscosities() && !progress.settled)
      return true;
    State shapes; // no flow is needed to tell
    shapes.capsules.resize(x.size());
    for (std::size_t c = 0; c < x.size(); ++c)
      shapes.capsules[c].x = x[c];
    return level_.coupling().distance(level_.shells(shapes)) > distance_allowed(progress);
  }


  bool
  NewtonSolver::accept_if_better(State &state, Residual &r, const State &increment, const TimeStep &step, const double length, const Points points)
  {
    try
      {
        const double before = norm(r, step.tau);
        State        trial  = state;
        add(trial, length, increment);
        Residual     r_trial = level_.residual(trial, step, points);
        const double after   = norm(r_trial, step.tau);
        if (after > (1. - 1e-4 * length) * before && !is_solved(r_trial, after))
          return false;
        state = std::move(trial);
        r     = std::move(r_trial);
        return true;
      }
    catch (const NumericalError &)
      {
        return false; // the trial shell is degenerate or out of the box: a shorter step
      }
  }


  bool
  NewtonSolver::accept_following(State &state, Residual &r, const State &increment, const TimeStep &step, Progress &progress)
  {
    const double before = norm(r, step.tau);
    try
      {
        State trial = state;
        add(trial, 1., increment);
        follow_shells(trial, progress);
        Residual     r_trial = level_.residual(trial, step, trial_points());
        const double after   = norm(r_trial, step.tau);
        if (after < (1. - 1e-4) * before || is_solved(r_trial, after))
          {
            state = std::move(trial);
            r     = std::move(r_trial);
            return true;
          }
      }
    catch (const NumericalError &)
      {
        // the trial shell is degenerate or out of the box
      }
    level_.set_viscosity(state);
    level_.move_points(state);
    if (level_.has_viscosities() && !progress.settled)
      level_.update_jumps(state);
    return false;
  }


  double
  NewtonSolver::line_search(State &state, Residual &r, const State &increment, const TimeStep &step, Progress &progress)
  {
    // What has to follow afterwards may do so at once: where the residual falls even so, it need not be computed twice.
    ShellFields x = positions(state);
    for (std::size_t c = 0; c < x.size(); ++c)
      x[c] += increment.capsules[c].x;
    progress.followed = has_to_follow(x, progress) && accept_following(state, r, increment, step, progress);
    if (progress.followed)
      return 1.;
    for (double length = 1.; length > 0.05; length *= 0.5)
      if (accept_if_better(state, r, increment, step, length, trial_points()))
        return length;
    return 0.;
  }
} // namespace tanktread
