// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shell contributes to the Newton system.

#include <deal.II/base/numbers.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/linearised_shell.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <string>

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


  namespace
  {
    /** Z = c0 M_s + c1 L_s of LinearisedShell. */
    SparseMatrix
    inverse_mobility(const SubdivisionSurface &surface, const ControlPoints &x, const double h)
    {
      const double k1 = 2., k2 = dealii::numbers::PI / h;
      const double c0 = 4. * k1 * k2 / (k1 + k2), c1 = 4. / (k1 + k2);
      return for_three_components(c0 * mass_matrix(surface, area_weights(surface, x)) + c1 * laplace_beltrami(surface, x));
    }


    void
    factorise(Factorisation &factorisation, const SparseMatrix &matrix, const std::string &what)
    {
      factorisation.compute(matrix);
      if (factorisation.info() != Eigen::Success)
        throw NumericalError(what + " is singular.");
    }
  } // namespace


  LinearisedShell::LinearisedShell(const Shell              &shell,
                                   const SubdivisionSurface &surface,
                                   const Coupling           &coupling,
                                   const State              &state,
                                   const PointVelocity      &velocity,
                                   const double              tau,
                                   const double              h)
    : coupling_(coupling)
    , tau_(tau)
    , volume_gradient_(tanktread::volume_gradient(surface, state.x))
    , density_(coupling.density(state.force + state.pressure_jump * volume_gradient_))
  {
    if (tau == 0.)
      return;
    ControlPoints force;
    shell.force_and_tangent(state.x, force, stiffness_);
    pressure_stiffness_ = state.pressure_jump * volume_hessian(surface, state.x);
    stiffness_ -= pressure_stiffness_;
    Z_ = inverse_mobility(surface, state.x, h);
    factorise(response_, for_three_components(coupling.mass()) - tau * coupling.gradient_matrix(velocity), "The motion of the shell in the velocity gradient, for this time step,");
    factorise(implicit_shell_, Z_ + tau * stiffness_, "The shell's implicit operator, for this time step,");
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


  ControlPoints
  LinearisedShell::damped(const ControlPoints &force) const
  {
    if (tau_ == 0.)
      return force;
    return nodal(Z_ * implicit_shell_.solve(flat(force)));
  }


  ControlPoints
  LinearisedShell::displacement_of_force(const ControlPoints &force) const
  {
    if (tau_ == 0.)
      return ControlPoints::Zero(force.rows(), 3);
    return nodal(tau_ * implicit_shell_.solve(flat(force)));
  }


  ControlPoints
  LinearisedShell::force_change(const ControlPoints &dG, const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return dG;
    return dG - nodal(pressure_stiffness_ * flat(dx));
  }
} // namespace tanktread
