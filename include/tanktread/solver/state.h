// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the unknowns of a time level.

#ifndef tanktread_solver_state_h
#define tanktread_solver_state_h

#include <tanktread/coupling/jump_enrichment.h>
#include <tanktread/fluid/undisturbed_flow.h>
#include <tanktread/surface/types.h>

namespace tanktread
{
  /** The undisturbed flow (shear_rate * z, 0, 0); all fluid unknowns are disturbances of it. */
  struct ShearFlow
  {
    double shear_rate = 0.;

    /** Velocity at positions given as rows. */
    ControlPoints
    velocity(const ControlPoints &positions) const
    {
      ControlPoints result = ControlPoints::Zero(positions.rows(), 3);
      result.col(0)        = shear_rate * positions.col(2);
      return result;
    }

    /** Its gradient, entry (c, d) being du_c/dx_d. */
    Eigen::Matrix3d
    gradient() const
    {
      Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
      result(0, 2)           = shear_rate;
      return result;
    }

    UndisturbedFlow
    in_fluid() const
    {
      return simple_shear(shear_rate);
    }
  };

  /**
   * Unknowns (u, p, pi, x, F, sigma) of one time level. The nodal forces F equal f(x) in a solution; keeping them as unknowns lets Newton's method step over the stiffness
   * of the shell: f varies much more on the way to the solution than anything that the fluid feels.
   */
  struct State
  {
    ControlPoints    x;                  // control points, NP x 3, in a
    ControlPoints    force;              // F, NP x 3
    FluidBlockVector fluid;              // disturbance velocity (blocks 0-2) and pressure (block 3), condensed: constrained entries are zero
    VertexSides      sides;              // on which side of the shell the pressure's vertices were, see Coupling::carry_pressure()
    double           volume_shift  = 0.; // sigma: displacement along m = M^{-1} dV/dx, in a, that undoes the volume error of the time scheme
    double           pressure_jump = 0.; // pi: pressure of the capsule's interior above that of the continuous field
  };
} // namespace tanktread

#endif
