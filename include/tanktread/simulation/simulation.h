// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one run from the initial shape to the end time.

#ifndef tanktread_simulation_simulation_h
#define tanktread_simulation_simulation_h

#include <tanktread/base/log.h>
#include <tanktread/base/timings.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/results.h>
#include <tanktread/solver/newton_solver.h>

#include <memory>

namespace tanktread
{
  /** Sets the scene up and steps it through time. All members are collective. */
  class Simulation
  {
  public:
    /** Everything that can be wrong about the input has been checked by `parameters.check()`; the output folder is made here. `revision`: program and version for the log. */
    Simulation(const Parameters &parameters, MPI_Comm communicator);

    /** Runs to the end time or the steady state. Throws NumericalError, after writing the last good state, when a step cannot be done. */
    void
    run();

  private:
    /** Length of the next step and how it went. */
    struct StepResult
    {
      double       length            = 0.;
      unsigned int newton_iterations = 0;
      unsigned int linear_iterations = 0;
    };

    void
    start();
    void
    refine_around_shell();
    StepResult
    implicit_step();
    StepResult
    explicit_step();
    State
    extrapolated(double length) const;
    void
    check_explicit_step(const ControlPoints &displacement) const;
    bool
    is_steady(const InertiaEllipsoid &before, const InertiaEllipsoid &after, double length) const;
    void
    record(const StepResult &step, bool last);
    ControlPoints
    shell_velocity() const;

    const Parameters                   &parameters_;
    MPI_Comm                            communicator_;
    bool                                first_rank_;
    Timings                             timings_;
    Log                                 log_;
    FittedShape                         shape_;
    SubdivisionSurface                  surface_;
    Shell                               shell_;
    SubdivisionSurface                  coupling_surface_;
    Coupling                            coupling_;
    ShellView                           view_;
    UndisturbedFlow                     flow_;
    Fluid                               fluid_;
    NewtonSolver                        solver_;
    State                               state_;
    double                              time_        = 0.;
    double                              next_length_;
    unsigned int                        n_steps_     = 0;
    double                              next_fields_ = 0., next_history_ = 0.;
    ControlPoints                       previous_x_;          // of the step before, empty at the start
    std::unique_ptr<State>              previous_state_;      // none right after a change of mesh
    double                              previous_length_ = 0.;
    InertiaEllipsoid                    ellipsoid_{};
    std::unique_ptr<Results>            results_;
  };
} // namespace tanktread

#endif
