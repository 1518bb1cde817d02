// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Newton's method for a time level.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tanktread
{
  namespace
  {
    /** tau = 0. */
    Linearisation
    frozen_shells(const double h)
    {
      Linearisation result;
      result.h           = h;
      result.derivatives = PointDerivatives::frozen;
      return result;
    }
  } // namespace


  NewtonSolver::NewtonSolver(const SolverParameters &parameters, TimeLevel &level, SolverMemory &memory, Timings &timings)
    : parameters_(parameters)
    , level_(level)
    , memory_(memory)
    , timings_(timings)
    , layout_(level.coupling().n_capsules(), level.coupling().capsule().n_control_points(), level.elasticity().communicator())
    , volume_(level.coupling().capsule().volume())
    , implicit_shells_(level.coupling().capsule(), layout_, memory)
  {}


  double
  NewtonSolver::speed(const Residual &r, const double tau) const
  {
    double       sum = 0., of_volumes = 0.;
    Eigen::Index n = 0;
    for (const Residual::OfCapsule &capsule : r.capsules)
      {
        sum += capsule.x.squaredNorm();
        n += capsule.x.rows();
        of_volumes += std::pow(capsule.flux, 2) + std::pow(capsule.volume / tau, 2);
      }
    return std::sqrt(r.shell_speed * r.shell_speed + sum / (n * tau * tau) + of_volumes / std::pow(3. * volume_, 2));
  }


  double
  NewtonSolver::norm(const Residual &r, const double tau) const
  {
    double       sum = 0.;
    Eigen::Index n   = 0;
    for (unsigned int c = 0; c < r.capsules.size(); ++c)
      {
        sum += implicit_shells_.velocity(c, r.capsules[c].force).squaredNorm();
        n += r.capsules[c].force.rows();
      }
    sum = dealii::Utilities::MPI::sum(sum, layout_.communicator());
    return dealii::Utilities::MPI::broadcast(layout_.communicator(), std::hypot(speed(r, tau), std::sqrt(sum / n)), 0);
  }


  bool
  NewtonSolver::is_solved(const Residual &r, const double norm) const
  {
    bool volumes = true;
    for (const Residual::OfCapsule &capsule : r.capsules)
      volumes = volumes && std::abs(capsule.volume) <= parameters_.volume_tolerance * volume_;
    return norm <= parameters_.newton_tolerance && volumes;
  }


  LinearisedShells
  NewtonSolver::linearised(const State &state, const Linearisation &choice)
  {
    const Timings::Scope           scope(timings_, "Shell tangent and factorisation");
    std::vector<VelocityGradients> gradients(layout_.n_capsules());
    if (choice.derivatives == PointDerivatives::complete)
      gradients = level_.coupling().velocity_gradients(state.fluid);
    if (level_.inertia() != nullptr)
      level_.inertia()->linearise(state.fluid);
    return {level_.elasticity(), level_.coupling(), state, level_.shells(state), level_.shell_velocity(state), std::move(gradients), choice, implicit_shells_};
  }


  unsigned int
  NewtonSolver::max_linear_iterations(const double tau) const
  {
    // With an exact tangent that is indefinite the solver gets nowhere; a definite one needs a few dozen iterations, more with viscosities that differ much.
    const double ratio = level_.liquids().viscosity_ratio, contrast = std::sqrt(std::max(ratio, 1. / ratio));
    return contrast * (memory_.tangent == Tangent::exact && tau > 0. ? std::min(100u, parameters_.max_linear_iterations) : parameters_.max_linear_iterations);
  }


  LinearReport
  NewtonSolver::linear_solve(const Residual &r, const LinearisedShells &shells, const double tolerance, State &increment)
  {
    const Timings::Scope     scope(timings_, "Linear solver");
    const Fluid             &fluid   = level_.fluid();
    const Inertia *const     inertia = shells.tau() > 0. ? level_.inertia() : nullptr;
    const MonolithicOperator matrix(fluid.stokes(), shells, layout_, &timings_, inertia);
    if (!pressure_jumps_)
      {
        const Timings::Scope jump_scope(timings_, "- pressure jumps");
        pressure_jumps_.emplace(FluidOperator{fluid.stokes(), inertia},
                                fluid.preconditioner(),
                                level_.coupling(),
                                volume_ / level_.liquids().mean_viscosity(),
                                krylov_basis_);
      }
    const MonolithicPreconditioner preconditioner(fluid.preconditioner(), shells, layout_, *pressure_jumps_, &timings_);

    ShellFields dx0, zeros;
    for (unsigned int c = 0; c < shells.size(); ++c)
      {
        dx0.push_back(shells[c].displacement_of_residual(r.capsules[c].x, r.capsules[c].volume));
        zeros.push_back(ControlPoints::Zero(dx0[c].rows(), 3));
      }
    FluidBlockVector rhs = layout_.vector(fluid.space()), solution(rhs);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      rhs.block(b).equ(-1., r.fluid.block(b));
    if (shells.points_move())
      level_.coupling().spread_with_motion(zeros, dx0, shells.densities(), rhs);
    for (unsigned int c = 0; c < shells.size(); ++c)
      layout_.set(rhs, c, r.capsules[c].flux + shells[c].flux(zeros[c], dx0[c]), shells.damped(c, -r.capsules[c].force - shells[c].stiffness_times(dx0[c])));
    const LinearReport report = solve_fgmres(matrix, preconditioner, solution, rhs, tolerance, max_linear_iterations(shells.tau()), krylov_basis_);
    set_increment(solution, r, dx0, shells, increment);
    return report;
  }


  void
  NewtonSolver::set_increment(const FluidBlockVector &solution, const Residual &r, const ShellFields &dx0, const LinearisedShells &shells, State &increment)
    const
  {
    level_.fluid().space().reinit(increment.fluid);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      increment.fluid.block(b) = solution.block(b);
    const std::vector<ShellUnknowns> unknowns = layout_.unknowns(solution);
    ExtendedForces                   extended;
    level_.coupling().extend(densities(unknowns), extended);
    const ShellFields moments = level_.coupling().velocity_moments(solution, extended);
    increment.capsules.resize(shells.size());
    for (unsigned int c = 0; c < shells.size(); ++c)
      {
        CapsuleState &capsule = increment.capsules[c];
        capsule.pressure_jump = unknowns[c].pressure_jump;
        capsule.x             = dx0[c] + shells[c].displacement(moments[c]);
        capsule.volume_shift  = shells[c].volume_shift(moments[c], r.capsules[c].x, capsule.x);
        capsule.force         = shells[c].force_change(shells[c].force(unknowns[c].density), capsule.x);
        // All ranks have computed this alike up to rounding, which differs between kinds of processors: one answer for all, so that they take the same
        // decisions.
        MPI_Bcast(capsule.x.data(), capsule.x.size(), MPI_DOUBLE, 0, layout_.communicator());
        MPI_Bcast(capsule.force.data(), capsule.force.size(), MPI_DOUBLE, 0, layout_.communicator());
        MPI_Bcast(&capsule.volume_shift, 1, MPI_DOUBLE, 0, layout_.communicator());
      }
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


  std::string
  NewtonSolver::iterate(State &state, Residual &r, const TimeStep &step, Progress &progress, NewtonReport &report)
  {
    const bool             near     = progress.length < 0.25 * level_.finest_cell();
    const bool             complete = near && !progress.cautious && level_.coupling().knows_motion();
    const LinearisedShells shells   = linearised(state,
                                               {step.tau,
                                                  level_.finest_cell(),
                                                  motion_accuracy(progress.length / step.tau),
                                                complete ? PointDerivatives::complete : PointDerivatives::frozen,
                                                  memory_.tangent,
                                                  level_.flow(),
                                                  level_.liquids().mean_viscosity()});
    if (report.residuals.empty())
      report.residuals.push_back(norm(r, step.tau));
    State              increment;
    const LinearReport linear = linear_solve(r, shells, forcing_term(report.residuals.back()), increment);
    implicit_shells_.watch(linear);
    ++report.newton_iterations;
    report.linear_iterations += linear.iterations;
    if (!linear.converged)
      return "the linear solver did not converge in " + std::to_string(linear.iterations) + " iterations";
    report.step_lengths.push_back(line_search(state, r, increment, step, progress));
    report.residuals.push_back(norm(r, step.tau));
    return report.step_lengths.back() == 0. ? "Newton's direction does not reduce the residual" : "";
  }


  double
  NewtonSolver::distance_allowed(const Progress &progress) const
  {
    // Positions within a small part of a cell, which shrinks with the solver's tolerance, are as good as any. A node of the fluid that changes sides makes the
    // residual jump, and now and
    // then shell and node would chase each other for ever: then a larger part has to do.
    constexpr unsigned int patience = 8;
    const double           h        = level_.finest_cell();
    return progress.n_moves < patience ? std::min(0.002 * h, 100. * parameters_.newton_tolerance) : 0.02 * h;
  }


  bool
  NewtonSolver::follow_shells(State &state, Progress &progress)
  {
    const Timings::Scope scope(timings_, "Residual");
    const double tolerance = distance_allowed(progress);
    const bool   moves     = trial_points() == Points::stay && level_.coupling().distance(level_.shells(state)) > tolerance;
    const bool   mixes     = level_.viscosity_distance(state) > tolerance;
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


  void
  NewtonSolver::use(const Tangent tangent)
  {
    memory_.tangent = tangent;
    implicit_shells_.discard();
  }


  void
  NewtonSolver::react(const std::string &failure, const bool renewed, Progress &progress)
  {
    if (!renewed)
      implicit_shells_.discard(); // perhaps they were too old: the same iteration again, with new ones
    else if (memory_.tangent == Tangent::exact)
      use(Tangent::positive);
    else
      throw NumericalError(failure);
    progress.cautious = memory_.tangent == Tangent::positive;
  }


  void
  NewtonSolver::iterate_to_solution(State &trial, const TimeStep &step, NewtonReport &report)
  {
    if (level_.has_viscosities())
      {
        level_.set_viscosity(trial);
        level_.move_points(trial);
        level_.update_jumps(trial);
      }
    Residual r = level_.residual(trial, step, level_.has_viscosities() ? Points::stay : Points::follow);
    Progress progress;
    progress.length = dealii::Utilities::MPI::broadcast(layout_.communicator(), step.tau * speed(r, step.tau), 0);
    while (!progress.solved)
      {
        if (report.newton_iterations == parameters_.max_newton_iterations)
          throw NumericalError("no convergence in " + std::to_string(report.newton_iterations) + " Newton iterations");
        if (trial_points() == Points::follow && !report.step_lengths.empty() && report.step_lengths.back() < 1.)
          level_.move_points(trial); // where a rejected trial has left it
        if (progress.length < 0.25 * level_.finest_cell() && !progress.cautious && memory_.tangent == Tangent::positive)
          use(Tangent::exact);
        const unsigned int renewals = implicit_shells_.n_renewals();
        const std::string  failure  = iterate(trial, r, step, progress, report);
        if (!failure.empty())
          react(failure, implicit_shells_.n_renewals() > renewals, progress);
        if (!progress.followed && follow_shells(trial, progress))
          {
            r                       = level_.residual(trial, step, trial_points());
            report.residuals.back() = norm(r, step.tau);
            progress.followed       = true;
          }
        if (progress.followed)
          progress.settled = progress.settled || report.residuals.back() <= 10. * parameters_.newton_tolerance ||
            2 * report.newton_iterations >= parameters_.max_newton_iterations;
        progress.solved = is_solved(r, report.residuals.back());
        progress.length = step.tau * report.residuals.back();
      }
  }


  NewtonReport
  NewtonSolver::solve(State &state, const TimeStep &step)
  {
    NewtonReport report;
    State        trial = state;
    pressure_jumps_.reset();
    level_.begin(step);
    try
      {
        iterate_to_solution(trial, step, report);
        report.converged = true;
        state            = std::move(trial);
      }
    catch (const NumericalError &error)
      {
        report.message = error.what();
      }
    return report;
  }


  void
  NewtonSolver::start_undisturbed(State &state)
  {
    level_.fluid().space().reinit(state.fluid);
    for (CapsuleState &capsule : state.capsules)
      capsule.pressure_jump = 0.;
    level_.set_forces(state);
    level_.coupling().move(level_.shells(state));
  }


  unsigned int
  NewtonSolver::solve_flow(State &state, const double time)
  {
    constexpr unsigned int n_sweeps = 3; // for the viscous part of the jumps
    level_.begin_at_rest(time);
    pressure_jumps_.reset();
    level_.set_forces(state);
    level_.set_viscosity(state);
    unsigned int iterations = solve_with_fixed_jumps(state, Points::follow);
    for (unsigned int i = 0; i < n_sweeps && level_.has_viscosities() && !level_.coupling().knows_motion(); ++i)
      {
        level_.update_jumps(state);
        iterations += solve_with_fixed_jumps(state, Points::stay);
      }
    return iterations;
  }


  unsigned int
  NewtonSolver::solve_with_fixed_jumps(State &state, const Points points)
  {
    State          increment;
    const Residual r = level_.residual(state, {positions(state), 0.}, points);
    // Relative to the loads of the shells and of unit pressures, not to what the initial guess has left of them.
    double flux = 0.;
    for (const Residual::OfCapsule &capsule : r.capsules)
      flux = std::hypot(flux, capsule.flux);
    const double wanted = std::max(1e-10, 1e-2 * parameters_.newton_tolerance) * level_.loads(state).l2_norm(), given = std::hypot(r.fluid.l2_norm(), flux);
    if (given <= wanted)
      return 0;
    const LinearReport report = linear_solve(r, linearised(state, frozen_shells(level_.finest_cell())), wanted / given, increment);
    if (!report.converged)
      {
        std::ostringstream message;
        message << "The Stokes solver did not converge: residual " << report.final_residual << " after " << report.iterations << " iterations, from "
                << report.initial_residual << '.';
        throw NumericalError(message.str());
      }
    add(state, 1., increment);
    return report.iterations;
  }
} // namespace tanktread
