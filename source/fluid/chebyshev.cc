// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the largest eigenvalue of a tridiagonal matrix.

#include <Eigen/Eigenvalues>
#include <tanktread/fluid/chebyshev.h>

namespace tanktread
{
  double
  largest_tridiagonal_eigenvalue(const std::vector<double> &diagonal, const std::vector<double> &beside)
  {
    using Map = Eigen::Map<const Eigen::VectorXd>;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(Map(diagonal.data(), diagonal.size()), Map(beside.data(), beside.size()), Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff();
  }
} // namespace tanktread
