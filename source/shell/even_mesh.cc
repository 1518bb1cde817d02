// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: moving the control points along a shell that does not feel it, so that they stay evenly spread.

#include <Eigen/SparseCholesky>
#include <tanktread/base/exceptions.h>
#include <tanktread/shell/even_mesh.h>
#include <tanktread/surface/rigid_motion.h>
#include <tanktread/surface/surface_geometry.h>

namespace tanktread
{
  namespace
  {
    // In units of the sheet's E h over a^2: normal displacements cost much more than what strains the sheet over a radius, rotations of a sphere a little.
    constexpr double normal_stiffness = 100., any_stiffness = 0.01;

    /** What is left of the part across the shell falls with each sweep. */
    constexpr unsigned int n_sweeps = 3;

    /** matrix += S^T diag(weights) (normal_stiffness n n^T + any_stiffness) S, in the pattern of AssemblyPattern::block_matrix(). */
    void
    add_normal_stiffness(const SubdivisionSurface &surface, const Eigen::VectorXd &weights, const ControlPoints &n, SparseMatrix &matrix)
    {
      const AssemblyPattern &pattern = surface.pattern();
      const unsigned int     size = surface.support_size(), n_points = surface.n_points_per_face();
      double                *values = matrix.valuePtr();
      for (unsigned int q = 0; q < surface.n_points(); ++q)
        {
          const unsigned int    f         = q / n_points;
          const double         *S         = surface.stencils(q);
          const Eigen::Matrix3d stiffness = weights[q] * (normal_stiffness * n.row(q).transpose() * n.row(q) + any_stiffness * Eigen::Matrix3d::Identity());
          for (unsigned int i = 0; i < size; ++i)
            for (unsigned int j = 0; j < size; ++j)
              {
                const int row = surface.support(f)[i], length = 3 * pattern.row_length(row);
                double   *entry = values + 9 * pattern.row_start(row) + 3 * pattern.places(f)[i * size + j];
                for (unsigned int c = 0; c < 3; ++c)
                  Eigen::Map<Eigen::RowVector3d>(entry + c * length) += S[i] * S[j] * stiffness.row(c);
              }
        }
    }

    ShellParameters
    sheet_parameters()
    {
      ShellParameters result;
      result.law = MembraneLaw::neo_hookean;
      return result;
    }
  } // namespace


  EvenMesh::EvenMesh(const Capsule &capsule)
    : capsule_(capsule)
    , sheet_(capsule.surface(), sheet_parameters(), {1., 0.}, capsule.initial())
  {}


  ControlPoints
  EvenMesh::velocity(const ShellConfiguration &shell, const ControlPoints &U, const double rate) const
  {
    return along(shell, rate * relaxation(shell) - without_rigid_motion(shell.x(), U));
  }


  ControlPoints
  EvenMesh::along(const ShellConfiguration &shell, const ControlPoints &field) const
  {
    const SubdivisionSurface &surface = capsule_.coupling_surface();
    const ControlPoints       n       = normals(surface, shell.x());
    ControlPoints             result  = field;
    for (unsigned int sweep = 0; sweep < n_sweeps; ++sweep)
      {
        const ControlPoints   values  = surface.S() * result;
        const Eigen::VectorXd through = values.cwiseProduct(n).rowwise().sum().cwiseProduct(capsule_.weights());
        const ControlPoints   load    = through.asDiagonal() * n;
        result -= capsule_.density(surface.S().transposed_times(load));
      }
    result -= shell.volume_gradient().cwiseProduct(result).sum() / shell.normal_square() * shell.normal_field();
    return result;
  }


  ControlPoints
  EvenMesh::relaxation(const ShellConfiguration &shell) const
  {
    const SubdivisionSurface &surface = capsule_.surface();
    ControlPoints             force;
    SparseMatrix              stiffness;
    sheet_.force_and_tangent(shell.x(), force, stiffness, Tangent::positive);
    add_normal_stiffness(surface, area_weights(surface, shell.x()), normals(surface, shell.x()), stiffness);
    // The surface holds the sheet: only the part of the force along it moves the points.
    const ControlPoints load = capsule_.mass() * along(shell, capsule_.density(force));

    const Eigen::SparseMatrix<double>                        by_columns = stiffness;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(by_columns);
    if (factors.info() != Eigen::Success)
      throw NumericalError("The control points cannot be moved along the shell: the stiffness of the sheet is singular.");
    ControlPoints result(load.rows(), 3);
    Eigen::VectorXd::Map(result.data(), result.size()) = factors.solve(Eigen::VectorXd::Map(load.data(), load.size()));
    return result;
  }
} // namespace tanktread
