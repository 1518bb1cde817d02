// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: flows carried from one mesh to the next.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/fluid/quadratic_element.h>

#include <algorithm>
#include <array>
#include <map>

namespace tanktread
{
  namespace
  {
    constexpr std::array<unsigned int, 2> nodes_in_cell = {{27, 8}}, numbers_a_node = {{3, 1}}, strides = {{4, 1}}; // NodeSpace::stride()

    /** The Lagrange functions of an axis at x: three quadratic ones or two linear ones. */
    std::array<double, 3>
    shape_values(const unsigned int block, const double x)
    {
      if (block == pressure_block)
        return {{1. - x, x, 0.}};
      return quadratic_values(x);
    }
  } // namespace


  FieldTransfer::FieldTransfer(const TaylorHoodSpace &space, const std::vector<FluidBlockVector *> &fields)
    : finest_(space.mesh.finest_level())
  {
    for (unsigned int block = 0; block < 2; ++block)
      {
        const NodeSpace &nodes = block == velocity_block ? *space.velocity : *space.pressure;
        for (const FluidBlockVector *const field : fields)
          {
            values_[block].emplace_back(nodes.full_size());
            nodes.load(field->block(block), values_[block].back().data());
            nodes.update(values_[block].back().data());
          }
        for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
          nodes_[block].insert(nodes_[block].end(), nodes.cell_nodes(cell), nodes.cell_nodes(cell) + nodes.nodes_per_cell());
      }

    std::vector<std::uint64_t> keys;
    for (const auto &cell : space.mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        keys.push_back(space.mesh.key(cell).packed());
    const auto all_keys = dealii::Utilities::MPI::all_gather(space.mesh.communicator(), keys);
    for (unsigned int rank = 0; rank < all_keys.size(); ++rank)
      for (unsigned int i = 0; i < all_keys[rank].size(); ++i)
        cells_[all_keys[rank][i]] = {rank, i};
  }


  FieldTransfer::Place
  FieldTransfer::locate(const FluidMesh &mesh, const dealii::Point<3> &point) const
  {
    const unsigned int finest = finest_; // the new mesh may have a finest level of its own
    dealii::Point<3>   inside = point;
    for (unsigned int d = 0; d < 3; ++d)
      if (!mesh.box().is_periodic(d)) // pressures have nodes on these faces, which rounding may put outside
        inside[d] = std::clamp(inside[d], mesh.box().lower(d), -(1. - 1e-12) * mesh.box().lower(d));
    const FluidMesh::Place place = mesh.place(inside, finest);
    for (unsigned int finer = 0; finer <= finest; ++finer)
      {
        CellKey key = {finest - finer, place.key.position};
        for (int &i : key.position)
          i >>= finer;
        const auto found = cells_.find(key.packed());
        if (found == cells_.end())
          continue;
        Place result{found->second.rank, found->second.number, {}};
        for (unsigned int d = 0; d < 3; ++d)
          result.unit[d] = (place.key.position[d] - (key.position[d] << finer) + place.unit[d]) / (1 << finer);
        return result;
      }
    throw NumericalError("A node of the fluid mesh is in no cell of the mesh before.");
  }


  std::vector<double>
  FieldTransfer::evaluate(const unsigned int block, const std::vector<double> &places) const
  {
    const unsigned int  degree = block == pressure_block ? 1 : 2, n_nodes = nodes_in_cell[block], n_numbers = numbers_a_node[block];
    std::vector<double> result;
    for (std::size_t i = 0; i < places.size(); i += 4)
      {
        const auto                x = shape_values(block, places[i + 1]), y = shape_values(block, places[i + 2]), z = shape_values(block, places[i + 3]);
        const unsigned int *const cell = nodes_[block].data() + std::size_t(places[i]) * n_nodes;
        for (const auto &field : values_[block])
          for (unsigned int c = 0; c < n_numbers; ++c)
            {
              double sum = 0.;
              for (unsigned int a = 0; a < n_nodes; ++a)
                sum += x[a % (degree + 1)] * y[a / (degree + 1) % (degree + 1)] * z[a / ((degree + 1) * (degree + 1))] *
                  field[std::size_t(strides[block]) * cell[a] + c];
              result.push_back(sum);
            }
      }
    return result;
  }


  void
  FieldTransfer::interpolate_block(const unsigned int block, const NodeSpace &nodes, const FluidMesh &mesh, const std::vector<FluidBlockVector *> &fields) const
  {
    const unsigned int                                n_a_line = block == pressure_block ? 2 : 3, n_numbers = numbers_a_node[block];
    std::map<unsigned int, std::vector<double>>       requests;
    std::map<unsigned int, std::vector<unsigned int>> nodes_of_requests;
    std::vector<bool>                                 known(nodes.n_owned(), false);
    unsigned int                                      index = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int *const cell_nodes = nodes.cell_nodes(index++);
          for (unsigned int a = 0; a < nodes.nodes_per_cell(); ++a)
            {
              if (cell_nodes[a] >= nodes.n_owned() || known[cell_nodes[a]])
                continue;
              known[cell_nodes[a]] = true;
              const dealii::Point<3> offset(a % n_a_line, a / n_a_line % n_a_line, a / (n_a_line * n_a_line));
              const Place            place = locate(mesh, cell->vertex(0) + mesh.cell_size(cell->level()) / (n_a_line - 1) * offset);
              for (const double number : {double(place.cell), place.unit[0], place.unit[1], place.unit[2]})
                requests[place.rank].push_back(number);
              nodes_of_requests[place.rank].push_back(cell_nodes[a]);
            }
        }

    std::map<unsigned int, std::vector<double>> answers;
    for (const auto &[rank, places] : dealii::Utilities::MPI::some_to_some(mesh.communicator(), requests))
      answers[rank] = evaluate(block, places);
    for (const auto &[rank, values] : dealii::Utilities::MPI::some_to_some(mesh.communicator(), answers))
      {
        const double *next = values.data();
        for (const unsigned int node : nodes_of_requests[rank])
          for (FluidBlockVector *const field : fields)
            for (unsigned int c = 0; c < n_numbers; ++c)
              field->block(block).local_element(n_numbers * node + c) = *next++;
      }
  }


  void
  FieldTransfer::interpolate(const TaylorHoodSpace &space, const std::vector<FluidBlockVector *> &fields) const
  {
    for (FluidBlockVector *const field : fields)
      space.reinit(*field);
    interpolate_block(velocity_block, *space.velocity, space.mesh, fields);
    interpolate_block(pressure_block, *space.pressure, space.mesh, fields);
  }
} // namespace tanktread
