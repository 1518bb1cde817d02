// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: solving with the shell's mass matrix.

#ifndef tanktread_surface_mass_inverse_h
#define tanktread_surface_mass_inverse_h

#include <tanktread/base/vector4.h>
#include <tanktread/surface/types.h>

#include <vector>

namespace tanktread
{
  /**
   * Inverse of a symmetric positive definite matrix M on the control points, for fields of three components. P M P^T = L D L^T, P from a nested dissection; L
   * passes through the processor once for all three components.
   */
  class MassInverse
  {
  public:
    /** Throws NumericalError if `mass` is singular. */
    explicit MassInverse(const SparseMatrix &mass);

    /** result = M^{-1} f, both NP x 3. Does not allocate if `result` has its size. Not for several threads at once. */
    void
    solve(const ControlPoints &f, ControlPoints &result) const;

  private:
    std::vector<int>             permutation_;          // place in the factor of each control point
    std::vector<int>             column_starts_, rows_; // of L below its diagonal of ones, by columns
    std::vector<double>          values_;
    std::vector<double>          inverse_diagonal_; // of D
    mutable std::vector<Vector4> work_;
  };
} // namespace tanktread

#endif
