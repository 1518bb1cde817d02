// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the fixed sparsity pattern of matrices assembled face by face, and where each face's entries go.

#ifndef tanktread_surface_assembly_pattern_h
#define tanktread_surface_assembly_pattern_h

#include <tanktread/surface/types.h>

#include <vector>

namespace tanktread
{
  /**
   * Control points I and J are coupled when some face depends on both. Gives zero matrices with that pattern, NP x NP or with 3 x 3 blocks, and for each face
   * the positions of its entries in their value arrays, so that adding a face costs no search.
   */
  class AssemblyPattern
  {
  public:
    /** `supports` lists the control points of each face, `support_size` a face, repetitions allowed; there are `n_control_points` in all. */
    AssemblyPattern(unsigned int n_control_points, unsigned int support_size, const std::vector<int> &supports);

    /** Zero matrix, NP x NP, compressed, columns ascending. */
    SparseMatrix
    scalar_matrix() const;

    /** Zero matrix, 3 NP x 3 NP, compressed, rows and columns 3 I + c. */
    SparseMatrix
    block_matrix() const;

    /** Number of entries of block_matrix(). */
    Eigen::Index
    n_block_entries() const
    {
      return 9 * Eigen::Index(columns_.size());
    }

    /** First value of row I in scalar_matrix(). */
    int
    row_start(const int row) const
    {
      return row_starts_[row];
    }

    /** Number of control points that I is coupled to, itself included. */
    int
    row_length(const int row) const
    {
      return row_starts_[row + 1] - row_starts_[row];
    }

    /**
     * For the n = support_size control points I_i of a face: entry i n + j is the place of J = I_j among the columns of row I_i, counted from the row's start.
     * Hence (I_i, J) is value row_start(I_i) + place of scalar_matrix(), and (3 I_i + c, 3 J + d) is value
     * 9 row_start(I_i) + 3 (c row_length(I_i) + place) + d of block_matrix().
     */
    const int *
    places(const unsigned int face) const
    {
      return places_.data() + std::size_t(face) * support_size_ * support_size_;
    }

  private:
    unsigned int     support_size_;
    std::vector<int> row_starts_, columns_, places_;
  };

  /**
   * blocks += matrix (x) `components`, for a scalar_matrix() and a block_matrix() of the same pattern. Throws std::logic_error when the numbers of entries do
   * not
   * fit.
   */
  void
  add_for_three_components(const SparseMatrix &matrix, SparseMatrix &blocks, const Eigen::Matrix3d &components = Eigen::Matrix3d::Identity());
} // namespace tanktread

#endif
