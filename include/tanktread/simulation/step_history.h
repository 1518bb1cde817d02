// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the positions that a time scheme looks back to, the error of a step and the length of the next.

#ifndef tanktread_simulation_step_history_h
#define tanktread_simulation_step_history_h

#include <tanktread/shell/shell_configuration.h>
#include <tanktread/simulation/time_stepping.h>

#include <array>
#include <deque>

namespace tanktread
{
  /** One implicit step of all shells in the form x = xhat + tau dx/dt(x). */
  struct ShellSteps
  {
    ShellFields xhat;
    double      tau;
  };

  /** The last positions of all shells, at most three, and the scheme on them. Needs nothing of the fluid, so it outlives changes of its mesh. */
  class StepHistory
  {
  public:
    explicit StepHistory(const TimeParameters &parameters)
      : parameters_(parameters)
    {}

    /** Appends an accepted level; times increase. */
    void
    add(double time, const ShellFields &x);

    /** Whether the next step has no two levels to look back to though the scheme wants them: it is one of SDIRK2, first_stage() and then second_stage(). */
    bool
    starts() const
    {
      return parameters_.scheme == TimeScheme::bdf2 && levels_.size() == 1;
    }

    /** The scheme for a step of `length` from the last level; not where it starts(). */
    ShellSteps
    step(double length) const;

    /** The stages of a step of SDIRK2; `displacement` is that by the velocities of the first stage, tau U. */
    ShellSteps
    first_stage(double length) const;
    ShellSteps
    second_stage(double length, const ShellFields &displacement) const;

    /** What weighs the last level and the one before in ShellSteps::xhat of step(), for other fields with the same scheme. */
    std::array<double, 2>
    weights(double length) const;

    /** The same of second_stage(): what weighs the first stage and the last level. */
    static std::array<double, 2>
    second_stage_weights();

    /**
     * Local error of a step to x (root mean square over the control points, in a), from the divided differences of the positions,
     *
     *     backward Euler: 1/2 dt^2 x'',   BDF2: (1 + omega)^2 / (6 omega (1 + 2 omega)) dt^3 x''',
     *
     * the terms by which the exact motion misses the scheme. Zero while there are too few levels to tell, as at the start.
     */
    double
    local_error(double length, const ShellFields &x) const;

    /** Factor by which the length of a step with this local error should change so that it meets Time/Tolerance, between 0.3 and 1.5. */
    double
    length_factor(double local_error) const;

    /** First length: Time/Step, or shorter where the tolerance asks for it: the first two steps have no error estimate, so unit acceleration is assumed. */
    double
    first_length() const;

    /**
     * Positions at a time up to the last level: the parabola through the last three levels, the straight line through two, the only one. As accurate as the
     * schemes where it lies between the last two.
     */
    ShellFields
    at(double time) const;

  private:
    bool
    is_second_order() const
    {
      return parameters_.scheme == TimeScheme::bdf2;
    }

    /** That formula for each capsule, with its number. */
    template <typename Formula>
    ShellSteps
    each_capsule(const Formula &formula) const;

    struct Level
    {
      double      time;
      ShellFields x;
    };

    TimeParameters    parameters_;
    std::deque<Level> levels_; // newest first
  };
} // namespace tanktread

#endif
