// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the two matrix types that everything about the shell is written in.

#ifndef tanktread_surface_types_h
#define tanktread_surface_types_h

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace tanktread
{
  /** One 3-vector a row: control points (NP x 3), forces, velocities, fields at points. Flattened: index 3 I + c. */
  using ControlPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

  /** Sparse operators on control points, stored by rows. */
  using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
} // namespace tanktread

#endif
