// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: inside which shells the pressure's vertices lie, and what a pressure takes along when that changes.

#ifndef tanktread_coupling_vertex_sides_h
#define tanktread_coupling_vertex_sides_h

#include <tanktread/coupling/vertex_averages.h>

#include <array>
#include <vector>

namespace tanktread
{
  /** Where the pressure's owned unknowns lie: the number of the shell that a vertex is inside of, or one of VertexSide. Empty: nowhere. */
  using VertexSides = std::vector<int>;

  enum VertexSide : int
  {
    outside_all  = -1, // near a shell, inside of none
    unknown_side = -2  // farther than a cell from all shells
  };

  /** A finest cell near a shell, and which of its vertices are inside. */
  struct NearCell
  {
    unsigned int        cell, shell; // the latter's number
    std::array<bool, 8> inside;
  };

  /** An owned unknown of the pressure near a shell. */
  struct NearVertex
  {
    unsigned int node, shell;      // the latter's number
    bool         inside, sees_two; // sees_two: it is near another shell too
    double       n_values;         // what ones in all cells that know the vertex sum up to, over the ranks
  };

  /** @param vertices linear nodes with four components, numbered as the pressure's. @param cells near shells, no two of which have vertices in common. Collective. */
  std::vector<NearVertex>
  find_near_vertices(const NodeSpace &vertices, const std::vector<NearCell> &cells);

  /**
   * Adds to p_h what the pressure jumps at the vertices that were inside of a shell before and are outside now, f_n, or the other way round, -f_n: the nodal
   * values of p_h are those of the pressure, which a vertex that the shell has passed finds on the other side.
   *
   * @param pressure its nodes. @param cells near the shells. @param vertices the nodes of `forces`, f_t and f_n of these shells. @param now where
   * find_near_vertices() finds the vertices. Collective.
   */
  void
  carry_pressure(const NodeSpace               &pressure,
                 const std::vector<NearCell>   &cells,
                 const NodeSpace               &vertices,
                 const VertexArray             &forces,
                 const std::vector<NearVertex> &now,
                 const VertexSides             &before,
                 FluidBlockVector              &fields);
} // namespace tanktread

#endif
