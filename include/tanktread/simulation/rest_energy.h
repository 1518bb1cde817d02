// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the energy of shells in a liquid at rest, which can only fall.

#ifndef tanktread_simulation_rest_energy_h
#define tanktread_simulation_rest_energy_h

#include <tanktread/solver/scene.h>

namespace tanktread
{
  /**
   * The energy of all shells of a scene without flow and inertia: dE/dt = -u^T A u <= 0 whatever the mesh, so that a rise is an error of the step or of the solver (doc/theory.md, section 5.3). Of scenes with flow or
   * inertia, and of shells whose forces have no energy, nothing is known: rises are not numbers.
   */
  struct RestEnergy
  {
    double last  = 0.; // of the last level
    double scale = 0.; // what rises are relative to: the energy at the start, at least a unit of the shell's moduli

    /** @param x control points at the start. Collective. */
    void
    start(const Scene &scene, const ShellFields &x);

    /** (E(x) - last) / scale, the same on all ranks. Collective. */
    double
    rise(const Scene &scene, const ShellFields &x) const;

    /** The next level. Collective. */
    void
    add(const Scene &scene, const ShellFields &x);
  };
} // namespace tanktread

#endif
