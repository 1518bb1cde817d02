// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: distance to the surface from its second-order shape at nearby points.

#ifndef tanktread_surface_closest_point_h
#define tanktread_surface_closest_point_h

#include <Eigen/Dense>
#include <tanktread/surface/subdivision_surface.h>

#include <vector>

namespace tanktread
{
  /** The surface about one of its points: X + a_alpha d^alpha + 1/2 a_{alpha,beta} d^alpha d^beta. */
  struct QuadraticPatch
  {
    Eigen::Vector3d X, a_1, a_2, a_11, a_12, a_22;
  };

  /** Patches about all quadrature points. Needs second derivatives. */
  std::vector<QuadraticPatch>
  quadratic_patches(const SubdivisionSurface &surface, const ControlPoints &x);

  /**
   * Distance of y from the patch, positive on the side of a_1 x a_2. The nearest point of the patch is found by Newton's method from its centre; one at a
   * distance d along the surface from the centre carries an error of third order in d. Where the method leaves the patch's neighbourhood (|y - X| comparable to
   * the radii of curvature), the distance from the tangent plane is returned.
   */
  double
  signed_distance(const QuadraticPatch &patch, const Eigen::Vector3d &y);
} // namespace tanktread

#endif
