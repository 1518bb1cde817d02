// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: flexible GMRES with a report instead of an exception.

#ifndef tanktread_fluid_linear_solver_h
#define tanktread_fluid_linear_solver_h

#include <tanktread/fluid/krylov_basis.h>

#include <cmath>
#include <numeric>

namespace tanktread
{
  /** What a linear solve did. The solution of one that did not converge is the last iterate and is never to be used without saying so. */
  struct LinearReport
  {
    bool         converged        = false;
    unsigned int iterations       = 0;
    double       initial_residual = 0.; // Euclidean norms
    double       final_residual   = 0.;
  };

  /** The least-squares problem of GMRES: minimises |beta e_0 - H y| over y for a Hessenberg matrix H that comes column by column, by Givens rotations. */
  class HessenbergLeastSquares
  {
  public:
    explicit HessenbergLeastSquares(const double beta)
      : rhs_(1, beta)
    {}

    /** The next column: `entries` on and above the diagonal, `below` under it. */
    void
    append(std::vector<double> entries, double below);

    /** The minimum. */
    double
    residual() const
    {
      return std::abs(rhs_.back());
    }

    std::vector<double>
    solution() const;

  private:
    std::vector<std::vector<double>> columns_; // upper triangular after the rotations
    std::vector<double>              cosines_, sines_, rhs_;
  };

  /**
   * Solves op x = rhs by right-preconditioned flexible GMRES, starting from x, until the residual has fallen to `relative_tolerance` times the norm of rhs.
   * Starts again after 60 iterations, and whenever the residual has
   * fallen by 5e6 or seems to be small enough, with the true one: the basis is kept in single precision.
   *
   * @param op, preconditioner anything with vmult(dst, src); the preconditioner may vary from one call to the next. @param basis memory that may be used again.
   */
  template <typename Operator, typename Preconditioner>
  LinearReport
  solve_fgmres(const Operator         &op,
               const Preconditioner   &preconditioner,
               FluidBlockVector       &x,
               const FluidBlockVector &rhs,
               const double            relative_tolerance,
               const unsigned int      max_iterations,
               KrylovBasis            &basis)
  {
    LinearReport report;
    report.initial_residual = rhs.l2_norm();
    if (!std::isfinite(report.initial_residual))
      return report;
    const double        wanted = relative_tolerance * report.initial_residual;
    FluidBlockVector    v(rhs), z(rhs);
    std::vector<double> coefficients;
    for (bool from_zero = x.all_zero();; from_zero = false)
      {
        if (!from_zero)
          {
            op.vmult(v, x);
            v.sadd(-1., rhs);
          }
        const double start    = from_zero ? report.initial_residual : v.l2_norm();
        report.final_residual = start;
        report.converged      = start <= wanted;
        if (report.converged || report.iterations >= max_iterations || !std::isfinite(start))
          return report;

        basis.reinit(rhs);
        basis.append(v, start);
        HessenbergLeastSquares problem(start);
        const double           goal = std::max(0.9 * wanted, 2e-7 * start);
        while (basis.size() <= 60 && report.iterations < max_iterations && problem.residual() > goal)
          {
            basis.last(v);
            preconditioner.vmult(z, v);
            basis.set_preconditioned(z);
            op.vmult(v, z);
            const double norm = basis.orthogonalise(v, coefficients);
            problem.append(coefficients, norm);
            ++report.iterations;
            const double length = std::sqrt(std::inner_product(coefficients.begin(), coefficients.end(), coefficients.begin(), norm * norm)); // of op z
            if (!(norm > 1e-12 * length)) // the space is exhausted, or not a number
              break;
            basis.append(v, norm);
          }
        basis.add_preconditioned(problem.solution(), x);
      }
  }

  /** The same with memory of its own. */
  template <typename Operator, typename Preconditioner>
  LinearReport
  solve_fgmres(const Operator         &op,
               const Preconditioner   &preconditioner,
               FluidBlockVector       &x,
               const FluidBlockVector &rhs,
               const double            relative_tolerance,
               const unsigned int      max_iterations)
  {
    KrylovBasis basis;
    return solve_fgmres(op, preconditioner, x, rhs, relative_tolerance, max_iterations, basis);
  }
} // namespace tanktread

#endif
