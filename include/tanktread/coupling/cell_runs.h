// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: sets of finest fluid cells as runs along x, and what such a set encloses.

#ifndef tanktread_coupling_cell_runs_h
#define tanktread_coupling_cell_runs_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tanktread
{
  /**
   * Position of a finest cell, or twice that of a node, counted from the box's lower corner and not wrapped periodically: a capsule may drift through many
   * periods.
   */
  using Lattice = std::array<std::int64_t, 3>;

  /** Of a CellKey's position. */
  inline Lattice
  lattice(const std::array<int, 3> &position)
  {
    return {{position[0], position[1], position[2]}};
  }

  /** The rows of cells along x with low_y <= y < low_y + size_y, the same in z. */
  struct LatticeRows
  {
    std::int64_t low_y = 0, low_z = 0, size_y = 0, size_z = 0;

    bool
    contain(const std::int64_t y, const std::int64_t z) const
    {
      return y >= low_y && y < low_y + size_y && z >= low_z && z < low_z + size_z;
    }
    /** Of a row that is contained; by z, then by y. */
    std::size_t
    number(const std::int64_t y, const std::int64_t z) const
    {
      return (z - low_z) * size_y + (y - low_y);
    }
    std::size_t
    n_rows() const
    {
      return size_y * size_z;
    }
  };

  /** A set of cells: the runs of successive cells in each row. Memory goes with the numbers of rows and runs. */
  class CellRuns
  {
  public:
    /** The cells begin <= x < end of a row. */
    struct Run
    {
      std::int64_t begin, end;
    };

    explicit CellRuns(const LatticeRows &rows)
      : rows_(rows)
      , start_{0}
      , cells_before_{0}
    {}

    /** The next row: its runs in ascending order, with gaps between them. */
    void
    add_row(const std::vector<Run> &runs);

    const LatticeRows &
    rows() const
    {
      return rows_;
    }

    /** All runs, row by row. */
    const std::vector<Run> &
    runs() const
    {
      return runs_;
    }

    /** The first run of a row; that of the next row is the end of this one's. */
    std::size_t
    first_run(const std::size_t row) const
    {
      return start_[row];
    }

    /** The first run of a row that ends behind x, first_run(row + 1) if none does. */
    std::size_t
    find_run(std::size_t row, std::int64_t x) const;

    std::size_t
    n_cells() const
    {
      return cells_before_.back();
    }

    /** Number of a cell of the set, in 0 ... n_cells() - 1; by rows, then by x. */
    std::size_t
    number(const Lattice &cell) const;

  private:
    LatticeRows              rows_;
    std::vector<std::size_t> start_; // of each row's runs
    std::vector<Run>         runs_;
    std::vector<std::size_t> cells_before_; // each run, and in all
  };

  /** Where a cell is as seen from a set of cells. */
  enum class Side : char
  {
    inside, // cannot be reached from far away through faces of cells that are not in the set
    outside,
    near // in the set
  };

  /** Tells the cells that a set encloses: a flood fill from outside, not of cells but of the gaps between runs. */
  class CellSides
  {
  public:
    explicit CellSides(CellRuns near);

    Side
    at(const Lattice &cell) const;

  private:
    /** Cells between two runs of a row, before the first or behind the last. */
    struct Gap
    {
      std::int64_t y, z, begin, end;
    };

    /** Row (y, z) can be reached wherever `neighbour` is: the gaps it has there are outside. Appends those of which that is news to `front`. */
    void
    enter(std::int64_t y, std::int64_t z, const Gap &neighbour, std::vector<Gap> &front);

    CellRuns          near_;
    std::vector<char> open_; // for each run: whether the gap before it is outside
  };
} // namespace tanktread

#endif
