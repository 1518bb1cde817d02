// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which points a closed surface encloses.

#ifndef tanktread_surface_interior_h
#define tanktread_surface_interior_h

#include <tanktread/surface/subdivision_surface.h>

namespace tanktread
{
  /**
   * Tells inside from outside by the winding number 1/(4 pi) sum_q n_q . (X_q - y)/|X_q - y|^3 dGamma_q, which is 1 inside and 0 outside. By quadrature it is exact up
   * to points closer to the surface than about the spacing of the quadrature points; those are told by the normal of the nearest quadrature point.
   */
  class Interior
  {
  public:
    Interior(const SubdivisionSurface &surface, const ControlPoints &x);

    bool
    contains(const Eigen::Vector3d &y) const;

    /** Mean of the quadrature points. */
    const Eigen::Vector3d &
    centre() const
    {
      return centre_;
    }

  private:
    ControlPoints   positions_, area_normals_;
    Eigen::Vector3d low_, high_, centre_;
    double          spacing_squared_;
  };
} // namespace tanktread

#endif
