// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: inside which shells the pressure's vertices lie, and what a pressure takes along when that changes.

#include <tanktread/coupling/vertex_sides.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  std::vector<NearVertex>
  find_near_vertices(const NodeSpace &vertices, const std::vector<NearCell> &cells)
  {
    // Ones, sides, numbers of shells and their squares: where the variance of the numbers is not zero a vertex sees two.
    VertexArray sums(vertices.full_size());
    std::fill(sums.begin(), sums.end(), 0.);
    for (const NearCell &near : cells)
      for (unsigned int j = 0; j < 8; ++j)
        {
          const double number = near.shell;
          Vector4(1., near.inside[j] ? -1. : 1., number, number * number).store_four(&sums[4 * std::size_t(vertices.cell_nodes(near.cell)[j])]);
        }
    vertices.collect(sums.data());
    std::vector<NearVertex> result;
    for (unsigned int i = 0; i < vertices.n_owned(); ++i)
      if (const double *const sum = &sums[4 * std::size_t(i)]; sum[0] > 0.)
        {
          const double mean = sum[2] / sum[0];
          // Masters of hanging vertices may get as much from one side as from the other: those are on none.
          if (sum[1] != 0.)
            result.push_back({i, static_cast<unsigned int>(std::lround(mean)), sum[1]<0., sum[3] / sum[0] - mean * mean> 1e-12 * (1. + mean * mean), sum[0]});
        }
    return result;
  }


  void
  carry_pressure(const NodeSpace               &pressure,
                 const std::vector<NearCell>   &cells,
                 const NodeSpace               &vertices,
                 const VertexArray             &forces,
                 const std::vector<NearVertex> &now,
                 const VertexSides             &before,
                 FluidBlockVector              &fields)
  {
    dealii::AlignedVector<double> jumps(pressure.full_size());
    std::fill(jumps.begin(), jumps.end(), 0.);
    for (const NearCell &near : cells)
      for (unsigned int j = 0; j < 8; ++j)
        jumps[pressure.cell_nodes(near.cell)[j]] = forces[4 * std::size_t(vertices.cell_nodes(near.cell)[j]) + 3];
    pressure.collect(jumps.data());
    FluidVector &p = fields.block(pressure_block);
    for (const NearVertex &vertex : now)
      {
        const int  shell      = vertex.shell;
        const bool was_inside = before[vertex.node] == shell;
        if (before[vertex.node] != unknown_side && was_inside != vertex.inside)
          p.local_element(vertex.node) += (was_inside ? 1. : -1.) * jumps[vertex.node] / vertex.n_values;
      }
  }
} // namespace tanktread
