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
                                   const ControlPoints      &velocity,
                                   const VelocityGradients  &velocity_gradient,
                                   const PointDerivatives    derivatives,
                                   const double              tau,
                                   const double              h)
    : coupling_(coupling)
    , tau_(tau)
    , volume_gradient_(tanktread::volume_gradient(surface, state.x))
    , density_(coupling.density((derivatives == PointDerivatives::complete ? 1. : 0.) * (state.force + state.pressure_jump * volume_gradient_)))
    , normal_field_(coupling.density(volume_gradient_))
  {
    if (tau == 0.)
      return;
    const SparseMatrix volume_hessian = tanktread::volume_hessian(surface, state.x);
    const SparseMatrix gamma          = coupling.gradient_matrix(velocity_gradient);
    flux_gradient_                    = nodal(gamma.transpose() * flat(normal_field_) + volume_hessian * flat(velocity));

    ControlPoints force;
    shell.force_and_tangent(state.x, force, stiffness_);
    pressure_stiffness_ = state.pressure_jump * volume_hessian;
    stiffness_ -= pressure_stiffness_;
    Z_ = inverse_mobility(surface, state.x, h);
    factorise(implicit_shell_, Z_ + tau * stiffness_, "The shell's implicit operator, for this time step,");

    motion_ = for_three_components(coupling.mass()) - tau * gamma - state.volume_shift * volume_hessian;
    factorise(motion_factors_, motion_, "The motion of the shell in the velocity gradient, for this time step,");
    volume_response_ = nodal(motion_factors_.solve(flat(volume_gradient_)));
  }


  void
  LinearisedShell::correct_volume(ControlPoints &dx, const double r_V) const
  {
    const double excess = volume_gradient_.cwiseProduct(dx).sum() + r_V;
    dx -= excess / volume_gradient_.cwiseProduct(volume_response_).sum() * volume_response_;
  }


  ControlPoints
  LinearisedShell::displacement(const ControlPoints &velocity_moments) const
  {
    if (tau_ == 0.)
      return ControlPoints::Zero(velocity_moments.rows(), 3);
    ControlPoints dx = nodal(motion_factors_.solve(tau_ * flat(velocity_moments)));
    correct_volume(dx, 0.);
    return dx;
  }


  ControlPoints
  LinearisedShell::displacement_of_residual(const ControlPoints &r_x, const double r_V) const
  {
    if (tau_ == 0.)
      return ControlPoints::Zero(r_x.rows(), 3);
    const ControlPoints moments = -(coupling_.mass() * r_x);
    ControlPoints       dx      = nodal(motion_factors_.solve(flat(moments)));
    correct_volume(dx, r_V);
    return dx;
  }


  double
  LinearisedShell::flux(const ControlPoints &velocity_moments, const ControlPoints &dx) const
  {
    double result = normal_field_.cwiseProduct(velocity_moments).sum();
    if (tau_ != 0.)
      result += flux_gradient_.cwiseProduct(dx).sum();
    return result;
  }


  double
  LinearisedShell::volume_shift(const ControlPoints &velocity_moments, const ControlPoints &r_x, const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return 0.;
    const ControlPoints row = nodal(motion_ * flat(dx)) - tau_ * velocity_moments + coupling_.mass() * r_x;
    return normal_field_.cwiseProduct(row).sum() / normal_field_.cwiseProduct(volume_gradient_).sum();
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
