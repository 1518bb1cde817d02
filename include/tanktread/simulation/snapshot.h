// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: all that the rest of a run follows from, in bytes.

#ifndef tanktread_simulation_snapshot_h
#define tanktread_simulation_snapshot_h

#include <tanktread/fluid/placed_values.h>
#include <tanktread/simulation/results.h>
#include <tanktread/simulation/run_memory.h>
#include <tanktread/solver/scene.h>

#include <map>
#include <string>
#include <vector>

namespace tanktread
{
  /** Parts of a run, by reference. */
  struct RunParts
  {
    Scene     &scene;
    RunMemory &memory;
    State     &state;
  };

  /**
   * What a rank has of a run between two steps. Capsules are told by their numbers, each by the leader of its team, nodes of the liquid by their places: other numbers of ranks find what they need in the snapshots of all.
   */
  struct Snapshot
  {
    std::string                         common;   // the same on all ranks
    std::map<unsigned int, std::string> capsules; // by number
    PlacedValues                        velocities, pressures;
  };

  /**
   * Takes it. Where shells keep LU factors from step to step these are given up, for the run that goes on as for the one that is resumed. Collective.
   */
  Snapshot
  take_snapshot(RunParts run);

  /**
   * Gives a run that has not begun what a snapshot of the same scene had. @param known what this rank has read of the snapshots, in any division among the ranks; `common` on all of them. The same numbers, bit by
   * bit, follow on as many ranks as had taken it. Collective. Throws InputError where the scene is another one.
   */
  void
  restore(RunParts run, Snapshot known);

  /** As bytes, and back. Throws InputError for bytes that are no snapshot. */
  std::string
  bytes_of(const Snapshot &snapshot);
  Snapshot
  snapshot_of(const std::string &bytes);
} // namespace tanktread

#endif
