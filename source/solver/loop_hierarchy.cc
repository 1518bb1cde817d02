// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the control meshes from which Loop's subdivision has made that of a capsule.

#include <tanktread/solver/loop_hierarchy.h>

#include <algorithm>
#include <set>

namespace tanktread
{
  namespace
  {
    /** Fewer rows than these are not worth the messages. */
    constexpr int least_rows = 300;

    /** Order of the vertices by the first face that they belong to. */
    std::vector<int>
    order_by_faces(const TriangleMesh &topology)
    {
      std::vector<int>  result;
      std::vector<char> is_listed(topology.vertices.size(), 0);
      for (const auto &face : topology.faces)
        for (const int vertex : face)
          if (!is_listed[vertex])
            {
              is_listed[vertex] = 1;
              result.push_back(vertex);
            }
      return result;
    }

    std::vector<int>
    inverse(const std::vector<int> &order)
    {
      std::vector<int> result(order.size());
      for (std::size_t i = 0; i < order.size(); ++i)
        result[order[i]] = int(i);
      return result;
    }

    /** Neighbours of each point, both by their places. */
    std::vector<std::vector<int>>
    neighbours(const TriangleMesh &topology, const std::vector<int> &place)
    {
      std::vector<std::set<int>> sets(place.size());
      for (const auto &face : topology.faces)
        for (unsigned int i = 0; i < 3; ++i)
          sets[place[face[i]]].insert({place[face[(i + 1) % 3]], place[face[(i + 2) % 3]]});
      std::vector<std::vector<int>> result;
      for (const std::set<int> &set : sets)
        result.emplace_back(set.begin(), set.end());
      return result;
    }

    /** The pattern of an assembled matrix, with rows and columns by places. */
    BlockPattern
    block_pattern(const AssemblyPattern &pattern, const std::vector<int> &order, const std::vector<int> &place)
    {
      const SparseMatrix matrix = pattern.scalar_matrix();
      BlockPattern       result;
      std::vector<int>   columns;
      for (const int row : order)
        {
          columns.clear();
          for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
            columns.push_back(place[entry.col()]);
          result.add_row(columns);
          result.value_starts.back() = 9 * pattern.row_start(row);
        }
      return result;
    }

    SparseMatrix
    in_order(const SparseMatrix &matrix, const std::vector<int> &place_of_row, const std::vector<int> &place_of_column)
    {
      std::vector<Eigen::Triplet<double>> entries;
      for (Eigen::Index row = 0; row < matrix.rows(); ++row)
        for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
          entries.emplace_back(place_of_row[row], place_of_column[entry.col()], entry.value());
      SparseMatrix result(matrix.rows(), matrix.cols());
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    }
  } // namespace


  LoopHierarchy::LoopHierarchy(const TriangleMesh &topology, const AssemblyPattern &pattern, const int n_parts, const int part)
    : order_(order_by_faces(topology))
  {
    TriangleMesh     mesh    = topology;
    std::vector<int> place   = inverse(order_);
    BlockPattern     present = block_pattern(pattern, order_, place);
    while (true)
      {
        LoopLevel level;
        level.n          = int(mesh.vertices.size());
        level.is_divided = n_parts > 1 && level.n >= least_rows * n_parts;
        level.begin      = level.is_divided ? level.first_point(part, n_parts) : 0;
        level.end        = level.is_divided ? level.first_point(part + 1, n_parts) : level.n;
        level.pattern    = std::move(present);

        const std::optional<TriangleMesh> coarse = level.n > most_coarse_points ? loop_coarsen(mesh) : std::optional<TriangleMesh>();
        if (!coarse)
          {
            levels_.push_back(std::move(level));
            return;
          }
        const std::vector<int> coarse_place = inverse(order_by_faces(*coarse));
        level.prolongation                  = in_order(loop_subdivision(*coarse), place, coarse_place);
        level.patches.emplace(neighbours(mesh, place), level.pattern, level.begin, level.end);
        present = GalerkinProduct::pattern(level.prolongation, level.pattern);
        level.product.emplace(level.prolongation, level.pattern, level.begin, level.end, present);
        levels_.push_back(std::move(level));
        mesh  = *coarse;
        place = coarse_place;
      }
  }
} // namespace tanktread
