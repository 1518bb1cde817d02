// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the capsule adds to the stress of the suspension.

#ifndef tanktread_simulation_particle_stress_h
#define tanktread_simulation_particle_stress_h

#include <tanktread/surface/subdivision_surface.h>

namespace tanktread
{
  /**
   * Stresslet of the forces of the shell, the symmetric traceless part of
   *
   *     S_ij = - integral over the shell of x_i f_j dGamma,   f the force of the shell on the liquid per area.
   *
   * With the density M^{-1} F of the nodal forces F (`force`, NP x 3) and positions linear in the control points x (NP x 3) the integral is the sum of x_I
   * F_I^T, exactly.
   * A pressure jump has no part in it: its nodal forces pi dV/dx give pi V times the unit tensor. Unit mu gamma a^3. doc/theory.md, eq. (52a).
   *
   * This is all of the particle stress when the viscosity inside is that outside; otherwise viscous_stress() belongs to it.
   */
  Eigen::Matrix3d
  particle_stress(const ControlPoints &x, const ControlPoints &force);

  /**
   * With the viscosity ratio lambda, (lambda - 1) times the integral of U n + n U over the shell. `velocity` U: of the control points, NP x 3, the undisturbed
   * flow included.
   */
  Eigen::Matrix3d
  viscous_stress(const SubdivisionSurface &surface, const ControlPoints &x, const ControlPoints &velocity, double viscosity_ratio);

  /** What a particle stress means for a dilute suspension in the flow u = (gamma z, 0, 0): differences of it over mu gamma V, doc/theory.md, eq. (52b). */
  struct Rheology
  {
    double intrinsic_viscosity; // [eta] = S_xz / (mu gamma V)
    double normal_difference_1; // (S_xx - S_zz) / (mu gamma V)
    double normal_difference_2; // (S_zz - S_yy) / (mu gamma V)
  };

  /** All of it is not a number without shear. `volume`: of the capsule. */
  Rheology
  rheology(const Eigen::Matrix3d &stress, double volume, double shear_rate);
} // namespace tanktread

#endif
