// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which cell of the octree a point lies in.

#ifndef tanktread_fluid_cell_locator_h
#define tanktread_fluid_cell_locator_h

#include <deal.II/base/point.h>

#include <tanktread/fluid/fluid_mesh.h>

#include <cstdint>
#include <vector>

namespace tanktread
{
  /**
   * Finds cells by integer coordinates: a point's position on level l is floor((x - corner) / h_l), so the search is a few look-ups in a table, has no
   * tolerance and gives each point exactly one cell (the upper one if it lies on a face) on exactly one rank.
   */
  class CellLocator
  {
  public:
    struct Location
    {
      int              cell = -1; // index among the locally owned active cells in deal.II's order; -1: not on this rank
      dealii::Point<3> unit;      // position in the unit cell
    };

    /** Of the mesh as it is now. */
    explicit CellLocator(const FluidMesh &mesh);

    /**
     * The point is wrapped into the box along periodic axes; throws NumericalError if it is not between the faces with prescribed velocity, on ranks without
     * cells as well.
     */
    Location
    locate(const dealii::Point<3> &point) const;

  private:
    /** Index of the cell with that packed key, or -1. */
    int
    find(std::uint64_t key) const;

    /** A place in the table; free while cell is negative. */
    struct Slot
    {
      std::uint64_t key;
      int           cell;
    };

    const FluidMesh          &mesh_;
    std::vector<Slot>         slots_;  // open addressing: a key is at its hash or in the next occupied places; 2^n of them, at most half occupied
    unsigned int              shift_;  // 64 - n
    std::vector<unsigned int> levels_; // that occur on this rank, finest first
  };
} // namespace tanktread

#endif
