// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how the shell moves in a velocity gradient within a time step.

#ifndef tanktread_solver_shell_motion_h
#define tanktread_solver_shell_motion_h

#include <tanktread/shell/capsule.h>
#include <tanktread/solver/block_factorisation.h>

#include <memory>

namespace tanktread
{
  /** What the matrix of ShellMotion is made of. */
  struct MotionTerms
  {
    Eigen::Matrix3d     drift = Eigen::Matrix3d::Zero(); // tau G, G a constant part of the velocity gradient
    SparseMatrix        gradient;                        // tau S^T W (grad u - G) S, in the pattern of AssemblyPattern::block_matrix(), or empty
    double              volume_shift   = 0.;             // sigma
    const SparseMatrix *volume_hessian = nullptr;        // H_V, in the same pattern; kept by pointer; not needed with sigma = 0
  };

  /**
   * Inverse of A = M D - N, D = 1 - tau G, N = tau S^T W (grad u - G) S + sigma H_V, where N is small against M for short time steps: a fixed number of terms of
   *
   *     A^{-1} = sum_k (D^{-1} M^{-1} N)^k D^{-1} M^{-1},
   *
   * one where the gradient is constant, or LU factors of A where the series converges too slowly to be worth it. A term costs about as much as a solve with the
   * factors, to make these as much as 100 terms or more; a linearisation needs some 12 solves.
   */
  class ShellMotion
  {
  public:
    /** Most terms of the series; LU factors are used when that leaves an error above `accuracy`. */
    static constexpr unsigned int max_terms = 12;

    /**
     * M is the mass matrix of `capsule`, kept by reference. `accuracy`: error wanted, relative to the
     * solution and measured on a rough field.
     * Throws NumericalError when A has to be factorised and is singular.
     */
    ShellMotion(const Capsule &capsule, MotionTerms terms, double accuracy);

    /** A^{-1} moments, a linear map. */
    ControlPoints
    solve(const ControlPoints &moments) const;

    /** A dx. */
    ControlPoints
    times(const ControlPoints &dx) const;

    /** Number of terms of the series, 0 when LU factors are used. */
    unsigned int
    n_terms() const
    {
      return factors_ ? 0 : n_terms_;
    }

  private:
    /** Terms that are needed for an error of `accuracy`; more than max_terms stands for any number. */
    unsigned int
    terms_needed(double accuracy) const;

    /** N field. */
    ControlPoints
    remainder(const ControlPoints &field) const;

    const Capsule                      *capsule_;
    MotionTerms                         terms_;
    Eigen::Matrix3d                     inverse_drift_; // D^{-T}, for rows
    unsigned int                        n_terms_;
    std::unique_ptr<BlockFactorisation> factors_;
  };
} // namespace tanktread

#endif
