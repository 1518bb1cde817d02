// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: rows of sparse matrices of 3 x 3 blocks.

#ifndef tanktread_solver_block_rows_h
#define tanktread_solver_block_rows_h

#include <array>
#include <vector>

namespace tanktread
{
  /** A field of 3-vectors with a fourth number each, which stays zero. */
  using PaddedField = std::vector<double>;

  /**
   * Where the blocks of a square matrix are: block row i has those with columns[starts[i]], ..., columns[starts[i + 1] - 1]. Their values are in an array like
   * that of AssemblyPattern::block_matrix(), in
   * which the rows may come in another order: number (c, d) of the k-th block is at value_starts[i] + 3 (c l + k) + d, l the number of blocks in the row.
   */
  struct BlockPattern
  {
    std::vector<int> starts = {0}, columns, value_starts;

    int
    n_rows() const
    {
      return int(starts.size()) - 1;
    }
    int
    length(const int row) const
    {
      return starts[row + 1] - starts[row];
    }
    /** Adds a row whose values follow those of the rows before it. */
    void
    add_row(const std::vector<int> &columns_of_row);
    /** Which of the blocks of a row has this column. Throws std::logic_error if none has. */
    int
    place(int row, int column) const;
  };

  /** The rows begin <= i < end of a matrix with a BlockPattern, in single precision. */
  class BlockRows
  {
  public:
    BlockRows() = default;
    BlockRows(const BlockPattern &pattern, int begin, int end);

    /** Takes the rows out of the array of all values. */
    void
    set(const BlockPattern &pattern, const double *values);

    void
    set_zero();
    /** Adds to the block that is the k-th of all in these rows. */
    void
    add(const int k, const int c, const int d, const double value)
    {
      blocks_[k][4 * d + c] += float(value);
    }

    /** y = A x in these rows. */
    void
    multiply(const PaddedField &x, PaddedField &y) const;
    /** r = b - A x in these rows. */
    void
    residual(const PaddedField &b, const PaddedField &x, PaddedField &r) const;

    int
    begin() const
    {
      return begin_;
    }
    int
    end() const
    {
      return begin_ + int(starts_.size()) - 1;
    }

  private:
    int                                begin_  = 0;
    std::vector<int>                   starts_ = {0}, columns_;
    std::vector<std::array<float, 12>> blocks_; // by columns, of four numbers
  };
} // namespace tanktread

#endif
