// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Helfrich's bending energy and the two forms of its virtual work.

#ifndef tanktread_shell_helfrich_h
#define tanktread_shell_helfrich_h

#include <Eigen/Core>

namespace tanktread
{
  /** The 15 numbers y that a shell knows at a point: rows a_1, a_2, a_{1,1}, a_{1,2}, a_{2,2}. Also holds derivatives by them. */
  using SurfaceDerivatives = Eigen::Matrix<double, 5, 3, Eigen::RowMajor>;

  /** Derivatives of SurfaceDerivatives by y: index 3 p + c, p the row. */
  using SurfaceDerivativesTangent = Eigen::Matrix<double, 15, 15, Eigen::RowMajor>;

  // All functions are per area of parameter space: multiply by the quadrature weight, not by an area. The modulus is kappa_B, the reference curvature kappa^R
  // has the sign of kappa_m, -1/R on a sphere.

  /** Helfrich (1973): 2 kappa_B (kappa_m - kappa^R)^2 per current area, times sqrt(det a). doc/theory.md, eq. (13). */
  double
  bending_energy(const SurfaceDerivatives &y, double modulus, double reference_curvature);

  /** First and second derivatives of bending_energy() by y; the second only if `tangent` is not null. doc/theory.md, eq. (15). */
  void
  variational_bending(const SurfaceDerivatives  &y,
                      double                     modulus,
                      double                     reference_curvature,
                      SurfaceDerivatives        &gradient,
                      SurfaceDerivativesTangent *tangent);

  /**
   * Work of the bending moments on the change of curvature only, with metric and area held in the variation:
   * r . delta y = 2 kappa_B (kappa_m - kappa^R) a^{alpha beta} delta kappa_{alpha beta} sqrt(det a). Returns the 15 coefficients r in `work` and, if
   * `tangent` is not null, dr/dy, which is not symmetric. Le (2010), eqs. (10), (12), (15); doc/theory.md, eq. (16).
   */
  void
  moment_only_bending(const SurfaceDerivatives &y, double modulus, double reference_curvature, SurfaceDerivatives &work, SurfaceDerivativesTangent *tangent);
} // namespace tanktread

#endif
