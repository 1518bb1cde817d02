// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: flexible GMRES with a report instead of an exception.

#ifndef tanktread_fluid_linear_solver_h
#define tanktread_fluid_linear_solver_h

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <tanktread/fluid/types.h>

#include <cmath>

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

  /**
   * Solves op x = rhs by right-preconditioned flexible GMRES until the residual has fallen to `relative_tolerance` times the norm of rhs, starting from x.
   *
   * @param op, preconditioner anything with vmult(dst, src); the preconditioner may vary from one call to the next.
   */
  template <typename Operator, typename Preconditioner>
  LinearReport
  solve_fgmres(const Operator         &op,
               const Preconditioner   &preconditioner,
               FluidBlockVector       &x,
               const FluidBlockVector &rhs,
               const double            relative_tolerance,
               const unsigned int      max_iterations)
  {
    LinearReport report;
    report.initial_residual = rhs.l2_norm();
    if (!std::isfinite(report.initial_residual))
      return report;
    dealii::SolverControl                                  control(max_iterations, relative_tolerance * report.initial_residual + 1e-300, false, false);
    dealii::SolverFGMRES<FluidBlockVector>::AdditionalData data;
    data.max_basis_size = 60;
    dealii::SolverFGMRES<FluidBlockVector> solver(control, data);
    try
      {
        solver.solve(op, x, rhs, preconditioner);
        report.converged = true;
      }
    catch (const dealii::SolverControl::NoConvergence &)
      {}
    report.iterations     = control.last_step();
    report.final_residual = control.last_value();
    return report;
  }
} // namespace tanktread

#endif
