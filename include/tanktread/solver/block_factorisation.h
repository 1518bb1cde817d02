// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: sparse LU factors of the shell's matrices.

#ifndef tanktread_solver_block_factorisation_h
#define tanktread_solver_block_factorisation_h

#include <Eigen/SparseLU>
#include <tanktread/surface/types.h>

#include <string>

namespace tanktread
{
  /** Nested dissection (METIS) of a matrix with a symmetric pattern of full 3 x 3 blocks, in the form that Eigen wants: found on the graph of the blocks. */
  struct BlockNestedDissection
  {
    using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

    void
    operator()(const Eigen::SparseMatrix<double, Eigen::ColMajor, int> &matrix, PermutationType &permutation) const;
  };

  /**
   * LU factors of matrices with the pattern of AssemblyPattern::block_matrix(), ordered by nested dissection, pivots on the diagonal where they are not small.
   * Measured on one core for Z + tau K of LinearisedShell with 642, 2562, 10242 control points: 24, 230, 2200 ms a factorisation, 0.3, 3.7, 24 ms a solve.
   * (COLAMD: 48 and
   * 770 ms, 0.4 and 8.2 ms, the largest not finished in a minute; UMFPACK twice as slow; CHOLMOD and LDL^T, for symmetric matrices only, no faster.)
   */
  class BlockFactorisation
  {
  public:
    /** The pattern has to be the same in all calls. Throws NumericalError that begins with `what` when the matrix is singular. */
    void
    factorise(const SparseMatrix &matrix, const std::string &what);

    Eigen::VectorXd
    solve(const Eigen::Ref<const Eigen::VectorXd> &rhs) const;

  private:
    bool                                                                                      analysed_ = false;
    Eigen::SparseLU<Eigen::SparseMatrix<double, Eigen::ColMajor, int>, BlockNestedDissection> factors_;
  };
} // namespace tanktread

#endif
