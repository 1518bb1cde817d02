// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the positions that a time scheme looks back to, the error of a step and the length of the next.

#ifndef tanktread_simulation_step_history_h
#define tanktread_simulation_step_history_h

#include <tanktread/shell/shell_configuration.h>
#include <tanktread/simulation/time_stepping.h>

#include <deque>
#include <utility>
#include <vector>

namespace tanktread
{
  /** A stage of a step, of all shells: x = xhat + tau dx/dt(x). */
  struct ShellSteps
  {
    ShellFields xhat;
    double      tau;
  };

  /** What makes the explicit part of a stage for other fields than positions. */
  struct StageWeights
  {
    std::vector<double> stages; // of the stages before, in their order
    std::vector<double> levels; // of the levels, newest first
  };

  /** The last positions of all shells, at most four, and the scheme on them. Needs nothing of the fluid, so it outlives changes of its mesh. */
  class StepHistory
  {
  public:
    explicit StepHistory(const TimeParameters &parameters)
      : parameters_(parameters)
    {}

    /** Appends an accepted level; times increase. */
    void
    add(double time, const ShellFields &x);

    /** Replaces the positions of each level by what `moved` makes of them, for capsules that go to other ranks. */
    template <typename Function>
    void
    reassign(const Function &moved)
    {
      for (Level &level : levels_)
        level.x = moved(level.x);
    }

    struct Level
    {
      double      time;
      ShellFields x;
    };
    /** Newest first. */
    const std::deque<Level> &
    levels() const
    {
      return levels_;
    }
    void
    set_levels(std::deque<Level> levels)
    {
      levels_ = std::move(levels);
    }

    /** Whether there is but one level. */
    bool
    is_at_start() const
    {
      return levels_.size() == 1;
    }

    /** Solutions that the next step takes: one for a multistep scheme with enough levels behind it, otherwise those of SDIRK of the same order. */
    unsigned int
    n_stages() const;

    /** Part of the next step's length after which a stage ends; 1 for the last. */
    double
    stage_end(unsigned int i) const;

    /** Stage i of a step of `length` from the last level; `displacements` are those by the velocities of the stages before, tau U. */
    ShellSteps
    stage(unsigned int i, double length, const std::vector<ShellFields> &displacements) const;

    /** The same stage for other fields: their explicit part is a sum over stages and levels with these weights. */
    StageWeights
    stage_weights(unsigned int i, double length) const;

    /**
     * Local error of a step to x (root mean square over the control points, in a), q the order: the term by which the exact motion misses the scheme, its
     * derivative from the divided difference of the last q + 1 levels and x,
     *
     *     multistep: tau (t - t_n) ... (t - t_{n+1-q}) x^(q+1) / (q+1)!,   SDIRK: its constant for linear motion times dt^(q+1) x^(q+1).
     *
     * Zero while there are too few levels to tell, as at the start.
     *
     * @param normals where these are given, unit vectors at the control points, the part along them counts alone: that of the shape.
     */
    double
    local_error(double length, const ShellFields &x, const ShellFields &normals = {}) const;

    /** Its square times the number of control points: over ranks that have different shells these add. */
    double
    squared_error(double length, const ShellFields &x, const ShellFields &normals = {}) const;

    /** Factor by which the length of a step with this local error should change so that it meets Time/Tolerance, between 0.3 and 1.5. */
    double
    length_factor(double local_error) const;

    /** First length: Time/Step, or shorter where the tolerance asks for it: the first steps have no error estimate, so unit acceleration is assumed. */
    double
    first_length() const;

    /** Positions at a time up to the last level: the polynomial through the last three levels, four for schemes of third order, or as many as there are. */
    ShellFields
    at(double time) const;

  private:
    /** SDIRK for the next step, or none: it is a multistep one. */
    const SdirkScheme *
    one_step_scheme() const;
    /** For the next step of that length. */
    MultistepFormula
    multistep(double length) const;
    /** Times of the last `n` levels, newest first, behind that of a new one. */
    std::vector<double>
    times(double length, std::size_t n) const;

    TimeParameters    parameters_;
    std::deque<Level> levels_; // newest first
  };
} // namespace tanktread

#endif
