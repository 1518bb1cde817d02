// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: on which side of a shell the pressure's vertices lie, and what a pressure takes along when that changes.

#ifndef tanktread_coupling_vertex_sides_h
#define tanktread_coupling_vertex_sides_h

#include <tanktread/coupling/vertex_averages.h>

#include <vector>

namespace tanktread
{
  /**
   * On which side of a shell the pressure's owned unknowns lie: -1 inside, 1 outside, 0 where that is not known, farther from the shell than a cell. Empty:
   * nowhere.
   */
  using VertexSides = std::vector<signed char>;

  /** @param nearby_cells whose nodes' distances `phi` (one for each velocity node of this rank) are known. Collective. */
  VertexSides
  vertex_sides(const TaylorHoodSpace &space, const std::vector<unsigned int> &nearby_cells, const std::vector<double> &phi);

  /**
   * Adds to p_h at the vertices that have changed sides from `before` to `now` what the pressure jumps there, (i_now - i_before) eta_j: the nodal values of p_h
   * are those of the pressure, which a vertex that
   * the shell has passed finds on the other side.
   *
   * @param vertices the nodes of `forces`, f_t and f_n of the shell. Collective.
   */
  void
  carry_pressure(const TaylorHoodSpace           &space,
                 const std::vector<unsigned int> &nearby_cells,
                 const NodeSpace                 &vertices,
                 const VertexArray               &forces,
                 const VertexSides               &before,
                 const VertexSides               &now,
                 FluidBlockVector                &fields);
} // namespace tanktread

#endif
