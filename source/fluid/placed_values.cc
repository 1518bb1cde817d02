// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: values at nodes, told by places that any division of the mesh among ranks has.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/fluid/placed_values.h>
#include <tanktread/fluid/stokes_operator.h>

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace tanktread
{
  namespace
  {
    /** Neighbours go to different ranks. */
    unsigned int
    rank_of(const std::uint64_t place, const unsigned int n_ranks)
    {
      const std::uint64_t mixed = place * 0x9e3779b97f4a7c15ull;
      return static_cast<unsigned int>((mixed >> 32) % n_ranks);
    }


    using Places = std::map<unsigned int, std::vector<std::uint64_t>>;


    Places
    by_rank(const std::vector<std::uint64_t> &places, const unsigned int n_ranks)
    {
      Places result;
      for (const std::uint64_t place : places)
        result[rank_of(place, n_ranks)].push_back(place);
      return result;
    }
  } // namespace


  std::vector<std::uint64_t>
  places_of_nodes(const TaylorHoodSpace &space, const NodeSpace &nodes)
  {
    const Box                 &box     = space.mesh.box();
    const std::vector<double>  corners = lower_corners(space);
    const double               unit    = 0.5 * space.mesh.cell_size(space.mesh.finest_level());
    const unsigned int         n_side  = nodes.nodes_per_cell() == 27 ? 3 : 2;
    std::vector<std::uint64_t> result(nodes.n_owned());
    for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
      for (unsigned int a = 0; a < nodes.nodes_per_cell(); ++a)
        {
          const unsigned int node = nodes.cell_nodes(cell)[a];
          if (node >= nodes.n_owned())
            continue;
          const std::array<unsigned int, 3> in_cell = {{a % n_side, a / n_side % n_side, a / (n_side * n_side)}};
          std::uint64_t                     place   = 0;
          for (unsigned int d = 0; d < 3; ++d)
            {
              const double x = corners[3 * std::size_t(cell) + d] - box.lower(d) + nodes.cell_sizes()[cell] * in_cell[d] / (n_side - 1);
              std::int64_t i = std::llround(x / unit);
              if (const std::int64_t n = std::llround(box.side[d] / unit); box.is_periodic(d))
                i %= n;
              place = (place << 21) | static_cast<std::uint64_t>(i);
            }
          result[node] = place;
        }
    return result;
  }


  std::vector<double>
  values_at(const std::vector<std::uint64_t> &wanted, const PlacedValues &known, const unsigned int n, const MPI_Comm communicator)
  {
    using dealii::Utilities::MPI::some_to_some;
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
    // What is known goes to the rank of its place.
    std::map<unsigned int, std::vector<double>> values;
    for (std::size_t i = 0; i < known.places.size(); ++i)
      {
        std::vector<double> &of_rank = values[rank_of(known.places[i], n_ranks)];
        of_rank.insert(of_rank.end(), &known.values[n * i], &known.values[n * i] + n);
      }
    const auto                                        places_here = some_to_some(communicator, by_rank(known.places, n_ranks));
    const auto                                        values_here = some_to_some(communicator, values);
    std::unordered_map<std::uint64_t, const double *> here;
    for (const auto &[rank, of_rank] : places_here)
      for (std::size_t i = 0; i < of_rank.size(); ++i)
        here[of_rank[i]] = &values_here.at(rank)[n * i];

    // There the others ask for it.
    const auto                                  asked = some_to_some(communicator, by_rank(wanted, n_ranks));
    std::map<unsigned int, std::vector<double>> answers;
    on_all_ranks(communicator, [&] {
      for (const auto &[rank, of_rank] : asked)
        for (const std::uint64_t place : of_rank)
          {
            const auto found = here.find(place);
            if (found == here.end())
              throw NumericalError("Values at nodes are asked for of which there are none: they are of another mesh.");
            answers[rank].insert(answers[rank].end(), found->second, found->second + n);
          }
    });
    const auto                          answered = some_to_some(communicator, answers);
    std::map<unsigned int, std::size_t> next;
    std::vector<double>                 result;
    for (const std::uint64_t place : wanted)
      {
        const unsigned int rank   = rank_of(place, n_ranks);
        const double      *values = &answered.at(rank)[n * next[rank]++];
        result.insert(result.end(), values, values + n);
      }
    return result;
  }
} // namespace tanktread
