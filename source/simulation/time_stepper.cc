// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one step in time, implicit or explicit, with its rejections.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/simulation/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

namespace tanktread
{
  namespace
  {
    constexpr double allowed_energy_rise = 1e-6; // in a step with Time/Tolerance > 0, in a liquid at rest

    double
    root_mean_square_distance(const ShellFields &x, const ShellFields &y, const ShellLayout &layout)
    {
      double sum = 0.;
      for (std::size_t c = 0; c < x.size(); ++c)
        sum += (x[c] - y[c]).squaredNorm();
      return std::sqrt(layout.sum(sum) / layout.capsules().n_control_points());
    }
  } // namespace


  TimeStepper::TimeStepper(const TimeParameters &parameters,
                           const TimeCoupling    coupling,
                           const double          end_time,
                           Scene                &scene,
                           StepMemory           &memory,
                           Log                  &log,
                           const bool            even)
    : parameters_(parameters)
    , coupling_(coupling)
    , end_time_(end_time)
    , scene_(scene)
    , memory_(memory)
    , log_(log)
    , points_along_(even ? std::make_unique<PointsAlong>(scene) : nullptr)
  {}


  void
  TimeStepper::start(const double time, const ShellFields &x)
  {
    memory_.history.add(time, x);
    memory_.energy.start(scene_, x);
  }


  void
  TimeStepper::refine_around(State &state, const std::vector<ShellFields> &others)
  {
    // All pressures those of the sides on which the vertices are now: the sides themselves do not outlive the mesh.
    scene_.level().move_points(state);
    std::vector<State *>            levels = {&state};
    std::vector<FluidBlockVector *> flows  = {&state.fluid};
    for (StepMemory::Level &level : memory_.previous)
      {
        scene_.level().carry_pressure(level.state);
        levels.push_back(&level.state);
        flows.push_back(&level.state.fluid);
      }
    for (State *const level : levels)
      level->sides.clear();
    const FieldTransfer transfer(scene_.fluid().space(), flows);
    const double        finest_cell = scene_.level().finest_cell();
    scene_.refine_around(state, others);
    if (const double h = scene_.level().finest_cell(); std::abs(h / finest_cell - 1.) > 1e-9)
      {
        std::ostringstream text;
        text << "Finest cells of the fluid are " << h << " a from now on (Finest cell in gaps): the smallest gap is " << scene_.gap(state).gap << " a.";
        log_.line(text.str());
      }
    transfer.interpolate(scene_.fluid().space(), flows);
    scene_.level().move_points(state);
    for (StepMemory::Level &level : memory_.previous)
      scene_.level().carry_pressure(level.state);
  }


  void
  TimeStepper::reassign(const CapsuleMoves &moves, State &state)
  {
    state.capsules = moves.moved(state.capsules);
    for (StepMemory::Level &level : memory_.previous)
      level.state.capsules = moves.moved(level.state.capsules);
    memory_.history.reassign([&](const ShellFields &x) { return moves.moved(x); });
  }


  StepResult
  TimeStepper::step(State &state, const double time, const bool last_mesh)
  {
    if (points_along_)
      points_along_->begin_step(scene_.level().shell_velocity(state));
    StepResult result = coupling_ == TimeCoupling::explicit_euler ? explicit_step(state, time) : implicit_step(state, time, last_mesh);
    if (!result.beyond_mesh)
      {
        const ShellFields x = positions(state);
        if (!points_along_) // which does discrete work of its own
          result.energy_rise = memory_.energy.rise(scene_, x);
        memory_.energy.add(scene_, x);
      }
    return result;
  }


  NewtonReport
  TimeStepper::try_step(const State &state, const double time, const double length, const Start from, State &next)
  {
    Levels levels = {{time, &state}};
    if (from == Start::extrapolation)
      for (const StepMemory::Level &level : memory_.previous)
        levels.emplace_back(level.time, &level.state);
    const NewtonReport report = solve_stages(memory_.history, state, time, length, from, std::move(levels), next);
    if (!report.converged)
      {
        constexpr const char *names[] = {"extrapolated state", "last state", "last state by continuation"};
        std::ostringstream    text;
        text << "Step of length " << length << " failed from the " << names[int(from)] << ": " << report.message << " (residuals";
        for (const double residual : report.residuals)
          text << ' ' << residual;
        log_.line(text.str() + ").");
      }
    return report;
  }


  std::optional<ShellFields>
  TimeStepper::first_step_by_second_order(const State &state, const double time, const double length, StepResult &result)
  {
    if (parameters_.tolerance > 0. || order(parameters_.scheme) > 1 || !memory_.history.is_at_start())
      return {};
    TimeParameters second = parameters_;
    second.scheme         = TimeScheme::sdirk2;
    StepHistory history(second);
    history.add(time, positions(state));
    State              end;
    const NewtonReport report = solve_stages(history, state, time, length, Start::last, {{time, &state}}, end);
    result.newton_iterations += report.newton_iterations;
    result.linear_iterations += report.linear_iterations;
    if (!report.converged || scene_.coupling().jumps().n_coarse_cut_cells() > 0)
      return {};
    return positions(end);
  }


  std::string
  TimeStepper::refusal(const State &next, const double length)
  {
    std::string  result = scene_.refusal(next);
    const double rise   = parameters_.tolerance > 0. && !points_along_ ? memory_.energy.rise(scene_, positions(next)) : 0.;
    if (result.empty() && rise > allowed_energy_rise)
      {
        std::ostringstream text;
        text << "the energy of the shells would rise by " << rise << " of what it was, in a liquid at rest";
        result = text.str();
      }
    if (!result.empty())
      log_.line("Step of length " + std::to_string(length) + " rejected: " + result + '.');
    return result;
  }


  std::string
  TimeStepper::attempts(const State &state, const double time, const bool first_attempt, StepResult &result, State &next)
  {
    std::string failure;
    for (const Start from : {Start::extrapolation, Start::last, Start::continuation})
      {
        if (from == Start::extrapolation && (memory_.previous.empty() || !first_attempt))
          continue;
        if (from == Start::continuation && (parameters_.tolerance > 0. || !first_attempt)) // steps whose length is free are halved: that costs less
          continue;
        const NewtonReport report = try_step(state, time, result.length, from, next);
        result.newton_iterations += report.newton_iterations;
        result.linear_iterations += report.linear_iterations;
        if (report.converged)
          return refusal(next, result.length);
        failure = report.message;
      }
    return failure;
  }


  bool
  TimeStepper::accept_step(State &state, const double time, const double shortest, const std::optional<ShellFields> &reference, State &next, StepResult &result)
  {
    const double       length  = result.length;
    const ShellFields  x       = positions(next);
    const ShellFields  normals = points_along_ ? unit_normals(scene_.level().shells(next)) : ShellFields();
    const ShellLayout &layout  = scene_.layout();
    const double       error   = reference ? root_mean_square_distance(x, *reference, layout)
                                           : std::sqrt(layout.sum(memory_.history.squared_error(length, x, normals)) / layout.capsules().n_control_points());
    // One answer for all ranks: logarithms and powers may differ in the last digit between kinds of processors.
    const double factor = dealii::Utilities::MPI::broadcast(scene_.communicator(), memory_.history.length_factor(error), 0);
    memory_.next_length = std::min(parameters_.step, factor * length);
    if (parameters_.tolerance > 0. && error > 2. * parameters_.tolerance)
      {
        const bool         repeats = memory_.next_length >= shortest;
        std::ostringstream text;
        text << "Step of length " << length << (repeats ? " repeated" : " accepted, since there is no shorter one, though") << ": its local error is " << error
             << ", Time/Tolerance " << parameters_.tolerance << '.';
        log_.line(text.str());
        if (repeats)
          return false;
        memory_.next_length = shortest;
      }
    if (error > 0.)
      result.local_error = error;
    memory_.previous.push_front({time, std::move(state)});
    if (memory_.previous.size() > 2)
      memory_.previous.pop_back();
    state = std::move(next);
    memory_.history.add(time + length, x);
    return true;
  }


  std::vector<ShellFields>
  TimeStepper::predicted(const State &state, const double time)
  {
    if (coupling_ == TimeCoupling::explicit_euler)
      return {};
    // Capsules travel steadily; what a stiff shell does in a step cannot be told from its velocity.
    const double      length = next_length(state, time);
    ShellFields       result = positions(state);
    const ShellFields undisturbed =
      memory_.previous.empty() ? scene_.coupling().undisturbed_velocity(scene_.level().flow(), scene_.level().shells(state)) : ShellFields();
    for (std::size_t c = 0; c < result.size(); ++c)
      {
        const Eigen::RowVector3d velocity =
          memory_.previous.empty() ?
            Eigen::RowVector3d(undisturbed[c].colwise().mean()) :
            Eigen::RowVector3d((result[c] - memory_.previous.front().state.capsules[c].x).colwise().mean() / (time - memory_.previous.front().time));
        result[c].rowwise() += length * velocity;
      }
    if (!scene_.contains(result))
      return {};
    return {result};
  }


  double
  TimeStepper::next_length(const State &state, const double time) const
  {
    return std::min({memory_.next_length, longest_step(state), end_time_ - time, longest_start(state)});
  }


  double
  TimeStepper::longest_start(const State &state) const
  {
    double farthest = 0.1; // a, or of the radius of smaller capsules
    for (unsigned int k = 0; k < scene_.capsules().n_kinds(); ++k)
      farthest = std::min(farthest, 0.1 * std::cbrt(3. / (4. * M_PI) * scene_.capsules().kind(k).volume()));
    if (parameters_.tolerance == 0. || !memory_.previous.empty())
      return std::numeric_limits<double>::infinity();
    const ShellFields velocity    = scene_.level().shell_velocity(state);
    const ShellFields undisturbed = scene_.coupling().undisturbed_velocity(scene_.level().flow(), scene_.level().shells(state));
    double            sum         = 0.;
    for (std::size_t c = 0; c < velocity.size(); ++c)
      sum += (velocity[c] - undisturbed[c]).squaredNorm();
    return farthest / std::sqrt(scene_.layout().sum(sum) / scene_.capsules().n_control_points());
  }


  StepResult
  TimeStepper::implicit_step(State &state, const double time, const bool last_mesh)
  {
    StepResult result;
    State      next;
    memory_.shortest    = std::min({memory_.shortest, 1e-3 * parameters_.step, 0.05 * longest_start(state)});
    const double wanted = next_length(state, time), shortest = std::min(wanted, memory_.shortest);
    bool         first_attempt = true;
    std::string  failure;
    const auto   reference = first_step_by_second_order(state, time, wanted, result);
    for (result.length = wanted; result.length >= shortest;)
      {
        failure       = attempts(state, time, first_attempt, result, next);
        first_attempt = false;
        if (failure.empty() && scene_.coupling().jumps().n_coarse_cut_cells() > 0)
          {
            if (!last_mesh)
              {
                result.beyond_mesh = positions(next);
                return result;
              }
            failure = "the shells leave the finest cells of the fluid";
            log_.line("Step of length " + std::to_string(result.length) + " rejected: " + failure + '.');
          }
        if (!failure.empty())
          {
            log_.line("Step of length " + std::to_string(result.length) + " halved.");
            result.length *= 0.5;
          }
        else if (accept_step(state, time, shortest, result.length == wanted ? reference : std::nullopt, next, result))
          return result;
        else
          result.length = memory_.next_length;
      }
    std::ostringstream message;
    message << "No time step between " << shortest << " and " << wanted << " could be solved (none is tried below " << memory_.shortest
            << "); the last attempt: " << failure << '.';
    throw NumericalError(message.str());
  }


  void
  TimeStepper::check_explicit_step(const ControlPoints &displacement, const double length) const
  {
    const double largest = std::sqrt(displacement.rowwise().squaredNorm().maxCoeff());
    if (!(largest < 1.))
      {
        std::ostringstream message;
        message << "The explicit coupling is unstable at this step: a control point would move by " << largest << " a in one step of " << length
                << ". Take a smaller Time/Step or Solver/Coupling = implicit.";
        throw NumericalError(message.str());
      }
  }


  StepResult
  TimeStepper::explicit_step(State &state, const double time)
  {
    StepResult result;
    result.length        = std::min(longest_step(state), end_time_ - time);
    ShellFields velocity = scene_.level().shell_velocity(state);
    if (points_along_)
      {
        ShellFields w;
        on_all_ranks(scene_.communicator(), [&] { w = points_along_->velocity(scene_.level().shells(state), result.length); });
        for (std::size_t c = 0; c < velocity.size(); ++c)
          velocity[c] += w[c];
      }
    State next = state;
    on_all_ranks(scene_.communicator(), [&] {
      for (std::size_t c = 0; c < velocity.size(); ++c)
        {
          check_explicit_step(result.length * velocity[c], result.length);
          next.capsules[c].x += result.length * velocity[c];
        }
    });
    try
      {
        result.linear_iterations = scene_.solver().solve_flow(next, time + result.length);
      }
    catch (const NumericalError &error)
      {
        throw NumericalError(std::string("The explicit coupling failed at this step: ") + error.what() +
                             " Take a smaller Time/Step or Solver/Coupling = implicit.");
      }
    if (const std::string reason = scene_.refusal(next); !reason.empty())
      throw NumericalError("The explicit coupling failed at this step: " + reason + ". Take a smaller Time/Step or Solver/Coupling = implicit.");
    state = std::move(next);
    memory_.history.add(time + result.length, positions(state));
    return result;
  }
} // namespace tanktread
