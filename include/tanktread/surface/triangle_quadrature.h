// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: symmetric quadrature rules on the unit triangle.

#ifndef tanktread_surface_triangle_quadrature_h
#define tanktread_surface_triangle_quadrature_h

#include <Eigen/Core>

namespace tanktread
{
  /** Points (xi_1, xi_2) of the triangle xi_1, xi_2 >= 0, xi_1 + xi_2 <= 1, one a row, and their weights, which sum to 1/2. */
  struct TriangleQuadrature
  {
    Eigen::Matrix<double, Eigen::Dynamic, 2> points;
    Eigen::VectorXd                          weights;
  };

  /**
   * The fully symmetric rule with interior points and positive weights that has `n_points` points: 1, 3, 6, 7 or 12, exact for polynomials of degree
   * 1, 2, 4, 5 or 6 (Strang & Fix 1973; Dunavant 1985). Each of the `n_subdivisions` splits every triangle into four similar ones with the
   * rule in each, so there are n_points * 4^n_subdivisions points. Throws InputError for other numbers of points or more than 5 subdivisions.
   */
  TriangleQuadrature
  triangle_quadrature(unsigned int n_points, unsigned int n_subdivisions = 0);
} // namespace tanktread

#endif
