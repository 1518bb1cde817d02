// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the unknowns of a time level.

#ifndef tanktread_solver_state_h
#define tanktread_solver_state_h

#include <tanktread/coupling/vertex_sides.h>
#include <tanktread/fluid/types.h>
#include <tanktread/shell/shell_configuration.h>

#include <vector>

namespace tanktread
{
  /** Unknowns (x, F, pi, sigma) of one capsule. The nodal forces F equal f(x) in a solution; keeping them as unknowns lets Newton's method step over the stiffness
   * of the shell: f varies much more on the way to the solution than anything that the fluid feels. */
  struct CapsuleState
  {
    ControlPoints x;                  // control points, NP x 3, in a
    ControlPoints force;              // F, NP x 3
    double        pressure_jump = 0.; // pi: pressure of the capsule's interior above that of the continuous field
    double        volume_shift  = 0.; // sigma: displacement along m = M^{-1} dV/dx, in a, that undoes the volume error of the time scheme
  };

  /** Unknowns of one time level: the liquid's and each capsule's. */
  struct State
  {
    FluidBlockVector          fluid; // disturbance velocity and pressure, condensed: constrained entries are zero
    std::vector<CapsuleState> capsules;
    VertexSides               sides; // inside which shells the pressure's vertices were, see Coupling::carry_pressure()
  };

  /** Control points of all capsules. */
  ShellFields
  positions(const State &state);

  /** Nodal forces F of all capsules. */
  ShellFields
  forces(const State &state);

  /** state += factor increment, the sides excepted. */
  void
  add(State &state, double factor, const State &increment);

  /** Sum of weights times states, but for sigma and the sides, which are those of the first. */
  State
  combination(const std::vector<double> &weights, const std::vector<const State *> &states);
} // namespace tanktread

#endif
