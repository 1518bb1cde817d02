// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: triangle meshes as lists, the icosphere, reading them from files and checking them.

#ifndef tanktread_surface_triangle_mesh_h
#define tanktread_surface_triangle_mesh_h

#include <tanktread/surface/types.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tanktread
{
  /** Vertices and faces; a face lists its vertices counter-clockwise when seen from outside. */
  struct TriangleMesh
  {
    std::vector<Eigen::Vector3d>    vertices;
    std::vector<std::array<int, 3>> faces;
  };

  /** Weight beta_n = (5/8 - (3/8 + cos(2 pi/n)/4)^2)/n of each of the n neighbours of a vertex in Loop's subdivision (Loop 1987). */
  double
  loop_weight(unsigned int valence);

  /**
   * One step of Loop's subdivision of a closed surface: every face is split into four, the limit surface stays the same. The first vertices are those of the
   * coarse mesh, moved; face f becomes faces 4 f, ..., 4 f + 3.
   */
  TriangleMesh
  loop_refine(const TriangleMesh &coarse);

  /** That step as a matrix: from the vertices of the coarse mesh to those of the fine one. Limit surfaces of the coarse mesh are among those of the fine one. */
  SparseMatrix
  loop_subdivision(const TriangleMesh &coarse);

  /**
   * The mesh of which loop_refine() makes these faces, numbered alike, if there is one. What positions its vertices have had is not told: they are zero.
   */
  std::optional<TriangleMesh>
  loop_coarsen(const TriangleMesh &fine);

  /**
   * Sphere with 10 * 4^level + 2 vertices on the unit sphere, outward oriented: an icosahedron after `level` Loop refinements, its vertices moved to the
   * limit surface and then out to the sphere. So the mesh varies smoothly except at the twelve vertices of valence 5, around which it is finer (at level 4
   * the edges measure 0.052 to 0.079). Splitting edges on the sphere again and again instead leaves kinks in the mesh, and a subdivision surface on
   * it has a mean curvature that converges with order 1/2 only.
   */
  TriangleMesh
  icosphere(unsigned int level);

  /**
   * Reads an OFF file (ASCII), a Wavefront OBJ file (only its `v` and `f` records) or a legacy VTK file (read_legacy_vtk()), told apart by the extension .off,
   * .obj or .vtk.
   * Throws InputError with file and line when the file cannot be opened, ends early, or has faces that are no triangles.
   */
  TriangleMesh
  read_triangle_mesh(const std::string &file);

  /**
   * Throws InputError unless `mesh` is one closed, consistently and outward oriented surface of genus 0 without isolated, coinciding or pinched
   * vertices. The message begins with `name` and says which face, edge or vertex is at fault (numbered from 0).
   */
  void
  check_closed_surface(const TriangleMesh &mesh, const std::string &name);
} // namespace tanktread

#endif
