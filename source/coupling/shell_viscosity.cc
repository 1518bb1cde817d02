// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the viscosity of the liquids inside and outside the shell, cell by cell.

#include <tanktread/coupling/shell_viscosity.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  ShellViscosity::ShellViscosity(const TaylorHoodSpace &space)
    : space_(space)
  {
    const FluidMesh &mesh = space.mesh;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const int size     = 1 << (mesh.finest_level() - cell->level());
          Lattice   position = lattice(mesh.key(cell).position);
          for (std::int64_t &i : position)
            i *= size;
          cells_.push_back({position, size});
        }
  }


  void
  ShellViscosity::add_shell(const SurfaceDistance &distance, Parts &parts) const
  {
    const CellSides  sides(distance.runs_nearby());
    const Lattice   &low   = distance.low();
    const auto       n     = space_.mesh.n_cubes(space_.mesh.finest_level());
    const NodeSpace &nodes = *space_.velocity;
    // The image of a cell that may be near the shell or inside.
    const auto image = [&](Lattice cell) {
      for (unsigned int d = 0; d < 3; ++d)
        if (space_.mesh.box().is_periodic(d))
          cell[d] = low[d] + ((cell[d] - low[d]) % n[d] + n[d]) % n[d];
      return cell;
    };
    std::vector<double> phi(nodes.n_local(), std::nan(""));
    for (std::size_t i = 0; i < cells_.size(); ++i)
      {
        const auto &[position, size] = cells_[i];
        const auto centre            = image({position[0] + size / 2, position[1] + size / 2, position[2] + size / 2});
        Side       side              = sides.at(centre);
        // A cell twice as large may touch the shell's neighbourhood, not be all of it.
        for (int k = 0; size == 2 && side == Side::near && k < 8; ++k)
          side = sides.at(image({position[0] + k % 2, position[1] + k / 2 % 2, position[2] + k / 4}));
        if (size > 1 && side == Side::near)
          side = distance.at({2 * centre[0], 2 * centre[1], 2 * centre[2]}) < 0. ? Side::inside : Side::outside;
        if (side == Side::inside)
          parts.is_inside[i] = true;
        if (side != Side::near)
          continue;
        std::array<double, 27> distances;
        for (int a = 0; a < 27; ++a)
          {
            const unsigned int node  = nodes.cell_nodes(i)[a];
            double            &value = phi[node];
            if (std::isnan(value) || node + 1 == nodes.n_local()) // the last place is that of all wall nodes
              value = distance.at({2 * centre[0] + a % 3, 2 * centre[1] + a / 3 % 3, 2 * centre[2] + a / 9});
            distances[a] = value / nodes.cell_sizes()[i];
          }
        const auto n_inside = std::count_if(distances.begin(), distances.end(), [](const double d) { return d < 0.; });
        if (n_inside == 27)
          parts.is_inside[i] = true;
        else if (n_inside > 0)
          {
            const CellWeights inside = inside_weights(distances);
            CellWeights      &sum    = parts.inside.try_emplace(i, CellWeights{}).first->second;
            for (unsigned int q = 0; q < 125; ++q)
              sum[q] += inside[q];
          }
      }
  }


  Viscosity
  ShellViscosity::operator()(const ShellConfigurations &shells, const double ratio) const
  {
    Parts parts;
    parts.is_inside.assign(cells_.size(), false);
    for (const auto &shell : shells)
      add_shell(SurfaceDistance(space_.mesh, shell->patches()), parts);
    const double        least = std::min(1., ratio);
    std::vector<double> mu;
    mu.reserve(27 * cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i)
      mu.insert(mu.end(), 27, parts.is_inside[i] ? ratio : parts.inside.count(i) > 0 ? least : 1.);
    CutCells           cut;
    const CellWeights &whole = whole_weights();
    for (const auto &[cell, inside] : parts.inside)
      if (!parts.is_inside[cell])
        {
          cut.cells.push_back(cell);
          for (unsigned int q = 0; q < 125; ++q)
            cut.weights.push_back(ratio > 1. ? (ratio - 1.) * inside[q] : (1. - ratio) * (whole[q] - inside[q]));
        }
    return {std::move(mu), least, std::move(cut)};
  }
} // namespace tanktread
