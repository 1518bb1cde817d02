// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid's part of a snapshot.

#ifndef tanktread_simulation_snapshot_fluid_h
#define tanktread_simulation_snapshot_fluid_h

#include <tanktread/simulation/snapshot.h>

namespace tanktread
{
  /** How much there is of what has no fixed number. */
  struct SnapshotCounts
  {
    unsigned int n_ranks = 0, n_capsules = 0, n_previous = 0, n_history = 0, n_mesh_sets = 0, finest_level = 0, n_viscous = 0;
    bool         has_viscosity = false, has_memory = false, has_sides = false;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &n_ranks &n_capsules &n_previous &n_history &n_mesh_sets &finest_level &n_viscous &has_viscosity &has_memory &has_sides;
    }
  };

  /** Velocities and pressures of the present level and those before, the sides of the vertices, and the viscous forces there. */
  void
  take_fluid(RunParts run, const SnapshotCounts &counts, Snapshot &snapshot);

  /** Fills the fluid's part of the present level and of those before, on the mesh that they were on; the viscous forces go to `viscous`. Collective. */
  void
  restore_fluid(RunParts run, const SnapshotCounts &counts, const Snapshot &known, ShellJumps::ViscousForces &viscous);
} // namespace tanktread

#endif
