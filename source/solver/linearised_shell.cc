// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shell contributes to the Newton system.

#include <deal.II/base/numbers.h>

#include <tanktread/solver/linearised_shell.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>

namespace tanktread
{
  namespace
  {
    /** Z = c0 M_s + c1 L_s of LinearisedShell, for one component. */
    SparseMatrix
    inverse_mobility(const SubdivisionSurface &surface, const ControlPoints &x, const double h, const double viscosity)
    {
      const double k1 = 2., k2 = dealii::numbers::PI / h;
      const double c0 = 4. * viscosity * k1 * k2 / (k1 + k2), c1 = 4. * viscosity / (k1 + k2);
      SparseMatrix Z = mass_matrix(surface, c0 * area_weights(surface, x));
      Z.coeffs() += c1 * laplace_beltrami(surface, x).coeffs();
      return Z;
    }
  } // namespace


  LinearisedShell::LinearisedShell(const DistributedShell   &shell,
                                   const SubdivisionSurface &surface,
                                   const Coupling           &coupling,
                                   const State              &state,
                                   const ControlPoints      &velocity,
                                   const VelocityGradients  &velocity_gradient,
                                   const Linearisation      &choice,
                                   ImplicitShell            &implicit_shell)
    : coupling_(coupling)
    , implicit_shell_(implicit_shell)
    , tau_(choice.tau)
    , pressure_jump_(state.pressure_jump)
    , points_move_(choice.derivatives == PointDerivatives::complete && choice.tau > 0.)
    , volume_gradient_(tanktread::volume_gradient(surface, state.x))
    , density_(coupling.density((choice.derivatives == PointDerivatives::complete ? 1. : 0.) * (state.force + state.pressure_jump * volume_gradient_)))
    , normal_field_(coupling.density(volume_gradient_))
  {
    if (tau_ == 0.)
      return;
    volume_hessian_ = tanktread::volume_hessian(surface, state.x);
    SparseMatrix gamma;
    coupling.gradient_matrix(velocity_gradient, gamma);
    flux_gradient_ = nodal(gamma.transpose() * flat(normal_field_) + volume_hessian_ * flat(velocity));

    ControlPoints force;
    shell.force_and_tangent(state.x, force, stiffness_, choice.tangent);
    if (choice.tangent == Tangent::exact)
      stiffness_.coeffs() -= state.pressure_jump * volume_hessian_.coeffs();
    if (!implicit_shell.serves(tau_))
      implicit_shell.renew(inverse_mobility(surface, state.x, choice.h, choice.viscosity), choice.flow_gradient, stiffness_, tau_);

    gamma.coeffs() *= tau_;
    if (std::abs(state.volume_shift) <= choice.h / (2. * dealii::numbers::PI))
      gamma.coeffs() += state.volume_shift * volume_hessian_.coeffs();
    motion_.emplace(coupling, std::move(gamma), choice.accuracy);
    volume_response_ = motion_->solve(volume_gradient_);
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
    ControlPoints dx = motion_->solve(tau_ * velocity_moments);
    correct_volume(dx, 0.);
    return dx;
  }


  ControlPoints
  LinearisedShell::displacement_of_residual(const ControlPoints &r_x, const double r_V) const
  {
    if (tau_ == 0.)
      return ControlPoints::Zero(r_x.rows(), 3);
    ControlPoints dx = motion_->solve(-(coupling_.mass() * r_x));
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
    const ControlPoints row = motion_->times(dx) - tau_ * velocity_moments + coupling_.mass() * r_x;
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
    return implicit_shell_.damped(force);
  }


  ControlPoints
  LinearisedShell::force_change(const ControlPoints &dG, const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return dG;
    return dG - pressure_jump_ * nodal(volume_hessian_ * flat(dx));
  }
} // namespace tanktread
