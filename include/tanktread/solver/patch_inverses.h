// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the inverses of a shell's matrix on the neighbourhoods of its control points, added up.

#ifndef tanktread_solver_patch_inverses_h
#define tanktread_solver_patch_inverses_h

#include <tanktread/solver/block_rows.h>

#include <vector>

namespace tanktread
{
  /**
   * Additive Schwarz smoother B = sum_p R_p^T (R_p S R_p^T)^{-1} R_p, the patch p of a control point being the point and its neighbours in the control mesh. B
   * is computed as a matrix: it has half
   * as many blocks as S, a tenth of the numbers that all patches have.
   */
  class PatchInverses
  {
  public:
    /** @param neighbours of each control point. @param pattern of S, which holds those of the patches. Rows begin <= i < end of B. */
    PatchInverses(const std::vector<std::vector<int>> &neighbours, const BlockPattern &pattern, int begin, int end);

    /** Zero, to be filled by compute(). */
    BlockRows
    matrix() const
    {
      return {pattern_, begin_, end_};
    }

    /**
     * B for the matrix S of these values; `starts` are those of its pattern. By elimination without pivots, which needs positive (or otherwise harmless) patches: the result is not finite, or
     * useless, where they are not.
     */
    void
    compute(const std::vector<int> &starts, const double *values, BlockRows &B) const;

  private:
    static constexpr int n_lanes = 8; // patches inverted at once

    int              begin_, end_;
    int              size_; // points in the largest patch
    BlockPattern     pattern_;
    std::vector<int> n_points_; // of each patch
    std::vector<int> rows_;     // size_ points of each patch
    std::vector<int> sources_;  // size_^2 for each patch: where the block's values begin in S
    std::vector<int> targets_;  // likewise, which block of B; -1: of a row that is not among these
  };
} // namespace tanktread

#endif
