// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how the shell moves in a velocity gradient within a time step.

#include <tanktread/solver/shell_motion.h>

#include <Eigen/LU>

#include <random>
#include <utility>

namespace tanktread
{
  namespace
  {
    Eigen::Map<const Eigen::VectorXd>
    flat(const ControlPoints &field)
    {
      return {field.data(), field.size()};
    }
  } // namespace


  ShellMotion::ShellMotion(const Capsule &capsule, MotionTerms terms, const double accuracy)
    : capsule_(&capsule)
    , terms_(std::move(terms))
    , inverse_drift_((Eigen::Matrix3d::Identity() - terms_.drift).transpose().inverse())
    , n_terms_(terms_needed(accuracy))
  {
    if (n_terms_ <= max_terms)
      return;
    SparseMatrix A = terms_.gradient.nonZeros() > 0 ? terms_.gradient : capsule.surface().pattern().block_matrix();
    A.coeffs() *= -1.;
    if (terms_.volume_shift != 0.)
      A.coeffs() -= terms_.volume_shift * terms_.volume_hessian->coeffs();
    add_for_three_components(capsule.mass(), A, Eigen::Matrix3d::Identity() - terms_.drift);
    factors_ = std::make_unique<BlockFactorisation>();
    factors_->factorise(A, "The motion of the shell in the velocity gradient, for this time step,");
  }


  ControlPoints
  ShellMotion::remainder(const ControlPoints &field) const
  {
    ControlPoints               result = ControlPoints::Zero(field.rows(), 3);
    Eigen::Map<Eigen::VectorXd> values(result.data(), result.size());
    if (terms_.gradient.nonZeros() > 0)
      values += terms_.gradient * flat(field);
    if (terms_.volume_shift != 0.)
      values += terms_.volume_shift * (*terms_.volume_hessian * flat(field));
    return result;
  }


  unsigned int
  ShellMotion::terms_needed(const double accuracy) const
  {
    if (!(inverse_drift_.cwiseAbs().maxCoeff() < 10.))
      return max_terms + 1; // a step in which the gradient stretches without bound
    if (terms_.gradient.nonZeros() == 0 && terms_.volume_shift == 0.)
      return 1;
    // n terms leave the error (D^{-1} M^{-1} N)^n A^{-1} moments. A random field has all wave lengths, the roughest above
    // all; the margin is for smooth ones, on which more than twice the error was seen.
    std::minstd_rand random(1);
    ControlPoints    error  = ControlPoints::NullaryExpr(capsule_->mass().rows(), 3, [&]() { return double(random()) / std::minstd_rand::max() - 0.5; });
    const double     wanted = 0.3 * accuracy * error.norm();
    unsigned int     n      = 0;
    for (; n <= max_terms && !(error.norm() <= wanted); ++n)
      error = capsule_->density(remainder(error)) * inverse_drift_;
    return std::max(n, 1u);
  }


  ControlPoints
  ShellMotion::solve(const ControlPoints &moments) const
  {
    if (factors_)
      {
        const Eigen::VectorXd solution = factors_->solve(flat(moments));
        return Eigen::Map<const ControlPoints>(solution.data(), moments.rows(), 3);
      }
    ControlPoints result = capsule_->density(moments) * inverse_drift_;
    for (unsigned int k = 1; k < n_terms_; ++k)
      result = capsule_->density(moments + remainder(result)) * inverse_drift_;
    return result;
  }


  ControlPoints
  ShellMotion::times(const ControlPoints &dx) const
  {
    return capsule_->mass() * (dx * (Eigen::Matrix3d::Identity() - terms_.drift).transpose()) - remainder(dx);
  }
} // namespace tanktread
