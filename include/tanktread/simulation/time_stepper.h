// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one step in time, implicit or explicit, with its rejections.

#ifndef tanktread_simulation_time_stepper_h
#define tanktread_simulation_time_stepper_h

#include <tanktread/base/log.h>
#include <tanktread/simulation/capsule_moves.h>
#include <tanktread/simulation/points_along.h>
#include <tanktread/simulation/run_memory.h>
#include <tanktread/solver/scene.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /** Length of a step and what it took, rejected attempts included. */
  struct StepResult
  {
    double       length            = 0.;
    unsigned int newton_iterations = 0;
    unsigned int linear_iterations = 0;
    double       local_error       = std::numeric_limits<double>::quiet_NaN(); // of the step, in a, see StepHistory; not a number where it is not known
    double       energy_rise       = std::numeric_limits<double>::quiet_NaN(); // of the shells, over RestEnergy::scale; not a number with flow or inertia
    std::optional<ShellFields>
      beyond_mesh; // no step was made, since shells that end here cut cells that are not finest ones; to be tried again on a mesh around them too
  };

  /**
   * Moves a State from one time level to the next. An implicit step that Newton's method does not solve is tried again from the last level instead of the
   * extrapolated
   * guess, then along a path of shorter steps, then with half its length; one whose shells overlap at its end, with half its length; one whose local error exceeds Time/Tolerance is repeated with
   * a shorter length, and so is one in which the energy of the shells rises in a liquid at rest; lengths grow back by at most 1.5. Failed attempts are
   * said in the log.
   *
   * With Time/Tolerance = 0 errors and rises are measured only. The first step of backward Euler, which has no levels behind it to measure its error by, is compared with one of SDIRK2. All calls are collective.
   */
  class TimeStepper
  {
  public:
    /**
     * All of class type but `parameters` are kept by reference.
     *
     * @param even whether control points are moved along the shells, see EvenMesh: then local errors are those of the shapes alone, and steps end at
     * PointsAlong::longest_step().
     */
    TimeStepper(const TimeParameters &parameters, TimeCoupling coupling, double end_time, Scene &scene, StepMemory &memory, Log &log, bool even = false);

    /** The first level. */
    void
    start(double time, const ShellFields &x);

    /**
     * Adapts the fluid's mesh to the shells of `state`, and to `others`, as Scene::refine_around(), and carries over the flows of `state`, which has one, and
     * of the levels before it: what the guess of the next step is made of and, where there is inertia, what the scheme looks back to.
     */
    void
    refine_around(State &state, const std::vector<ShellFields> &others = {});

    /** Where the shells will about be after the next step from `time`, carried on as they are: what the mesh is made for before it is taken. Nothing for explicit steps, whose flow is of the shells as they are, and where that is outside of the box. Collective. */
    std::vector<ShellFields>
    predicted(const State &state, double time);

    /** Sends what the levels before have of the capsules to their teams to come, and that of `state`. To be called before Scene::reassign(). */
    void
    reassign(const CapsuleMoves &moves, State &state);

    /**
     * One step from `time`, not beyond the end time. Throws NumericalError, with `state` as it was, when no length down to a thousandth of Time/Step, or
     * to a twentieth of longest_start() if that is less, can be
     * solved or the
     * explicit coupling is unstable.
     *
     * @param last_mesh whether no other mesh will be made for this step: then steps with shells beyond its finest cells, at their end or the end of a stage, are
     * shortened instead of reported.
     */
    StepResult
    step(State &state, double time, bool last_mesh);

    /** Positions of the shells at a time of the last step. */
    ShellFields
    position(const double time) const
    {
      return memory_.history.at(time);
    }

  private:
    /** Of the next step's first attempt. */
    double
    next_length(const State &state, double time) const;
    /** With a tolerance, for the first step, whose error is not known: how long the shells take for a tenth of a at the speed that they themselves give the liquid at the start, root mean square. */
    double
    longest_start(const State &state) const;
    /** Time/Step, or less where control points move along the shells. */
    double
    longest_step(const State &state) const
    {
      return points_along_ ? std::min(parameters_.step, PointsAlong::longest_step(scene_, state)) : parameters_.step;
    }
    StepResult
    implicit_step(State &state, double time, bool last_mesh);
    /** Levels with their times, newest first. */
    using Levels = std::deque<std::pair<double, const State *>>;
    /** Where Newton's method starts from. */
    enum class Start
    {
      extrapolation, // the levels before, continued in time
      last,          // the last level or stage
      continuation   // the same, by way of shorter steps
    };
    /** One attempt at a step: sets `next` to the new level, or says in the log why not. With a stage beyond the finest cells, `next` is that stage. */
    NewtonReport
    try_step(const State &state, double time, double length, Start from, State &next);
    /**
     * Solves a stage along a path: for growing s, up to 1, the problem with (1 - s) x + s xhat in place of xhat, x the positions of `start`, and with s tau.
     * `start` solves it for s = 0. Each solution starts from the straight line through the last two; parts of the path that fail are halved, down to a
     * sixteenth of the whole.
     */
    NewtonReport
    continued(const State &start, const TimeStep &step, State &next);
    /** One stage: `next`, a guess, becomes its solution. @param last the level or stage before, from which continuation starts. */
    NewtonReport
    solve_stage(Start from, const State &last, ShellSteps step, const FluidVector &uhat, double time, double length, State &next);
    /** Solves the stages of a step as `history` has them, from guesses made of the stages before and of `levels`. The last one solved, or not solved, is in `next`. */
    NewtonReport
    solve_stages(const StepHistory &history, const State &state, double time, double length, Start from, Levels levels, State &next);
    /** Positions by SDIRK2 at the end of the first step of backward Euler, what they took in `result`; none in other steps, with Time/Tolerance > 0, or if they cannot be computed. */
    std::optional<ShellFields>
    first_step_by_second_order(const State &state, double time, double length, StepResult &result);
    /** Why the step to `next` must not be accepted, or nothing; said in the log. */
    std::string
    refusal(const State &next, double length);
    /** Explicit part of the velocity of a stage in a liquid with inertia; otherwise empty. */
    FluidVector
    uhat(const StageWeights &weights, const State &state, const std::deque<State> &stages) const;
    /** What the velocities have moved in a stage: not what sets the volume right, which is done once for the whole step. */
    ShellFields
    displacement(const State &stage, const ShellFields &xhat) const;
    /** Attempts from the extrapolated state, from the last one, and by continuation, the first and the last of these at the first attempt only, the last with Time/Tolerance = 0 only. Returns why they failed, or nothing. */
    std::string
    attempts(const State &state, double time, bool first_attempt, StepResult &result, State &next);
    /** Makes `next` the present state, if its local error allows it, and sets the length of the step to come. @param reference see first_step_by_second_order(). */
    bool
    accept_step(State &state, double time, double shortest, const std::optional<ShellFields> &reference, State &next, StepResult &result);
    StepResult
    explicit_step(State &state, double time);
    void
    check_explicit_step(const ControlPoints &displacement, double length) const;
    /** The polynomial in time through these levels, three at most, with the pressures of the present sides of vertices, at `time`. */
    State
    extrapolation(const Levels &levels, double time) const;

    const TimeParameters parameters_;
    const TimeCoupling   coupling_;
    const double         end_time_;
    Scene               &scene_;
    StepMemory          &memory_;
    Log                 &log_;

    const std::unique_ptr<PointsAlong> points_along_; // none where control points are material
  };
} // namespace tanktread

#endif
