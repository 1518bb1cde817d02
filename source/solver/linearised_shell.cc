// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shells contribute to the Newton system.

#include <deal.II/base/numbers.h>

#include <tanktread/solver/linearised_shell.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>
#include <utility>

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


    /** At the middle of a shell. */
    Eigen::Matrix3d
    gradient_about(const UndisturbedFlow &flow, const ControlPoints &x)
    {
      const Eigen::RowVector3d   centre   = x.colwise().mean();
      const dealii::Tensor<2, 3> gradient = flow.gradient({centre[0], centre[1], centre[2]});
      Eigen::Matrix3d            result;
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          result(c, d) = gradient[c][d];
      return result;
    }
  } // namespace


  LinearisedShell::LinearisedShell(const DistributedShell                          &elasticity,
                                   const Coupling                                  &coupling,
                                   const unsigned int                               c,
                                   const CapsuleState                              &state,
                                   const std::shared_ptr<const ShellConfiguration> &shell,
                                   const ControlPoints                             &velocity,
                                   const VelocityGradients                         &velocity_gradient,
                                   const Linearisation                             &choice)
    : capsule_(shell->capsule())
    , shell_(shell)
    , tau_(choice.tau)
    , pressure_jump_(state.pressure_jump)
    , density_(ControlPoints::Zero(state.x.rows(), 3))
  {
    if (choice.derivatives == PointDerivatives::complete)
      density_ = capsule_.density(state.force) + state.pressure_jump * shell->normal_field();
    if (tau_ == 0.)
      return;
    MotionTerms           terms;
    const Eigen::Matrix3d G              = gradient_about(choice.flow, shell->x());
    const SparseMatrix   &volume_hessian = shell->volume_hessian();
    flux_gradient_                       = shell->volume_gradient() * G + nodal(volume_hessian * flat(velocity));
    if (choice.derivatives == PointDerivatives::complete || choice.flow.quadratic.norm_square() > 0.)
      {
        VelocityGradients excess = coupling.transfer(c).gradients(choice.flow, *shell);
        if (choice.derivatives == PointDerivatives::complete)
          excess += velocity_gradient;
        for (unsigned int component = 0; component < 9; ++component)
          excess.col(component).array() -= G(component / 3, component % 3);
        coupling.gradient_matrix(c, excess, terms.gradient);
        flux_gradient_ += nodal(terms.gradient.transpose() * flat(shell->normal_field()));
        terms.gradient.coeffs() *= tau_;
      }

    ControlPoints force;
    elasticity.force_and_tangent(state.x, force, stiffness_, choice.tangent);
    if (choice.tangent == Tangent::exact)
      stiffness_.coeffs() -= state.pressure_jump * volume_hessian.coeffs();

    terms.drift = tau_ * G;
    if (std::abs(state.volume_shift) <= choice.h / (2. * dealii::numbers::PI))
      terms.volume_shift = state.volume_shift;
    terms.volume_hessian = &volume_hessian;
    motion_.emplace(capsule_, std::move(terms), choice.accuracy);
    volume_response_ = motion_->solve(shell->volume_gradient());
  }


  ImplicitOperator
  LinearisedShell::implicit_operator(const Linearisation &choice, SparseMatrix stiffness) const
  {
    return tanktread::implicit_operator(inverse_mobility(capsule_.surface(), shell_->x(), choice.h, choice.viscosity),
                                        std::move(stiffness),
                                        gradient_about(choice.flow, shell_->x()),
                                        tau_);
  }


  void
  LinearisedShell::correct_volume(ControlPoints &dx, const double r_V) const
  {
    const double excess = volume_gradient().cwiseProduct(dx).sum() + r_V;
    dx -= excess / volume_gradient().cwiseProduct(volume_response_).sum() * volume_response_;
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
    ControlPoints dx = motion_->solve(-(capsule_.mass() * r_x));
    correct_volume(dx, r_V);
    return dx;
  }


  double
  LinearisedShell::flux(const ControlPoints &velocity_moments, const ControlPoints &dx) const
  {
    double result = shell_->normal_field().cwiseProduct(velocity_moments).sum();
    if (tau_ != 0.)
      result += flux_gradient_.cwiseProduct(dx).sum();
    return result;
  }


  double
  LinearisedShell::volume_shift(const ControlPoints &velocity_moments, const ControlPoints &r_x, const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return 0.;
    const ControlPoints row = motion_->times(dx) - tau_ * velocity_moments + capsule_.mass() * r_x;
    return shell_->normal_field().cwiseProduct(row).sum() / shell_->normal_square();
  }


  ControlPoints
  LinearisedShell::stiffness_times(const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return ControlPoints::Zero(dx.rows(), 3);
    return nodal(stiffness_ * flat(dx));
  }


  ControlPoints
  LinearisedShell::force_change(const ControlPoints &dG, const ControlPoints &dx) const
  {
    if (tau_ == 0.)
      return dG;
    return dG - pressure_jump_ * nodal(shell_->volume_hessian() * flat(dx));
  }


  LinearisedShells::LinearisedShells(const DistributedShell               &elasticity,
                                     const Coupling                       &coupling,
                                     const State                          &state,
                                     const ShellConfigurations            &shells,
                                     const ShellFields                    &velocities,
                                     const std::vector<VelocityGradients> &velocity_gradients,
                                     const Linearisation                  &choice,
                                     ImplicitShells                       &implicit_shells)
    : coupling_(coupling)
    , implicit_shells_(implicit_shells)
    , tau_(choice.tau)
    , points_move_(choice.derivatives == PointDerivatives::complete && choice.tau > 0.)
  {
    shells_.reserve(shells.size());
    for (unsigned int c = 0; c < shells.size(); ++c)
      shells_.emplace_back(elasticity, coupling, c, state.capsules[c], shells[c], velocities[c], velocity_gradients[c], choice);
    if (tau_ == 0. || implicit_shells.serves(tau_))
      return;
    ImplicitShells::Operators operators;
    for (unsigned int c = 0; c < shells.size(); ++c)
      operators.push_back(implicit_shells.works_on(c) ? shells_[c].implicit_operator(choice) : ImplicitOperator());
    const auto positive_ones = [&]() {
      ImplicitShells::Operators result;
      for (unsigned int c = 0; c < shells.size(); ++c)
        {
          ControlPoints force;
          SparseMatrix  stiffness;
          elasticity.force_and_tangent(state.capsules[c].x, force, stiffness, Tangent::positive);
          result.push_back(implicit_shells.works_on(c) ? shells_[c].implicit_operator(choice, std::move(stiffness)) : ImplicitOperator());
        }
      return result;
    };
    if (choice.tangent == Tangent::exact)
      implicit_shells.renew(std::move(operators), tau_, positive_ones);
    else
      implicit_shells.renew(std::move(operators), tau_);
  }


  ShellFields
  LinearisedShells::displacements(const ShellFields &velocity_moments) const
  {
    ShellFields result;
    for (unsigned int c = 0; c < size(); ++c)
      result.push_back(shells_[c].displacement(velocity_moments[c]));
    return result;
  }


  ControlPoints
  LinearisedShells::damped(const unsigned int c, const ControlPoints &force) const
  {
    return tau_ == 0. ? force : implicit_shells_.damped(c, force);
  }


  ShellFields
  LinearisedShells::densities() const
  {
    ShellFields result;
    for (const LinearisedShell &shell : shells_)
      result.push_back(shell.density());
    return result;
  }
} // namespace tanktread
