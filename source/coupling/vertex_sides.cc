// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: on which side of a shell the pressure's vertices lie, and what a pressure takes along when that changes.

#include <tanktread/coupling/cut_cell_forms.h>
#include <tanktread/coupling/vertex_sides.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    /** A full array of pressures with value(cell, j) at the vertices of the cells, summed over the ranks that know them. */
    template <typename Value>
    dealii::AlignedVector<double>
    sum_over_ranks(const NodeSpace &space, const std::vector<unsigned int> &cells, const Value &value)
    {
      dealii::AlignedVector<double> result(space.full_size());
      std::fill(result.begin(), result.end(), 0.);
      for (const unsigned int cell : cells)
        for (unsigned int j = 0; j < 8; ++j)
          result[space.cell_nodes(cell)[j]] = value(cell, j);
      space.collect(result.data());
      return result;
    }
  } // namespace


  VertexSides
  vertex_sides(const TaylorHoodSpace &space, const std::vector<unsigned int> &nearby_cells, const std::vector<double> &phi)
  {
    const auto  values = sum_over_ranks(*space.pressure, nearby_cells, [&](const unsigned int cell, const unsigned int j) {
      return phi[space.velocity->cell_nodes(cell)[node_of_vertex(j)]] < 0. ? -1. : 1.;
    });
    VertexSides result(space.pressure->n_owned());
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = (values[i] > 0.) - (values[i] < 0.);
    return result;
  }


  void
  carry_pressure(const TaylorHoodSpace           &space,
                 const std::vector<unsigned int> &nearby_cells,
                 const NodeSpace                 &vertices,
                 const VertexArray               &forces,
                 const VertexSides               &before,
                 const VertexSides               &now,
                 FluidBlockVector                &fields)
  {
    const NodeSpace &nodes = *space.pressure;
    const auto       known = sum_over_ranks(nodes, nearby_cells, [](const unsigned int, const unsigned int) { return 1.; });
    auto             jumps = sum_over_ranks(nodes, nearby_cells, [&](const unsigned int cell, const unsigned int j) {
      return forces[4 * std::size_t(vertices.cell_nodes(cell)[j]) + 3];
    });
    for (std::size_t i = 0; i < nodes.n_owned(); ++i)
      jumps[i] = before[i] * now[i] < 0 ? now[i] * jumps[i] / known[i] : 0.;
    nodes.store(jumps.data(), fields.block(pressure_block), true);
  }
} // namespace tanktread
