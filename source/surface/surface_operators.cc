// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: mass matrix and Laplace-Beltrami operator on the control points.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace tanktread
{
  namespace
  {
    using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /** Assembles face by face: add_point(q, stencils, block) adds what point q with its `stencils` (kinds x n) gives to the n x n `block` of its face. */
    template <typename AddPoint>
    SparseMatrix
    assemble(const SubdivisionSurface &surface, const AddPoint &add_point)
    {
      const AssemblyPattern &pattern = surface.pattern();
      SparseMatrix           matrix  = pattern.scalar_matrix();
      double                *values  = matrix.valuePtr();
      const unsigned int     n = surface.support_size(), n_points = surface.n_points_per_face();
      RowMajorMatrix         block(n, n);
      for (unsigned int f = 0; f < surface.n_faces(); ++f)
        {
          block.setZero();
          for (unsigned int q = f * n_points; q < (f + 1) * n_points; ++q)
            add_point(q, Eigen::Map<const RowMajorMatrix>(surface.stencils(q), surface.n_stencils(), n), block);
          const int *support = surface.support(f), *places = pattern.places(f);
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              values[pattern.row_start(support[i]) + places[i * n + j]] += block(i, j);
        }
      return matrix;
    }
  } // namespace


  SparseMatrix
  mass_matrix(const SubdivisionSurface &surface, const Eigen::VectorXd &point_weights)
  {
    if (point_weights.size() != Eigen::Index(surface.n_points()))
      throw std::logic_error("mass_matrix() got " + std::to_string(point_weights.size()) + " weights for " + std::to_string(surface.n_points()) + " points.");
    return assemble(surface, [&](const unsigned int q, const auto &stencils, RowMajorMatrix &block) {
      block.noalias() += (point_weights[q] * stencils.row(0).transpose()) * stencils.row(0);
    });
  }


  SparseMatrix
  laplace_beltrami(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    const ControlPoints a_1 = surface.S_1() * x, a_2 = surface.S_2() * x;
    return assemble(surface, [&](const unsigned int q, const auto &stencils, RowMajorMatrix &block) {
      const double a11 = a_1.row(q).squaredNorm(), a12 = a_1.row(q).dot(a_2.row(q)), a22 = a_2.row(q).squaredNorm();
      const double det = a11 * a22 - a12 * a12;
      if (!(det > 0) || !std::isfinite(det))
        throw NumericalError("The surface is degenerate in face " + std::to_string(q / surface.n_points_per_face()) + ".");
      Eigen::Matrix2d contravariant;
      contravariant << a22, -a12, -a12, a11;
      const Eigen::Matrix<double, 2, Eigen::Dynamic> flux = (surface.weights()[q] / std::sqrt(det) * contravariant) * stencils.template middleRows<2>(1);
      block.noalias() += stencils.template middleRows<2>(1).transpose() * flux;
    });
  }
} // namespace tanktread
