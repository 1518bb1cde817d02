// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which ranks own which cells of the octree.

#include <deal.II/base/mpi.h>

#include <tanktread/base/mpi_errors.h>
#include <tanktread/fluid/fluid_mesh.h>

#include <map>
#include <set>

namespace tanktread
{
  namespace
  {
    /** Ranks whose cells points are in, which may differ from rank to rank. Collective: deal.II's function is, though p4est's is not. */
    std::vector<unsigned int>
    owners(const FluidMesh::Triangulation &triangulation, const std::vector<dealii::Point<3>> &points)
    {
      // It does not change the mesh, but p4est's function is declared as if it might.
      return const_cast<FluidMesh::Triangulation &>(triangulation).find_point_owner_rank(points);
    }
  } // namespace


  std::vector<dealii::Point<3>>
  FluidMesh::places_near(const std::vector<dealii::Point<3>> &points) const
  {
    // p4est divides the cells such that eight which could be merged are on one rank: the lowest of them answers for all.
    const unsigned int            level = std::max(finest_level_, 1u) - 1;
    const std::array<int, 3>      n     = n_cubes(level);
    KeySet                        with_points, asked;
    std::vector<dealii::Point<3>> result;
    for (const auto &point : points)
      if (const CellKey cube = place(point, level).key; with_points.insert(cube.packed()).second)
        for (int neighbour = 0; neighbour < 27; ++neighbour)
          {
            const std::array<int, 3> offset    = {{neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1}};
            CellKey                  near      = cube;
            bool                     is_in_box = true;
            for (unsigned int d = 0; d < 3; ++d)
              {
                near.position[d] += offset[d];
                if (box_.is_periodic(d))
                  near.position[d] = modulo(near.position[d], n[d]);
                is_in_box = is_in_box && near.position[d] >= 0 && near.position[d] < n[d];
              }
            if (is_in_box && asked.insert(near.packed()).second)
              result.push_back(point_in(near));
          }
    return result;
  }


  std::vector<std::vector<unsigned int>>
  FluidMesh::ranks_near(const std::vector<std::vector<dealii::Point<3>>> &points) const
  {
    std::vector<dealii::Point<3>> places;
    std::vector<std::size_t>      ends;
    on_all_ranks(communicator_, [&] {
      for (const auto &of_set : points)
        {
          const std::vector<dealii::Point<3>> further = places_near(of_set);
          places.insert(places.end(), further.begin(), further.end());
          ends.push_back(places.size());
        }
    });
    const std::vector<unsigned int>        ranks = owners(triangulation_, places);
    std::vector<std::vector<unsigned int>> result;
    std::size_t                            begin = 0;
    for (const std::size_t end : ends)
      {
        const std::set<unsigned int> of_set(ranks.begin() + begin, ranks.begin() + end);
        result.emplace_back(of_set.begin(), of_set.end());
        begin = end;
      }
    return result;
  }


  dealii::Point<3>
  FluidMesh::point_in(const CellKey &cube) const
  {
    dealii::Point<3> result;
    for (unsigned int d = 0; d < 3; ++d)
      result[d] = box_.lower(d) + (cube.position[d] + 0.21) * cell_size(cube.level);
    return result;
  }


  FluidMesh::KeySet
  FluidMesh::at_owners(const KeySet &cubes, const unsigned int level) const
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator_) == 1)
      return cubes;
    std::vector<std::uint64_t>    keys;
    std::vector<dealii::Point<3>> places;
    for (const std::uint64_t key : cubes)
      if (const CellKey cube = CellKey::unpacked(key); cube.level == level)
        {
          keys.push_back(key);
          places.push_back(point_in(cube));
        }
    const std::vector<unsigned int>                    ranks = owners(triangulation_, places);
    std::map<unsigned int, std::vector<std::uint64_t>> asked;
    for (std::size_t i = 0; i < keys.size(); ++i)
      asked[ranks[i]].push_back(keys[i]);
    KeySet result;
    for (const auto &[rank, of_rank] : dealii::Utilities::MPI::some_to_some(communicator_, asked))
      result.insert(of_rank.begin(), of_rank.end());
    return result;
  }


  std::unordered_map<std::uint64_t, unsigned int>
  FluidMesh::parts_with_points() const
  {
    std::unordered_map<std::uint64_t, unsigned int> result;
    for (const std::uint64_t part : at_owners(with_points_, finest_level_))
      {
        CellKey cell = CellKey::unpacked(part);
        --cell.level;
        for (int &i : cell.position)
          i >>= 1;
        ++result[cell.packed()];
      }
    return result;
  }
} // namespace tanktread
