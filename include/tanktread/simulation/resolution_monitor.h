// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: measures in each step how well a run is resolved, and warns.

#ifndef tanktread_simulation_resolution_monitor_h
#define tanktread_simulation_resolution_monitor_h

#include <tanktread/base/log.h>
#include <tanktread/simulation/observables.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/resolution_warnings.h>

#include <vector>

namespace tanktread
{
  /** Fills in what CapsuleObservables say about resolution, and tells the log once of each thing that is beyond its threshold. */
  class ResolutionMonitor
  {
  public:
    /** Keeps `scene`, `memory` and `log` by reference. */
    ResolutionMonitor(const Parameters &parameters, Scene &scene, WarningMemory &memory, Log &log);

    /** shape and interface of each of the rank's own capsules. Collective. */
    void
    measure(const State &state, std::vector<CapsuleObservables> &capsules) const;

    /** Warns of what is new in this step, in any capsule. @param capsules the rank's own ones as measured. Collective. */
    void
    check(const State &state, const StepObservables &step, const std::vector<CapsuleObservables> &capsules);

    /** Repeats at the end of a run in short what has been warned of. */
    void
    finish() const;

  private:
    Scene                   &scene_;
    WarningMemory           &memory_;
    Log                     &log_;
    std::vector<MeshQuality> mesh_qualities_; // of the kinds of capsules
    ResolutionContext        context_;
  };
} // namespace tanktread

#endif
