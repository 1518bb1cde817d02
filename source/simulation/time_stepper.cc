// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one step in time, implicit or explicit, with its rejections.

#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace tanktread
{
  TimeStepper::TimeStepper(const TimeParameters &parameters, const TimeCoupling coupling, const double end_time, NewtonSolver &solver, Log &log)
    : parameters_(parameters)
    , coupling_(coupling)
    , end_time_(end_time)
    , solver_(solver)
    , log_(log)
    , history_(parameters)
    , next_length_(history_.first_length())
  {}


  void
  TimeStepper::start(const double time, const ControlPoints &x)
  {
    history_.add(time, x);
  }


  std::vector<State *>
  TimeStepper::levels(State &state)
  {
    std::vector<State *> result = {&state};
    if (previous_state_)
      result.push_back(previous_state_.get());
    return result;
  }


  void
  TimeStepper::forget_flow()
  {
    previous_state_.reset();
  }


  StepResult
  TimeStepper::step(State &state, const double time)
  {
    return coupling_ == TimeCoupling::explicit_euler ? explicit_step(state, time) : implicit_step(state, time);
  }


  State
  TimeStepper::extrapolated(const State &state, const double length) const
  {
    State guess = state;
    if (!previous_state_)
      return guess;
    const double ratio = length / previous_length_;
    solver_.carry_pressure(guess);
    solver_.carry_pressure(*previous_state_);
    guess.x += ratio * (state.x - previous_state_->x);
    guess.force += ratio * (state.force - previous_state_->force);
    guess.pressure_jump += ratio * (state.pressure_jump - previous_state_->pressure_jump);
    guess.fluid.sadd(1. + ratio, -ratio, previous_state_->fluid);
    return guess;
  }


  NewtonReport
  TimeStepper::try_step(const State &state, const double length, const bool from_extrapolation, State &next)
  {
    const ImplicitStep step = history_.step(length);
    next                    = from_extrapolation ? extrapolated(state, length) : state;
    FluidVector uhat;
    if (solver_.has_inertia())
      {
        const std::array<double, 2> weights = history_.weights(length);
        uhat                                = state.fluid.block(velocity_block);
        uhat *= weights[0];
        if (weights[1] != 0.)
          uhat.add(weights[1], previous_state_->fluid.block(velocity_block));
      }
    const NewtonReport report = solver_.solve(next, step.xhat, step.tau, &uhat);
    if (!report.converged)
      {
        std::ostringstream text;
        text << "Step of length " << length << " failed from the " << (from_extrapolation ? "extrapolated" : "last") << " state: " << report.message
             << " (residuals";
        for (const double residual : report.residuals)
          text << ' ' << residual;
        log_.line(text.str() + ").");
      }
    return report;
  }


  bool
  TimeStepper::accept_step(State &state, const double time, const double length, State &next)
  {
    const double error = history_.local_error(length, next.x), factor = history_.length_factor(error), tolerance = parameters_.tolerance;
    next_length_ = std::min(parameters_.step, factor * length);
    if (tolerance > 0. && error > 2. * tolerance && length > 1e-3 * parameters_.step)
      {
        std::ostringstream text;
        text << "Step of length " << length << " repeated: its local error is " << error << ", Time/Tolerance " << tolerance << '.';
        log_.line(text.str());
        return false;
      }
    previous_state_  = std::make_unique<State>(std::move(state));
    previous_length_ = length;
    state            = std::move(next);
    history_.add(time + length, state.x);
    return true;
  }


  StepResult
  TimeStepper::implicit_step(State &state, const double time)
  {
    StepResult   result;
    State        next;
    const double wanted = std::min(next_length_, end_time_ - time), shortest = std::min(wanted, 1e-3 * parameters_.step);
    bool         first_attempt = true;
    std::string  failure;
    for (result.length = wanted; result.length >= shortest;)
      {
        NewtonReport report;
        for (const bool from_extrapolation : {true, false})
          if (!report.converged && (!from_extrapolation || (previous_state_ && first_attempt)))
            {
              report = try_step(state, result.length, from_extrapolation, next);
              result.newton_iterations += report.newton_iterations;
              result.linear_iterations += report.linear_iterations;
            }
        first_attempt = false;
        if (!report.converged)
          {
            failure = report.message;
            result.length *= 0.5;
          }
        else if (accept_step(state, time, result.length, next))
          return result;
        else
          result.length = next_length_;
      }
    std::ostringstream message;
    message << "No time step between " << shortest << " and " << wanted << " could be solved; the last attempt: " << failure << '.';
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
    result.length              = std::min(parameters_.step, end_time_ - time);
    const ControlPoints change = result.length * solver_.shell_velocity(state);
    check_explicit_step(change, result.length);
    State next = state;
    next.x += change;
    try
      {
        result.linear_iterations = solver_.solve_flow(next);
      }
    catch (const NumericalError &error)
      {
        throw NumericalError(std::string("The explicit coupling failed at this step: ") + error.what() +
                             " Take a smaller Time/Step or Solver/Coupling = implicit.");
      }
    state = std::move(next);
    history_.add(time + result.length, state.x);
    return result;
  }
} // namespace tanktread
