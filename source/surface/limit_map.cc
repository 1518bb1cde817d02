// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a linear map from control points to points of the surface, by stencils that the points of a face share.

#include <tanktread/surface/limit_map.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tanktread
{
  namespace
  {
    template <int n_columns>
    using Block = Eigen::Matrix<double, Eigen::Dynamic, n_columns, n_columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

    using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0, Eigen::OuterStride<>>;

    /** Stencils of the points of a face, a row each. */
    Rows
    rows_of(const LimitMap::Stencils &s, const unsigned int face)
    {
      return {s.values + std::size_t(face) * s.n_points_per_face * s.stride, s.n_points_per_face, s.n, Eigen::OuterStride<>(s.stride)};
    }

    template <int n_columns>
    void
    multiply(const LimitMap::Stencils &s, const double *const x, double *const y)
    {
      Block<n_columns> of_face(s.n, n_columns);
      for (unsigned int f = 0; f < s.n_faces; ++f)
        {
          for (unsigned int i = 0; i < s.n; ++i)
            for (int c = 0; c < n_columns; ++c)
              of_face(i, c) = x[std::size_t(n_columns) * s.supports[std::size_t(f) * s.n + i] + c];
          Eigen::Map<Block<n_columns>> points(y + std::size_t(f) * s.n_points_per_face * n_columns, s.n_points_per_face, n_columns);
          points.noalias() = rows_of(s, f).lazyProduct(of_face);
        }
    }

    template <int n_columns>
    void
    add_transposed_product(const LimitMap::Stencils &s, const double *const y, double *const x)
    {
      Block<n_columns> of_face(s.n, n_columns);
      for (unsigned int f = 0; f < s.n_faces; ++f)
        {
          const Eigen::Map<const Block<n_columns>> points(y + std::size_t(f) * s.n_points_per_face * n_columns, s.n_points_per_face, n_columns);
          of_face.noalias() = rows_of(s, f).transpose().lazyProduct(points);
          for (unsigned int i = 0; i < s.n; ++i)
            for (int c = 0; c < n_columns; ++c)
              x[std::size_t(n_columns) * s.supports[std::size_t(f) * s.n + i] + c] += of_face(i, c);
        }
    }

    void
    expect_size(const Eigen::Index rows, const Eigen::Index columns, const Eigen::Index wanted)
    {
      if (rows != wanted || (columns != 1 && columns != 3))
        throw std::logic_error("A surface's map got a field of " + std::to_string(rows) + " x " + std::to_string(columns) + " numbers for " +
                               std::to_string(wanted) + " points.");
    }
  } // namespace


  void
  LimitMap::apply(const Eigen::Index n_rows, const Eigen::Index n_columns, const double *const x, double *const y) const
  {
    expect_size(n_rows, n_columns, stencils_.n_control_points);
    if (n_columns == 1)
      multiply<1>(stencils_, x, y);
    else
      multiply<3>(stencils_, x, y);
  }


  void
  LimitMap::apply_transposed(const Eigen::Index n_rows, const Eigen::Index n_columns, const double *const y, double *const x) const
  {
    expect_size(n_rows, n_columns, rows());
    if (n_columns == 1)
      add_transposed_product<1>(stencils_, y, x);
    else
      add_transposed_product<3>(stencils_, y, x);
  }


  Eigen::RowVector3d
  LimitMap::at(const unsigned int point, const ControlPoints &x) const
  {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (unsigned int i = 0; i < stencils_.n; ++i)
      sum += stencils_.values[std::size_t(point) * stencils_.stride + i] *
        x.row(stencils_.supports[std::size_t(point / stencils_.n_points_per_face) * stencils_.n + i]);
    return sum;
  }


  SparseMatrix
  LimitMap::matrix() const
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index q = 0; q < rows(); ++q)
      for (unsigned int i = 0; i < stencils_.n; ++i)
        if (const double value = stencils_.values[std::size_t(q) * stencils_.stride + i]; value != 0.)
          entries.emplace_back(int(q), stencils_.supports[std::size_t(q / stencils_.n_points_per_face) * stencils_.n + i], value);
    SparseMatrix result(rows(), stencils_.n_control_points);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
} // namespace tanktread
