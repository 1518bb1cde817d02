// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: signed distances from the shell at the nodes of the finest fluid cells near it.

#include <tanktread/base/exceptions.h>
#include <tanktread/coupling/surface_distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** Of the lattice there is no more than this to either side. Differences, doubles and neighbours of such indices are exact. */
    constexpr double farthest = 1e15;

    /** No shell that a mesh can resolve has more rows of cells: they would take a gigabyte. */
    constexpr double most_rows = 2e8;


    /** Order in which `items` have ascending keys in 0 ... n_keys - 1; equal ones stay as they are. Returns where each key begins, and the end. */
    template <typename Key>
    std::vector<unsigned int>
    sort_by_counting(const std::size_t n_keys, const Key &key, std::vector<unsigned int> &items)
    {
      std::vector<unsigned int> start(n_keys + 1, 0), sorted(items.size());
      for (const unsigned int item : items)
        ++start[key(item) + 1];
      std::partial_sum(start.begin(), start.end(), start.begin());
      std::vector<unsigned int> next(start);
      for (const unsigned int item : items)
        sorted[next[key(item)]++] = item;
      items.swap(sorted);
      return start;
    }


    /**
     * Squares of the distances, in cells, of a node from the cells -2, -1, 0 and 1 along one direction, where 0 contains it. One in the middle of a cell (with
     * an odd index) has three that are at most one cell away, one at a corner four.
     */
    const std::array<double, 4> &
    squares_to_cells(const bool is_odd)
    {
      constexpr double                       none   = std::numeric_limits<double>::infinity();
      static constexpr std::array<double, 4> corner = {{1., 0., 0., 1.}}, middle = {{none, 0.25, 0., 0.25}};
      return is_odd ? middle : corner;
    }


    /** A row of cells beside that of a node, and the square of its distance in cells. */
    struct RowNearby
    {
      int    y, z;
      double square;
    };


    /** The rows that are at most one cell away from a node in each direction, near ones first. */
    const std::vector<RowNearby> &
    rows_nearby(const bool y_is_odd, const bool z_is_odd)
    {
      static const std::array<std::vector<RowNearby>, 4> rows = [] {
        std::array<std::vector<RowNearby>, 4> result;
        for (unsigned int kind = 0; kind < 4; ++kind)
          {
            for (int z = -2; z < 2; ++z)
              for (int y = -2; y < 2; ++y)
                if (const double square = squares_to_cells(kind & 1)[y + 2] + squares_to_cells(kind & 2)[z + 2]; square < 3.)
                  result[kind].push_back({y, z, square});
            std::stable_sort(result[kind].begin(), result[kind].end(), [](const RowNearby &a, const RowNearby &b) { return a.square < b.square; });
          }
        return result;
      }();
      return rows[y_is_odd + 2 * z_is_odd];
    }


    /** Joins runs that overlap or touch; sorts them. */
    void
    merge(std::vector<CellRuns::Run> &runs)
    {
      std::sort(runs.begin(), runs.end(), [](const CellRuns::Run &a, const CellRuns::Run &b) { return a.begin < b.begin; });
      std::size_t n = 0;
      for (const CellRuns::Run &run : runs)
        if (n > 0 && run.begin <= runs[n - 1].end)
          runs[n - 1].end = std::max(runs[n - 1].end, run.end);
        else
          runs[n++] = run;
      runs.resize(n);
    }
  } // namespace


  SurfaceDistance::SurfaceDistance(const FluidMesh &mesh, std::vector<QuadraticPatch> patches)
    : h_(mesh.cell_size(mesh.finest_level()))
    , corner_(mesh.box().lower(0), mesh.box().lower(1), mesh.box().lower(2))
    , patches_(std::move(patches))
  {
    std::vector<Lattice> cells(patches_.size());
    Lattice              high;
    low_.fill(std::numeric_limits<std::int64_t>::max());
    high.fill(std::numeric_limits<std::int64_t>::min());
    for (std::size_t q = 0; q < patches_.size(); ++q)
      for (unsigned int d = 0; d < 3; ++d)
        {
          const double index = std::floor((patches_[q].X[d] - corner_[d]) / h_);
          if (!(std::abs(index) < farthest))
            throw NumericalError("A point of the shell has the coordinate " + std::to_string(patches_[q].X[d]) + ".");
          cells[q][d] = static_cast<std::int64_t>(index);
          low_[d]     = std::min(low_[d], cells[q][d] - 1);
          high[d]     = std::max(high[d], cells[q][d] + 1);
        }
    size_x_ = high[0] - low_[0] + 1;
    rows_   = {low_[1], low_[2], high[1] - low_[1] + 1, high[2] - low_[2] + 1};
    if (double(rows_.size_y) * rows_.size_z > most_rows || size_x_ > most_rows)
      throw NumericalError("The shell extends over " + std::to_string(size_x_) + " x " + std::to_string(rows_.size_y) + " x " + std::to_string(rows_.size_z) +
                           " of the finest cells: it has lost its shape.");
    sort_points(cells);
  }


  void
  SurfaceDistance::sort_points(const std::vector<Lattice> &cells)
  {
    order_.resize(cells.size());
    std::iota(order_.begin(), order_.end(), 0);
    sort_by_counting(
      size_x_,
      [&](const unsigned int q) { return cells[q][0] - low_[0]; },
      order_);
    const auto                      row          = [&](const unsigned int q) { return rows_.number(cells[q][1], cells[q][2]); };
    const std::vector<unsigned int> points_start = sort_by_counting(rows_.n_rows(), row, order_);

    start_.reserve(rows_.n_rows() + 1);
    positions_.resize(3, order_.size());
    for (std::size_t r = 0; r < rows_.n_rows(); ++r)
      {
        start_.push_back(cells_.size());
        for (unsigned int i = points_start[r]; i < points_start[r + 1]; ++i)
          {
            if (cells_.size() == start_.back() || cells_.back().x != cells[order_[i]][0])
              cells_.push_back({cells[order_[i]][0], i});
            positions_.col(i) = patches_[order_[i]].X;
          }
      }
    start_.push_back(cells_.size());
    cells_.push_back({0, static_cast<unsigned int>(order_.size())});
  }


  CellRuns
  SurfaceDistance::runs_nearby() const
  {
    CellRuns                   result(rows_);
    std::vector<CellRuns::Run> runs;
    for (std::int64_t z = rows_.low_z; z < rows_.low_z + rows_.size_z; ++z)
      for (std::int64_t y = rows_.low_y; y < rows_.low_y + rows_.size_y; ++y)
        {
          runs.clear();
          for (const std::int64_t z_other : {z - 1, z, z + 1})
            for (const std::int64_t y_other : {y - 1, y, y + 1})
              if (rows_.contain(y_other, z_other))
                {
                  const std::size_t row = rows_.number(y_other, z_other);
                  for (unsigned int i = start_[row]; i < start_[row + 1]; ++i)
                    runs.push_back({cells_[i].x - 1, cells_[i].x + 2});
                }
          merge(runs);
          result.add_row(runs);
        }
    return result;
  }


  std::vector<Lattice>
  SurfaceDistance::cells_nearby() const
  {
    // Around each cell with points, those that no cell before it has brought.
    const CellRuns       near = runs_nearby();
    std::vector<char>    known(near.n_cells(), 0);
    std::vector<Lattice> result;
    result.reserve(near.n_cells());
    for (std::int64_t z = rows_.low_z; z < rows_.low_z + rows_.size_z; ++z)
      for (std::int64_t y = rows_.low_y; y < rows_.low_y + rows_.size_y; ++y)
        {
          const std::size_t row = rows_.number(y, z);
          for (unsigned int i = start_[row]; i < start_[row + 1]; ++i)
            for (const std::int64_t z_other : {z - 1, z, z + 1})
              for (const std::int64_t y_other : {y - 1, y, y + 1})
                {
                  const Lattice     first{{cells_[i].x - 1, y_other, z_other}};
                  const std::size_t number = near.number(first); // and those of the next two follow
                  for (unsigned int k = 0; k < 3; ++k)
                    if (!std::exchange(known[number + k], 1))
                      result.push_back({{first[0] + k, y_other, z_other}});
                }
        }
    return result;
  }


  double
  SurfaceDistance::at(const Lattice &node) const
  {
    // The nearest point, of several the first: row by row outwards, until what is left must be farther away. Cells are as good as the rounding of their points'
    // positions.
    std::array<std::int64_t, 3> home; // the cell that contains the node, the upper one of two
    for (unsigned int d = 0; d < 3; ++d)
      home[d] = node[d] >= 0 ? node[d] / 2 : (node[d] - 1) / 2;
    const std::int64_t    first = home[0] - (node[0] % 2 == 0 ? 2 : 1), last = home[0] + 1;
    const Eigen::Vector3d y        = corner_ + 0.5 * h_ * Eigen::Vector3d(node[0], node[1], node[2]);
    constexpr double      rounding = 1e-9;
    double                nearest  = std::numeric_limits<double>::infinity();
    Eigen::Index          found    = order_.size();
    for (const RowNearby &near : rows_nearby(node[1] % 2 != 0, node[2] % 2 != 0))
      {
        if ((near.square - rounding) * h_ * h_ > nearest)
          break;
        if (!rows_.contain(home[1] + near.y, home[2] + near.z))
          continue;
        const std::size_t row   = rows_.number(home[1] + near.y, home[2] + near.z);
        const auto        begin = cells_.begin() + start_[row], end = cells_.begin() + start_[row + 1];
        const auto        from = std::partition_point(begin, end, [&](const Cell &cell) { return cell.x < first; });
        auto              to   = from;
        while (to != end && to->x <= last)
          ++to;
        if (from == to)
          continue;
        const auto   points    = positions_.middleCols(from->start, to->start - from->start).array();
        const auto   distances = (points.row(0) - y[0]).square() + ((points.row(1) - y[1]).square() + (points.row(2) - y[2]).square());
        const double least     = distances.minCoeff();
        if (least > nearest)
          continue;
        Eigen::Index i = 0;
        while (distances(i) > least)
          ++i;
        i += from->start;
        if (least < nearest || i < found)
          found = i;
        nearest = least;
      }
    return found == Eigen::Index(order_.size()) ? nearest : signed_distance(patches_[order_[found]], y);
  }
} // namespace tanktread
