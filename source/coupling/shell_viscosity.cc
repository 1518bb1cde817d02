// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the viscosity of the liquids inside and outside the shell, cell by cell.

#include <tanktread/coupling/shell_viscosity.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  ShellViscosity::ShellViscosity(const TaylorHoodSpace &space)
    : space_(space)
    , number_(space.mesh.triangulation().n_active_cells())
  {
    unsigned int number = 0;
    for (const auto &cell : space.mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        number_[cell->active_cell_index()] = number++;
  }


  Lattice
  ShellViscosity::image(Lattice cell, const SurfaceDistance &distance) const
  {
    const Lattice &low = distance.low();
    const auto     n   = space_.mesh.n_cubes(space_.mesh.finest_level());
    for (unsigned int d = 0; d < 3; ++d)
      if (space_.mesh.box().is_periodic(d))
        cell[d] = low[d] + ((cell[d] - low[d]) % n[d] + n[d]) % n[d];
    return cell;
  }


  void
  ShellViscosity::find_cells(const CellIterator &cell, const SurfaceDistance &distance, std::vector<Cell> &cells) const
  {
    const FluidMesh &mesh     = space_.mesh;
    const auto       n        = mesh.n_cubes(mesh.finest_level());
    const int        size     = 1 << (mesh.finest_level() - cell->level());
    Lattice          position = lattice(mesh.key(cell).position);
    for (std::int64_t &i : position)
      i *= size;
    const Lattice lower = image(position, distance), &low = distance.low(), extent = distance.extent();
    for (unsigned int d = 0; d < 3; ++d)
      {
        // Beyond the low end lies along periodic axes what is beyond the last image's end.
        const bool reaches_low = lower[d] + size > low[d] + (mesh.box().is_periodic(d) ? n[d] : 0);
        if (mesh.box().is_periodic(d) ? lower[d] >= low[d] + extent[d] && !reaches_low : lower[d] >= low[d] + extent[d] || !reaches_low)
          return;
      }
    if (cell->has_children())
      for (unsigned int child = 0; child < cell->n_children(); ++child)
        find_cells(cell->child(child), distance, cells);
    else if (cell->is_locally_owned())
      cells.push_back({position, size, number_[cell->active_cell_index()]});
  }


  Side
  ShellViscosity::side(const Cell &cell, const SurfaceDistance &distance, const CellSides &sides) const
  {
    const auto &[position, size, number] = cell;
    const Lattice centre                 = image({position[0] + size / 2, position[1] + size / 2, position[2] + size / 2}, distance);
    Side          result                 = sides.at(centre);
    // A cell twice as large may touch the shell's neighbourhood, not be all of it.
    for (int k = 0; size == 2 && result == Side::near && k < 8; ++k)
      result = sides.at(image({position[0] + k % 2, position[1] + k / 2 % 2, position[2] + k / 4}, distance));
    if (size > 1 && result == Side::near)
      result = distance.at({2 * centre[0], 2 * centre[1], 2 * centre[2]}) < 0. ? Side::inside : Side::outside;
    return result;
  }


  void
  ShellViscosity::add_near_cell(const Cell &cell, const Lattice &centre, const SurfaceDistance &distance, Distances &phi, Parts &parts) const
  {
    const NodeSpace       &nodes = *space_.velocity;
    std::array<double, 27> distances;
    for (int a = 0; a < 27; ++a)
      {
        const unsigned int node    = nodes.cell_nodes(cell.number)[a];
        const auto [found, is_new] = phi.try_emplace(node);
        if (is_new || node + 1 == nodes.n_local()) // the last place is that of all wall nodes
          found->second = distance.at({2 * centre[0] + a % 3, 2 * centre[1] + a / 3 % 3, 2 * centre[2] + a / 9});
        distances[a] = found->second / nodes.cell_sizes()[cell.number];
      }
    const auto n_inside = std::count_if(distances.begin(), distances.end(), [](const double d) { return d < 0.; });
    if (n_inside == 27)
      parts.is_inside[cell.number] = true;
    else if (n_inside > 0)
      {
        const CellWeights inside = inside_weights(distances);
        CellWeights      &sum    = parts.inside.try_emplace(cell.number, CellWeights{}).first->second;
        for (unsigned int q = 0; q < 125; ++q)
          sum[q] += inside[q];
      }
  }


  void
  ShellViscosity::add_shell(const SurfaceDistance &distance, Parts &parts) const
  {
    const CellSides   sides(distance.runs_nearby());
    std::vector<Cell> cells;
    for (const auto &cell : space_.mesh.triangulation().cell_iterators_on_level(0))
      find_cells(cell, distance, cells);
    Distances phi;
    for (const Cell &cell : cells)
      {
        const Side of_cell = side(cell, distance, sides);
        if (of_cell == Side::inside)
          parts.is_inside[cell.number] = true;
        else if (of_cell == Side::near)
          add_near_cell(cell, image(cell.position, distance), distance, phi, parts);
      }
  }


  Viscosity
  ShellViscosity::operator()(const ShellConfigurations &shells, const double ratio) const
  {
    Parts              parts;
    const unsigned int n_cells = space_.velocity->n_cells();
    parts.is_inside.assign(n_cells, false);
    for (const auto &shell : shells)
      add_shell(SurfaceDistance(space_.mesh, shell->patches()), parts);
    const double        least = std::min(1., ratio);
    std::vector<double> mu;
    mu.reserve(27 * n_cells);
    for (std::size_t i = 0; i < n_cells; ++i)
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
