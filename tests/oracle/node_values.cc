// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where the nodes of the own numbering are, rough values there, and matrices in their order.

#include <deal.II/fe/fe_tools.h>

#include "node_values.h"

#include <cmath>
#include <cstdint>

namespace tanktread::oracle
{
  std::vector<double>
  lexicographic(const dealii::FullMatrix<double> &matrix, const unsigned int row_degree, const unsigned int column_degree)
  {
    std::vector<double> result;
    for (const unsigned int i : dealii::FETools::lexicographic_to_hierarchic_numbering<3>(row_degree))
      for (const unsigned int j : dealii::FETools::lexicographic_to_hierarchic_numbering<3>(column_degree))
        result.push_back(matrix(i, j));
    return result;
  }


  std::vector<dealii::Point<3>>
  node_positions(const FluidMesh &mesh, const NodeSpace &nodes)
  {
    const unsigned int            n = nodes.nodes_per_cell() == 27 ? 3 : 2; // along an edge
    std::vector<dealii::Point<3>> result(nodes.n_owned());
    unsigned int                  cell_number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int *const cell_nodes = nodes.cell_nodes(cell_number++);
          const double              step       = mesh.cell_size(cell->level()) / (n - 1);
          for (unsigned int a = 0; a < nodes.nodes_per_cell(); ++a)
            if (cell_nodes[a] < nodes.n_owned())
              {
                dealii::Point<3> x = cell->vertex(0) + step * dealii::Point<3>(a % n, a / n % n, a / (n * n));
                for (unsigned int d = 0; d < 3; ++d)
                  if (mesh.box().is_periodic(d) && x[d] > (0.5 - 1e-9) * mesh.box().side[d])
                    x[d] -= mesh.box().side[d];
                result[cell_nodes[a]] = x;
              }
        }
    return result;
  }


  double
  rough_value(const FluidMesh &mesh, const dealii::Point<3> &position, const unsigned int component, const unsigned int seed)
  {
    std::uint64_t hash = 3 * std::uint64_t(seed) + component;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const std::int64_t n = (std::int64_t(2) * mesh.n_rung_0()[d]) << mesh.finest_level(); // half a finest cell is the unit
        const std::int64_t i = std::llround((position[d] / mesh.box().side[d] + 0.5) * n);
        // The mixing step of the generator splitmix64.
        hash = (hash + static_cast<std::uint64_t>(mesh.box().is_periodic(d) ? (i + n) % n : i)) * 0x9e3779b97f4a7c15u;
        hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
        hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
        hash ^= hash >> 31;
      }
    return static_cast<double>(hash >> 11) / (std::uint64_t(1) << 52) - 1.;
  }


  void
  set_rough(const FluidMesh &mesh, const NodeSpace &nodes, const unsigned int seed, FluidVector &vector)
  {
    const auto         positions = node_positions(mesh, nodes);
    const unsigned int n         = nodes.n_components();
    for (unsigned int i = 0; i < positions.size(); ++i)
      for (unsigned int c = 0; c < n; ++c)
        vector.local_element(n * i + c) = rough_value(mesh, positions[i], c, seed);
  }


  std::vector<dealii::Point<3>>
  sphere_points(const dealii::Point<3> &centre, const double radius)
  {
    std::vector<dealii::Point<3>> points;
    const unsigned int            n = 600;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double z = (2. * i + 1.) / n - 1., phi = i * 2.399963229728653, r = std::sqrt(1. - z * z);
        points.push_back(centre + radius * dealii::Point<3>(r * std::cos(phi), r * std::sin(phi), z));
      }
    return points;
  }
} // namespace tanktread::oracle
