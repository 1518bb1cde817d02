// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how the shell moves in a velocity gradient within a time step.

#include <tanktread/solver/shell_motion.h>

#include <random>

namespace tanktread
{
  namespace
  {
    Eigen::Map<const Eigen::VectorXd>
    flat(const ControlPoints &field)
    {
      return {field.data(), field.size()};
    }

    ControlPoints
    times(const SparseMatrix &matrix, const ControlPoints &field)
    {
      ControlPoints result(field.rows(), 3);
      Eigen::Map<Eigen::VectorXd>(result.data(), result.size()).noalias() = matrix * flat(field);
      return result;
    }
  } // namespace


  ShellMotion::ShellMotion(const Capsule &capsule, SparseMatrix N, const double accuracy)
    : capsule_(&capsule)
    , N_(std::move(N))
    , n_terms_(terms_needed(accuracy))
  {
    if (n_terms_ <= max_terms)
      return;
    SparseMatrix A = N_;
    A.coeffs() *= -1.;
    add_for_three_components(capsule.mass(), A);
    factors_ = std::make_unique<BlockFactorisation>();
    factors_->factorise(A, "The motion of the shell in the velocity gradient, for this time step,");
  }


  unsigned int
  ShellMotion::terms_needed(const double accuracy) const
  {
    // n terms leave the error (M^{-1} N)^n A^{-1} moments. A random field has all wave lengths, the roughest above
    // all; the margin is for smooth ones, on which more than twice the error was seen.
    std::minstd_rand random(1);
    ControlPoints    error  = ControlPoints::NullaryExpr(capsule_->mass().rows(), 3, [&]() { return double(random()) / std::minstd_rand::max() - 0.5; });
    const double     wanted = 0.3 * accuracy * error.norm();
    unsigned int     n      = 0;
    for (; n <= max_terms && !(error.norm() <= wanted); ++n)
      error = capsule_->density(tanktread::times(N_, error));
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
    ControlPoints result = capsule_->density(moments);
    for (unsigned int k = 1; k < n_terms_; ++k)
      result = capsule_->density(moments + tanktread::times(N_, result));
    return result;
  }


  ControlPoints
  ShellMotion::times(const ControlPoints &dx) const
  {
    return capsule_->mass() * dx - tanktread::times(N_, dx);
  }
} // namespace tanktread
