// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the limit surface as a fine triangle mesh with its normals, for pictures.

#ifndef tanktread_surface_limit_picture_h
#define tanktread_surface_limit_picture_h

#include <tanktread/surface/triangle_mesh.h>
#include <tanktread/surface/types.h>

#include <array>
#include <vector>

namespace tanktread
{
  /**
   * A closed triangle mesh inscribed in the limit surface: each face of the control mesh is divided into 4^n. Positions, fields and tangents at its vertices
   * are those of the limit surface, by the limit stencils of the control mesh after n of Loop's subdivisions, also at extraordinary vertices.
   */
  class LimitPicture
  {
  public:
    /** @param n_subdivisions n, 0 for the faces of the control mesh themselves. Of `topology` only the connectivity, of a closed manifold, matters. */
    LimitPicture(const TriangleMesh &topology, unsigned int n_subdivisions);

    /** Vertices of each triangle, oriented as the control mesh is. The first NP vertices are those of the control mesh. */
    const std::vector<std::array<int, 3>> &
    faces() const
    {
      return faces_;
    }

    /** Values of control points' fields at the vertices, X = S x: n_vertices x NP. */
    const SparseMatrix &
    S() const
    {
      return S_;
    }

    /**
     * Unit normals of the limit surface at the vertices, n_vertices x 3, outward where the control mesh is oriented outward: along T_1 x x T_2 x with the rows
     * cos(2 pi i/n) and sin(2 pi i/n) of T_1 and T_2 at neighbours i of a vertex with n of them (Loop 1987), which are its two tangents up to a factor. Throws
     * NumericalError where the surface is degenerate.
     *
     * @param x control points, NP x 3.
     */
    ControlPoints
    normals(const ControlPoints &x) const;

  private:
    std::vector<std::array<int, 3>> faces_;
    SparseMatrix                    S_, T_1_, T_2_;
  };
} // namespace tanktread

#endif
