// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid beyond the box.

#ifndef tanktread_solver_unbounded_liquid_h
#define tanktread_solver_unbounded_liquid_h

#include <tanktread/fluid/prescribed_velocity.h>
#include <tanktread/shell/shell_configuration.h>
#include <tanktread/solver/state.h>

namespace tanktread
{
  /**
   * Velocities on the faces of a box in unbounded liquid: the disturbance that the shells make there (doc/theory.md, section 3.4),
   *
   *     u(x) = 1/(8 pi) sum_I [1/|y| + y y^T/|y|^3] (F + pi v)_I + (1 - lambda)/(8 pi) sum_I 6 y (y . U_I)(y . v_I)/|y|^5,   y = x - x_I,
   *
   * the sums over the control points of all shells, v = dV/dx the area vectors that belong to them, lambda the viscosity inside and U the whole velocity of a shell
   * less its mean, which contributes nothing. Total force, moments x F^T of the forces and v U^T of the velocities are those of the surfaces exactly; what is left
   * of second moments on falls faster with the distance and with the square of the control points' distances.
   */
  class UnboundedLiquid
  {
  public:
    /** Shells may not come nearer to a face, in a: the cells there could not follow the flow between. */
    static constexpr double least_distance = 0.5;

    /** As PrescribedVelocity. @param viscosity_ratio inside over outside. */
    UnboundedLiquid(const TaylorHoodSpace &space, double viscosity_ratio);

    /** Makes the velocities on the faces those of `state`. @param shells at its positions. @param velocities U, read with another viscosity inside only. Collective. */
    void
    set(const State &state, const ShellConfigurations &shells, const ShellFields &velocities);

    PrescribedVelocity &
    faces()
    {
      return faces_;
    }

  private:
    const double       viscosity_ratio_;
    PrescribedVelocity faces_;
  };
} // namespace tanktread

#endif
