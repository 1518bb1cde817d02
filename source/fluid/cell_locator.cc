// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which cell of the octree a point lies in.

#include <tanktread/fluid/cell_locator.h>

#include <algorithm>
#include <functional>

namespace tanktread
{
  namespace
  {
    /** The uppermost bits of the product with 2^64 / golden ratio, which depend on all bits of the key. */
    std::size_t
    hash(const std::uint64_t key, const unsigned int shift)
    {
      return (key * 0x9e3779b97f4a7c15u) >> shift;
    }
  } // namespace


  CellLocator::CellLocator(const FluidMesh &mesh)
    : mesh_(mesh)
  {
    std::vector<Slot> cells;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cells.push_back({mesh.key(cell).packed(), int(cells.size())});
          levels_.push_back(cell->level());
        }
    std::sort(levels_.begin(), levels_.end(), std::greater<unsigned int>());
    levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());

    std::size_t n_slots = 2;
    for (shift_ = 63; n_slots < 2 * cells.size(); --shift_)
      n_slots *= 2;
    slots_.assign(n_slots, {0, -1});
    for (const Slot &cell : cells)
      {
        std::size_t i = hash(cell.key, shift_);
        while (slots_[i].cell >= 0)
          i = (i + 1) & (n_slots - 1);
        slots_[i] = cell;
      }
  }


  int
  CellLocator::find(const std::uint64_t key) const
  {
    std::size_t i = hash(key, shift_);
    while (slots_[i].cell >= 0 && slots_[i].key != key)
      i = (i + 1) & (slots_.size() - 1);
    return slots_[i].cell;
  }


  CellLocator::Location
  CellLocator::locate(const dealii::Point<3> &point) const
  {
    Location               result;
    const FluidMesh::Place fine = mesh_.place(point, mesh_.finest_level());
    for (const unsigned int level : levels_)
      {
        // The cube of a coarser level: exact, since positions on the two levels differ by a power of two.
        const unsigned int finer = fine.key.level - level;
        CellKey            key   = {level, fine.key.position};
        for (int &i : key.position)
          i >>= finer;
        result.cell = find(key.packed());
        if (result.cell < 0)
          continue;
        for (unsigned int d = 0; d < 3; ++d)
          result.unit[d] = (fine.key.position[d] - (key.position[d] << finer) + fine.unit[d]) / (1 << finer);
        break;
      }
    return result;
  }
} // namespace tanktread
