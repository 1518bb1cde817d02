// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the outline of a capsule in the shear plane.

#ifndef tanktread_surface_contour_h
#define tanktread_surface_contour_h

#include <tanktread/surface/triangle_mesh.h>

#include <vector>

namespace tanktread
{
  /**
   * Cut of a closed triangle mesh with the plane y = 0: the points (x, z) of a closed polyline in order, counter-clockwise about +y seen with x to the right
   * and z up, first point not repeated. Vertices are at the positions given (pass limit positions, not control points). If the cut has several loops,
   * the one that encloses the largest area is returned; if the plane misses the mesh the result is empty.
   */
  std::vector<Eigen::Vector2d>
  shear_plane_contour(const TriangleMesh &positions);
} // namespace tanktread

#endif
