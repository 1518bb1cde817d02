// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: solving with the shell's mass matrix.

#include <iostream> // MetisSupport of Eigen 3.4 forgets it

#include <Eigen/MetisSupport>
#include <Eigen/SparseCholesky>
#include <tanktread/base/exceptions.h>
#include <tanktread/surface/mass_inverse.h>

namespace tanktread
{
  MassInverse::MassInverse(const SparseMatrix &mass)
    : column_starts_(1, 0)
    , work_(mass.rows())
  {
    using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    const Eigen::SimplicialLDLT<ColumnMatrix, Eigen::Lower, Eigen::MetisOrdering<int>> factorisation(mass);
    if (factorisation.info() != Eigen::Success)
      throw NumericalError("The shell's mass matrix is singular: the control mesh has degenerate faces or too few quadrature points.");
    const auto           &indices  = factorisation.permutationP().indices();
    const Eigen::VectorXd diagonal = factorisation.vectorD();
    const ColumnMatrix    L        = factorisation.matrixL();
    permutation_.assign(indices.data(), indices.data() + indices.size());
    for (int j = 0; j < L.cols(); ++j)
      {
        for (ColumnMatrix::InnerIterator entry(L, j); entry; ++entry)
          if (entry.row() > j)
            {
              rows_.push_back(int(entry.row()));
              values_.push_back(entry.value());
            }
        column_starts_.push_back(int(rows_.size()));
        inverse_diagonal_.push_back(1. / diagonal[j]);
      }
  }


  void
  MassInverse::solve(const ControlPoints &f, ControlPoints &result) const
  {
    const int n = int(permutation_.size());
    for (int i = 0; i < n; ++i)
      work_[permutation_[i]] = Vector4(f.data() + 3 * i);
    for (int j = 0; j < n; ++j)
      {
        const Vector4 x = work_[j];
        for (int k = column_starts_[j]; k < column_starts_[j + 1]; ++k)
          work_[rows_[k]] -= values_[k] * x;
      }
    for (int j = n - 1; j >= 0; --j)
      {
        Vector4 x = inverse_diagonal_[j] * work_[j];
        for (int k = column_starts_[j]; k < column_starts_[j + 1]; ++k)
          x -= values_[k] * work_[rows_[k]];
        work_[j] = x;
      }
    result.resize(n, 3);
    for (int i = 0; i < n; ++i)
      work_[permutation_[i]].store(result.data() + 3 * i);
  }
} // namespace tanktread
