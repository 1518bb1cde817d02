// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how the shell moves in a velocity gradient within a time step.

#ifndef tanktread_solver_shell_motion_h
#define tanktread_solver_shell_motion_h

#include <tanktread/shell/capsule.h>
#include <tanktread/solver/block_factorisation.h>

#include <memory>

namespace tanktread
{
  /**
   * Inverse of A = M - N, where N is small against M for short time steps: a fixed number of terms of
   *
   *     A^{-1} = sum_k (M^{-1} N)^k M^{-1},
   *
   * or LU factors of A where the series converges too slowly to be worth it. A term costs about as much as a solve with the factors, to make these as much as
   * 100 terms or more; a
   * linearisation needs some 12 solves.
   */
  class ShellMotion
  {
  public:
    /** Most terms of the series; LU factors are used when that leaves an error above `accuracy`. */
    static constexpr unsigned int max_terms = 12;

    /**
     * M is the mass matrix of `capsule`, kept by reference; `N` has the pattern of AssemblyPattern::block_matrix(). `accuracy`: error wanted, relative to the
     * solution and measured on a rough field.
     * Throws NumericalError when A has to be factorised and is singular.
     */
    ShellMotion(const Capsule &capsule, SparseMatrix N, double accuracy);

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

    const Capsule                      *capsule_;
    SparseMatrix                        N_;
    unsigned int                        n_terms_;
    std::unique_ptr<BlockFactorisation> factors_;
  };
} // namespace tanktread

#endif
