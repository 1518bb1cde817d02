// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one step in time, implicit or explicit, with its rejections.

#ifndef tanktread_simulation_time_stepper_h
#define tanktread_simulation_time_stepper_h

#include <tanktread/base/log.h>
#include <tanktread/simulation/step_history.h>
#include <tanktread/solver/newton_solver.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** Length of a step and what it took, rejected attempts included. */
  struct StepResult
  {
    double       length            = 0.;
    unsigned int newton_iterations = 0;
    unsigned int linear_iterations = 0;
  };

  /**
   * Moves a State from one time level to the next. An implicit step that Newton's method does not solve is tried again from the last level instead of the extrapolated
   * guess, then with half its length; one whose local error exceeds Time/Tolerance is repeated with a shorter length; lengths grow back by at most 1.5. Failed attempts are
   * said in the log. All calls are collective.
   */
  class TimeStepper
  {
  public:
    /** `solver` and `log` are kept by reference. */
    TimeStepper(const TimeParameters &parameters, TimeCoupling coupling, double end_time, NewtonSolver &solver, Log &log);

    /** The first level. */
    void
    start(double time, const ControlPoints &x);

    /** What the time scheme looks back to: `state`, the last level, and the one before, if there is one. Where there is inertia their flows are to be carried over changes of mesh. */
    std::vector<State *>
    levels(State &state);

    /** To be called when the fluid's mesh has changed and the flows of levels() are not carried over: nothing is extrapolated over that. The positions of the shell stay known to the scheme. */
    void
    forget_flow();

    /**
     * One step from `time`, not beyond the end time. Throws NumericalError, with `state` as it was, when no length down to a thousandth of Time/Step can be solved or the
     * explicit coupling is unstable.
     */
    StepResult
    step(State &state, double time);

    /** Positions of the shell at a time of the last step. */
    ControlPoints
    position(const double time) const
    {
      return history_.at(time);
    }

  private:
    StepResult
    implicit_step(State &state, double time);
    /** One attempt at a step: sets `next` to the new level, or says in the log why not. */
    NewtonReport
    try_step(const State &state, double length, bool from_extrapolation, State &next);
    /** Makes `next` the present state, if its local error allows it, and sets the length of the step to come. */
    bool
    accept_step(State &state, double time, double length, State &next);
    StepResult
    explicit_step(State &state, double time);
    void
    check_explicit_step(const ControlPoints &displacement, double length) const;
    State
    extrapolated(const State &state, double length) const;

    TimeParameters         parameters_;
    TimeCoupling           coupling_;
    double                 end_time_;
    NewtonSolver          &solver_;
    Log                   &log_;
    StepHistory            history_;
    double                 next_length_;
    std::unique_ptr<State> previous_state_; // none at the start and right after a change of mesh
    double                 previous_length_ = 0.;
  };
} // namespace tanktread

#endif
