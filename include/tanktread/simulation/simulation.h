// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one run from the initial shapes to the end time.

#ifndef tanktread_simulation_simulation_h
#define tanktread_simulation_simulation_h

#include <tanktread/base/log.h>
#include <tanktread/simulation/checkpoints.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/resolution_monitor.h>
#include <tanktread/simulation/results.h>
#include <tanktread/simulation/run_memory.h>
#include <tanktread/simulation/time_stepper.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace tanktread
{
  /** Sets the scene up and steps it through time. All members are collective. */
  class Simulation
  {
  public:
    /**
     * Everything that can be wrong about the input has been checked by `parameters.check()`; nothing is written before run(). Keeps `parameters` by reference, and
     * `screen`, which the log goes to beside its file.
     */
    Simulation(const Parameters &parameters, MPI_Comm communicator, std::ostream &screen = std::cout);

    /**
     * Makes the output folder and runs to the end time or the steady state. Throws NumericalError, after writing the last good state, when a step cannot be
     * done. Returns the outcome: done, steady or stopped, the latter where a signal or a file had asked for it and a checkpoint has been written.
     *
     * @param resume whether to go on from the newest good checkpoint in the folder, if there is one. Throws InputError where the parameters are others.
     */
    std::string
    run(bool resume = false);

  private:
    void
    make_folder();
    /** Opens the files of the run that `found` is of, and gives it its state. */
    void
    go_on(Checkpoints::Found found);
    void
    start();
    /** Writes a checkpoint if one is due or asked for. Returns whether the run has been asked to end, and can be resumed. */
    bool
    save(bool last);
    /** Steps to the end. Returns the outcome: done, steady or stopped. */
    std::string
    advance();
    /** One step, on a mesh that it fits. */
    StepResult
    step();
    /** The first mesh and the flow on it: Stokes flow, or with inertia that of a liquid at rest. Returns the linear iterations. */
    unsigned int
    first_flow();
    /** New mesh around the present shells, and others if there are any, with the flows carried over. Returns the linear iterations. */
    unsigned int
    refine_around_shells(const std::vector<ShellFields> &others = {});
    /** Gives capsules to the ranks in whose cells they are, if others have them. */
    void
    settle_owners();
    /** Whether the shapes of all capsules have hardly changed in three steps; the same on all ranks. */
    bool
    is_steady(double length);
    /** Whether something that happens at multiples of `interval` (0: always) is due; moves `next` to the next time. */
    bool
    is_due(double &next, double interval) const;
    /** Whether the limits that all shapes relax to have been known to the tolerance in three steps, the last one observed; the same on all ranks. */
    bool
    limits_are_known();

    struct Observed
    {
      ShellFields                     velocities;
      std::vector<CapsuleObservables> capsules;
    };
    /** Observes the present state and remembers it. */
    Observed
    observe_capsules();
    void
    record(const StepResult &step, const Observed &observed, bool last);
    /** Phase angles and samples of the motion. */
    void
    remember(std::vector<CapsuleObservables> &capsules);
    /** Contours asked for at times of the last step; not the present one if `but_now`. */
    void
    add_contours(double length, bool but_now);
    void
    log_step(const StepObservables &step, const Results::History &history);
    /** Says how the capsules have moved, in the log and in summary.csv. */
    void
    summarise(const std::string &outcome);
    double
    rounding() const
    {
      return 1e-9 * parameters_.scene.end_time;
    }

    const Parameters        &parameters_;
    MPI_Comm                 communicator_;
    Log                      log_;
    Scene                    scene_;
    RunMemory                memory_;
    TimeStepper              stepper_;
    State                    state_;
    ResolutionMonitor        resolution_;
    std::unique_ptr<Results> results_;
    Checkpoints              checkpoints_;
  };
} // namespace tanktread

#endif
