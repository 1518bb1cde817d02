// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shells contribute to the Newton system.

#include <deal.II/base/numbers.h>

#include <tanktread/base/mpi_errors.h>
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
  } // namespace


  LinearisedShell::LinearisedShell(const CapsuleState                              &state,
                                   const std::shared_ptr<const ShellConfiguration> &shell,
                                   const ControlPoints                             &velocity,
                                   SparseMatrix                                     stiffness,
                                   SparseMatrix                                     gradient,
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
    const Eigen::Matrix3d G              = gradient_at_middle(choice.flow, shell->x());
    const SparseMatrix   &volume_hessian = shell->volume_hessian();
    flux_gradient_                       = shell->volume_gradient() * G + nodal(volume_hessian * flat(velocity));
    if (gradient.nonZeros() > 0)
      {
        flux_gradient_ += nodal(gradient.transpose() * flat(shell->normal_field()));
        gradient.coeffs() *= tau_;
        terms.gradient = std::move(gradient);
      }

    stiffness_ = std::move(stiffness);
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
                                        gradient_at_middle(choice.flow, shell_->x()),
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


  LinearisedShells::LinearisedShells(const DistributedShell    &elasticity,
                                     const Coupling            &coupling,
                                     const State               &state,
                                     const ShellConfigurations &shells,
                                     const ShellFields         &velocities,
                                     const Linearisation       &choice,
                                     ImplicitShells            &implicit_shells)
    : coupling_(coupling)
    , implicit_shells_(implicit_shells)
    , tau_(choice.tau)
    , points_move_(choice.derivatives == PointDerivatives::complete && choice.tau > 0.)
  {
    const ShellFields         x = positions(state);
    std::vector<SparseMatrix> stiffness(shells.size()), gradients(shells.size());
    if (tau_ > 0.)
      stiffness = elasticity.tangents(x, choice.tangent);
    if (points_move_ || (tau_ > 0. && choice.flow.quadratic.norm_square() > 0.))
      gradients = coupling.gradient_matrices(shells, choice.flow, points_move_ ? &state.fluid : nullptr);
    shells_.reserve(shells.size());
    on_all_ranks(coupling.layout().communicator(), [&] {
      for (unsigned int i = 0; i < shells.size(); ++i)
        shells_.emplace_back(state.capsules[i], shells[i], velocities[i], std::move(stiffness[i]), std::move(gradients[i]), choice);
    });
    if (tau_ == 0. || implicit_shells.serves(tau_))
      return;
    ImplicitShells::Operators operators;
    on_all_ranks(coupling.layout().communicator(), [&] {
      for (const LinearisedShell &shell : shells_)
        operators.push_back(shell.implicit_operator(choice));
    });
    const auto positive_ones = [&]() {
      std::vector<SparseMatrix> positive = elasticity.tangents(x, Tangent::positive);
      ImplicitShells::Operators result;
      on_all_ranks(coupling.layout().communicator(), [&] {
        for (unsigned int i = 0; i < shells_.size(); ++i)
          result.push_back(shells_[i].implicit_operator(choice, std::move(positive[i])));
      });
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
