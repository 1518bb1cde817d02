// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: sparse LU factors of the shell's matrices.

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/block_factorisation.h>

#include <metis.h>

#include <stdexcept>
#include <vector>

namespace tanktread
{
  void
  BlockNestedDissection::operator()(const Eigen::SparseMatrix<double, Eigen::ColMajor, int> &matrix, PermutationType &permutation) const
  {
    idx_t              n = idx_t(matrix.cols() / 3);
    std::vector<idx_t> starts(1, 0), neighbours, new_to_old(n), old_to_new(n);
    for (idx_t i = 0; i < n; ++i)
      {
        for (Eigen::SparseMatrix<double, Eigen::ColMajor, int>::InnerIterator entry(matrix, 3 * i); entry; ++entry)
          if (entry.row() % 3 == 0 && entry.row() != 3 * i)
            neighbours.push_back(entry.row() / 3);
        starts.push_back(idx_t(neighbours.size()));
      }
    if (METIS_NodeND(&n, starts.data(), neighbours.data(), nullptr, nullptr, new_to_old.data(), old_to_new.data()) != METIS_OK)
      throw std::runtime_error("METIS cannot order the shell's matrix.");
    permutation.resize(3 * n);
    for (idx_t i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c)
        permutation.indices()[3 * i + c] = int(3 * old_to_new[i] + c);
  }


  void
  BlockFactorisation::factorise(const SparseMatrix &matrix, const std::string &what)
  {
    const Eigen::SparseMatrix<double, Eigen::ColMajor, int> by_columns = matrix;
    if (!analysed_)
      {
        // The order is for the pattern of L + U: nearly all pivots have to stay on the diagonal.
        factors_.isSymmetric(true);
        factors_.setPivotThreshold(0.1);
        factors_.analyzePattern(by_columns);
        analysed_ = true;
      }
    factors_.factorize(by_columns);
    if (factors_.info() != Eigen::Success)
      throw NumericalError(what + " is singular.");
  }


  Eigen::VectorXd
  BlockFactorisation::solve(const Eigen::Ref<const Eigen::VectorXd> &rhs) const
  {
    return factors_.solve(rhs);
  }
} // namespace tanktread
