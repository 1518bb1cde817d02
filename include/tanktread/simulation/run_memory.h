// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run carries from one step to the next beside the state and the solver's memory.

#ifndef tanktread_simulation_run_memory_h
#define tanktread_simulation_run_memory_h

#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/phase_angles.h>
#include <tanktread/simulation/resolution_warnings.h>
#include <tanktread/simulation/rest_energy.h>
#include <tanktread/simulation/step_history.h>
#include <tanktread/solver/state.h>
#include <tanktread/surface/surface_geometry.h>

#include <deque>
#include <limits>
#include <vector>

namespace tanktread
{
  /** What the time scheme looks back to, and the length of the next step. */
  struct StepMemory
  {
    /** Of a run that has not begun. */
    explicit StepMemory(const TimeParameters &parameters)
      : history(parameters)
      , next_length(history.first_length())
    {}

    struct Level
    {
      double time;
      State  state;
    };

    StepHistory       history;
    RestEnergy        energy;
    double            next_length;
    double            shortest = std::numeric_limits<double>::infinity(); // length below which none is tried
    std::deque<Level> previous; // levels before the present one, newest first, two at most; their flows are on the present mesh
  };

  /** One capsule as outputs remember it. */
  struct CapsuleMemory
  {
    PhaseAngles               phase;
    InertiaEllipsoid          ellipsoid; // at the last record
    std::vector<MotionSample> motion;
  };

  /** With State, SolverMemory, the mesh and what Coupling holds, all that the rest of a run follows from: what a checkpoint has to write. */
  struct RunMemory
  {
    explicit RunMemory(const TimeParameters &parameters)
      : steps(parameters)
    {}

    double                     time    = 0.;
    unsigned int               n_steps = 0;
    StepMemory                 steps;
    unsigned int               n_quiet_steps        = 0; // in which the shapes have hardly changed, the last ones
    unsigned int               n_known_steps        = 0; // in which their limits were known to the tolerance, the last ones
    double                     next_fields = 0., next_history = 0., next_checkpoint = 0.;
    WarningMemory              warnings;
    std::vector<CapsuleMemory> capsules; // from the first record on
  };
} // namespace tanktread

#endif
