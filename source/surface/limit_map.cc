// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a linear map from control points to points of the surface, by stencils that the points of a face share.

#include <tanktread/surface/limit_map.h>
#include <tanktread/surface/stencil_products.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tanktread
{
  namespace
  {
    const int *
    support(const LimitMap::Stencils &s, const unsigned int face)
    {
      return s.supports + std::size_t(face) * s.n;
    }

    /** Stencils of the points of a face. */
    StencilRows
    rows_of(const LimitMap::Stencils &s, const unsigned int face)
    {
      return {s.values + std::size_t(face) * s.n_points_per_face * s.stride, s.stride, s.n_points_per_face, s.n};
    }

    void
    multiply_numbers(const LimitMap::Stencils &s, const double *const x, double *y)
    {
      for (unsigned int f = 0; f < s.n_faces; ++f)
        for (unsigned int p = 0; p < s.n_points_per_face; ++p, ++y)
          {
            const double *const row = rows_of(s, f).begin + std::size_t(p) * s.stride;
            *y                      = 0.;
            for (unsigned int i = 0; i < s.n; ++i)
              *y += row[i] * x[support(s, f)[i]];
          }
    }

    void
    multiply_vectors(const LimitMap::Stencils &s, const double *const x, double *const y)
    {
      std::vector<Vector4> of_face(s.n);
      for (unsigned int f = 0; f < s.n_faces; ++f)
        {
          for (unsigned int i = 0; i < s.n; ++i)
            of_face[i] = Vector4(x + 3 * std::size_t(support(s, f)[i]));
          stencil_products(rows_of(s, f), of_face.data(), y + 3 * std::size_t(f) * s.n_points_per_face);
        }
    }

    void
    add_transposed_numbers(const LimitMap::Stencils &s, const double *y, double *const x)
    {
      for (unsigned int f = 0; f < s.n_faces; ++f)
        for (unsigned int p = 0; p < s.n_points_per_face; ++p, ++y)
          {
            const double *const row = rows_of(s, f).begin + std::size_t(p) * s.stride;
            for (unsigned int i = 0; i < s.n; ++i)
              x[support(s, f)[i]] += row[i] * *y;
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
      multiply_numbers(stencils_, x, y);
    else
      multiply_vectors(stencils_, x, y);
  }


  void
  LimitMap::apply_transposed(const Eigen::Index n_rows, const Eigen::Index n_columns, const double *const y, double *const x) const
  {
    expect_size(n_rows, n_columns, rows());
    if (n_columns == 1)
      add_transposed_numbers(stencils_, y, x);
    else
      for (unsigned int f = 0; f < stencils_.n_faces; ++f)
        add_transposed_stencil_products(rows_of(stencils_, f), y + 3 * std::size_t(f) * stencils_.n_points_per_face, support(stencils_, f), x);
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
