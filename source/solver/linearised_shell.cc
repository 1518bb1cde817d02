// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shell contributes to the Newton system.

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/linearised_shell.h>
#include <tanktread/surface/surface_geometry.h>

namespace tanktread
{
  SparseMatrix
  for_three_components(const SparseMatrix &matrix)
  {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(3 * matrix.nonZeros());
    for (int i = 0; i < matrix.outerSize(); ++i)
      for (SparseMatrix::InnerIterator entry(matrix, i); entry; ++entry)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(3 * i + c, 3 * entry.col() + c, entry.value());
    SparseMatrix result(3 * matrix.rows(), 3 * matrix.cols());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }


  ShellForces::ShellForces(const Shell &shell, const SubdivisionSurface &surface, const ControlPoints &x)
    : force(shell.force(x))
    , volume_gradient(tanktread::volume_gradient(surface, x))
    , volume(enclosed_volume(surface, x))
  {}


  LinearisedShell::LinearisedShell(const Shell              &shell,
                                   const SubdivisionSurface &surface,
                                   const Coupling           &coupling,
                                   const ControlPoints      &x,
                                   const ShellForces        &forces,
                                   const PointVelocity      &velocity,
                                   const double              pressure_jump,
                                   const double              tau)
    : coupling_(coupling)
    , tau_(tau)
    , volume_gradient_(forces.volume_gradient)
    , density_(coupling.density(forces.force + pressure_jump * forces.volume_gradient))
  {
    if (tau == 0.)
      return;
    ControlPoints force;
    shell.force_and_tangent(x, force, stiffness_);
    stiffness_ -= pressure_jump * volume_hessian(surface, x);

    const SparseMatrix response = for_three_components(coupling.mass()) - tau * coupling.gradient_matrix(velocity);
    response_.compute(response);
    if (response_.info() != Eigen::Success)
      throw NumericalError("The time step is so long that the shell's motion in the present velocity gradient is singular.");
  }


  ControlPoints
  LinearisedShell::velocity_response(const ControlPoints &moments) const
  {
    if (tau_ == 0.)
      return coupling_.density(moments);
    return nodal(response_.solve(flat(moments)));
  }


  ControlPoints
  LinearisedShell::displacement_of_residual(const ControlPoints &r_x) const
  {
    return -velocity_response(coupling_.mass() * r_x);
  }


  ControlPoints
  LinearisedShell::stiffness_times(const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return ControlPoints::Zero(dx.rows(), 3);
    return nodal(stiffness_ * flat(dx));
  }
} // namespace tanktread
