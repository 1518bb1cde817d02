// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one run from the initial shape to the end time.

#ifndef tanktread_simulation_simulation_h
#define tanktread_simulation_simulation_h

#include <tanktread/base/log.h>
#include <tanktread/base/timings.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/phase_angles.h>
#include <tanktread/simulation/results.h>
#include <tanktread/simulation/time_stepper.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** Sets the scene up and steps it through time. All members are collective. */
  class Simulation
  {
  public:
    /** Everything that can be wrong about the input has been checked by `parameters.check()`; nothing is written before run(). */
    Simulation(const Parameters &parameters, MPI_Comm communicator);

    /** Makes the output folder and runs to the end time or the steady state. Throws NumericalError, after writing the last good state, when a step cannot be done. */
    void
    run();

  private:
    void
    make_folder();
    void
    start();
    void
    advance();
    /** New mesh around the present shell, with a zero flow, or with those that inertia remembers. */
    void
    refine_around_shell();
    /** The flow there, to start with or to extrapolate from: Stokes flow, or with inertia what has been carried over. Returns the linear iterations. */
    unsigned int
    flow_on_new_mesh();
    bool
    is_steady(const InertiaEllipsoid &before, const InertiaEllipsoid &after, double length);
    /** Whether something that happens at multiples of `interval` (0: always) is due; moves `next` to the next time. */
    bool
    is_due(double &next, double interval) const;
    void
    record(const StepResult &step, bool last);
    /** Contours asked for at times of the last step; not the present one if `but_now`. */
    void
    add_contours(double length, bool but_now);
    /** Says how the capsule has moved, in the log and in summary.csv. */
    void
    summarise(const std::string &outcome);

    const Parameters            &parameters_;
    MPI_Comm                     communicator_;
    bool                         first_rank_;
    Timings                      timings_;
    Log                          log_;
    FittedShape                  shape_;
    SubdivisionSurface           surface_;
    Shell                        shell_;
    DistributedShell             distributed_shell_;
    Fluid                        fluid_;
    SubdivisionSurface           coupling_surface_;
    Coupling                     coupling_;
    ShellView                    view_;
    ShearFlow                    flow_;
    NewtonSolver                 solver_;
    TimeStepper                  stepper_;
    State                        state_;
    double                       time_    = 0.;
    unsigned int                 n_steps_ = 0, n_quiet_steps_ = 0, remeshing_iterations_ = 0;
    double                       next_fields_, next_history_ = 0.;
    std::unique_ptr<PhaseAngles> phase_; // from the first record on
    std::vector<MotionSample>    motion_;
    InertiaEllipsoid             ellipsoid_{};
    std::unique_ptr<Results>     results_;
  };
} // namespace tanktread

#endif
