// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: sets of finest fluid cells as runs along x, and what such a set encloses.

#include <tanktread/coupling/cell_runs.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace tanktread
{
  void
  CellRuns::add_row(const std::vector<Run> &runs)
  {
    for (const Run &run : runs)
      {
        runs_.push_back(run);
        cells_before_.push_back(cells_before_.back() + (run.end - run.begin));
      }
    start_.push_back(runs_.size());
  }


  std::size_t
  CellRuns::find_run(const std::size_t row, const std::int64_t x) const
  {
    const auto begin = runs_.begin() + start_[row], end = runs_.begin() + start_[row + 1];
    return std::partition_point(begin, end, [x](const Run &run) { return run.end <= x; }) - runs_.begin();
  }


  std::size_t
  CellRuns::number(const Lattice &cell) const
  {
    const std::size_t run = find_run(rows_.number(cell[1], cell[2]), cell[0]);
    return cells_before_[run] + (cell[0] - runs_[run].begin);
  }


  CellSides::CellSides(CellRuns near)
    : near_(std::move(near))
    , open_(near_.runs().size(), 0)
  {
    constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min(), highest = std::numeric_limits<std::int64_t>::max();
    const LatticeRows     &rows = near_.rows();
    std::vector<Gap>       front;
    // What extends to infinity, in the rows around the set too.
    for (std::int64_t z = rows.low_z - 1; z <= rows.low_z + rows.size_z; ++z)
      for (std::int64_t y = rows.low_y - 1; y <= rows.low_y + rows.size_y; ++y)
        {
          const bool        is_known = rows.contain(y, z);
          const std::size_t first = is_known ? near_.first_run(rows.number(y, z)) : 0, end = is_known ? near_.first_run(rows.number(y, z) + 1) : 0;
          if (first == end)
            front.push_back({y, z, lowest, highest});
          else
            {
              open_[first] = 1;
              front.push_back({y, z, lowest, near_.runs()[first].begin});
              front.push_back({y, z, near_.runs()[end - 1].end, highest});
            }
        }
    while (!front.empty())
      {
        const Gap gap = front.back();
        front.pop_back();
        enter(gap.y - 1, gap.z, gap, front);
        enter(gap.y + 1, gap.z, gap, front);
        enter(gap.y, gap.z - 1, gap, front);
        enter(gap.y, gap.z + 1, gap, front);
      }
  }


  void
  CellSides::enter(const std::int64_t y, const std::int64_t z, const Gap &neighbour, std::vector<Gap> &front)
  {
    if (!near_.rows().contain(y, z))
      return;
    const std::size_t row  = near_.rows().number(y, z);
    const auto       &runs = near_.runs();
    // The first run is before no gap that ends.
    for (std::size_t i = std::max(near_.first_run(row) + 1, near_.find_run(row, neighbour.begin)); i < near_.first_run(row + 1); ++i)
      {
        if (runs[i - 1].end >= neighbour.end)
          break;
        if (runs[i].begin > neighbour.begin && !std::exchange(open_[i], 1))
          front.push_back({y, z, runs[i - 1].end, runs[i].begin});
      }
  }


  Side
  CellSides::at(const Lattice &cell) const
  {
    if (!near_.rows().contain(cell[1], cell[2]))
      return Side::outside;
    const std::size_t row = near_.rows().number(cell[1], cell[2]), run = near_.find_run(row, cell[0]);
    if (run == near_.first_run(row + 1))
      return Side::outside;
    if (near_.runs()[run].begin <= cell[0])
      return Side::near;
    return open_[run] ? Side::outside : Side::inside;
  }
} // namespace tanktread
