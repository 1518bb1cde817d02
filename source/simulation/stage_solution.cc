// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how a TimeStepper solves the stages of a step: from what guesses, and by continuation.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/simulation/time_stepper.h>

#include <algorithm>
#include <utility>

namespace tanktread
{
  State
  TimeStepper::extrapolation(const Levels &levels, const double time) const
  {
    const std::size_t          n = std::min<std::size_t>(levels.size(), 3);
    std::vector<State>         carried;
    std::vector<const State *> states;
    std::vector<double>        weights;
    for (std::size_t i = 0; i < n; ++i)
      {
        carried.push_back(*levels[i].second);
        scene_.level().carry_pressure(carried.back());
        double weight = 1.;
        for (std::size_t j = 0; j < n; ++j)
          if (j != i)
            weight *= (time - levels[j].first) / (levels[i].first - levels[j].first);
        weights.push_back(weight);
      }
    for (const State &state : carried)
      states.push_back(&state);
    return combination(weights, states);
  }


  FluidVector
  TimeStepper::uhat(const StageWeights &weights, const State &state, const std::deque<State> &stages) const
  {
    FluidVector result;
    if (!scene_.level().has_inertia())
      return result;
    result = state.fluid.block(velocity_block);
    result *= weights.levels[0];
    for (std::size_t i = 1; i < weights.levels.size(); ++i)
      result.add(weights.levels[i], memory_.previous[i - 1].state.fluid.block(velocity_block));
    for (std::size_t j = 0; j < stages.size(); ++j)
      result.add(weights.stages[j], stages[j].fluid.block(velocity_block));
    return result;
  }


  ShellFields
  TimeStepper::displacement(const State &stage, const ShellFields &xhat) const
  {
    const ShellConfigurations &shells = scene_.level().shells(stage);
    ShellFields                result;
    for (std::size_t c = 0; c < shells.size(); ++c)
      result.push_back(stage.capsules[c].x - xhat[c] - stage.capsules[c].volume_shift * shells[c]->normal_field());
    return result;
  }


  NewtonReport
  TimeStepper::continued(const State &start, const TimeStep &step, State &next)
  {
    constexpr double       shortest       = 1. / 16.;
    constexpr unsigned int few_iterations = 6;
    NewtonReport           report;
    State                  here = start, before;
    double                 s = 0., s_before = 0., ds = 0.5;
    while (s < 1. && ds >= shortest)
      {
        const double end    = std::min(s + ds, 1.);
        Levels       levels = {{s, &here}};
        if (s > 0.)
          levels.emplace_back(s_before, &before);
        TimeStep part = step;
        part.tau *= end;
        for (std::size_t c = 0; c < part.xhat.size(); ++c)
          part.xhat[c] = (1. - end) * start.capsules[c].x + end * step.xhat[c];
        FluidVector uhat;
        if (scene_.level().has_inertia())
          {
            uhat = *step.uhat;
            uhat.sadd(end, 1. - end, start.fluid.block(velocity_block));
            part.uhat = &uhat;
          }
        State              trial   = extrapolation(levels, end);
        const NewtonReport of_part = scene_.solver().solve(trial, part);
        report.newton_iterations += of_part.newton_iterations;
        report.linear_iterations += of_part.linear_iterations;
        report.residuals = of_part.residuals;
        report.message   = of_part.message;
        if (!of_part.converged)
          {
            ds = 0.5 * (end - s);
            continue;
          }
        before   = std::exchange(here, std::move(trial));
        s_before = std::exchange(s, end);
        if (of_part.newton_iterations < few_iterations)
          ds *= 2.;
      }
    report.converged = s == 1.;
    if (report.converged)
      next = std::move(here);
    return report;
  }


  NewtonReport
  TimeStepper::solve_stage(const Start from, const State &last, ShellSteps step, const FluidVector &uhat, const double time, const double length, State &next)
  {
    if (points_along_)
      try
        {
          ShellFields w;
          on_all_ranks(scene_.communicator(), [&] { w = points_along_->velocity(scene_.level().shells(next), length); });
          for (std::size_t c = 0; c < w.size(); ++c)
            step.xhat[c] += step.tau * w[c];
        }
      catch (const NumericalError &error) // the guess is degenerate
        {
          NewtonReport report;
          report.message = error.what();
          return report;
        }
    const TimeStep problem = {step.xhat, step.tau, time, &uhat};
    return from == Start::continuation ? continued(last, problem, next) : scene_.solver().solve(next, problem);
  }


  NewtonReport
  TimeStepper::solve_stages(const StepHistory &history,
                            const State       &state,
                            const double       time,
                            const double       length,
                            const Start        from,
                            Levels             levels,
                            State             &next)
  {
    const unsigned int       n = history.n_stages();
    std::deque<State>        stages; // does not move what it holds, which `levels` points to
    std::vector<ShellFields> displacements;
    NewtonReport             report;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double      end       = time + history.stage_end(i) * length;
        const ShellSteps  step      = history.stage(i, length, displacements);
        const FluidVector uhat      = this->uhat(history.stage_weights(i, length), state, stages);
        next                        = extrapolation(levels, end);
        const NewtonReport of_stage = solve_stage(from, *levels.front().second, step, uhat, end, length, next);
        report.converged            = of_stage.converged;
        report.message              = of_stage.message;
        report.residuals            = of_stage.residuals;
        report.newton_iterations += of_stage.newton_iterations;
        report.linear_iterations += of_stage.linear_iterations;
        if (!report.converged || i + 1 == n || scene_.coupling().jumps().n_coarse_cut_cells() > 0)
          break;
        displacements.push_back(displacement(next, step.xhat));
        stages.push_back(std::move(next));
        levels.emplace_front(end, &stages.back());
      }
    return report;
  }
} // namespace tanktread
