// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which points a closed surface encloses.

#ifndef tanktread_surface_interior_h
#define tanktread_surface_interior_h

#include <tanktread/surface/subdivision_surface.h>

#include <array>
#include <map>
#include <vector>

namespace tanktread
{
  /**
   * Tells inside from outside. A point within a few spacings of the quadrature points is told by the normal of the nearest one; any other by the winding number
   * 1/(4 pi) sum_c n_c . (X_c - y)/|X_c - y|^3 dGamma_c, which is 1 inside and 0 outside, with sums over the quadrature points of boxes as large as that
   * distance in place of the points themselves.
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
    using Box = std::array<int, 3>;

    Box
    box(const Eigen::Vector3d &y) const;

    ControlPoints                            positions_, normals_;
    ControlPoints                            box_centres_, box_area_normals_;
    double                                   box_size_;
    std::map<Box, std::vector<Eigen::Index>> points_;
    Eigen::Vector3d                          low_, high_, centre_;
  };
} // namespace tanktread

#endif
