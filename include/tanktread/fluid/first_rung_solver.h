// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: solver on the first rung of the multigrid, where the viscosity may vary.

#ifndef tanktread_fluid_first_rung_solver_h
#define tanktread_fluid_first_rung_solver_h

#include <tanktread/fluid/coarse_solver.h>
#include <tanktread/fluid/laplace_operator.h>

namespace tanktread
{
  /**
   * Approximately A^{-1} for A = (mu grad u, grad v) + shift (u, v): the direct solver C of viscosity 1 and the same shift, exact where mu is 1; else a
   * Chebyshev iteration in C A, whose eigenvalues lie between the smallest and the largest viscosity, one included. It takes as many steps as reduce the error
   * by ten.
   */
  template <typename Number>
  class FirstRungSolver
  {
  public:
    /** `mesh` has to be on its first rung. `A` and its space are kept by reference. Collective. */
    FirstRungSolver(const FluidMesh &mesh, const LaplaceOperator<Number> &A);

    /** A has another shift from now on. */
    void
    set_shift(double shift);

    /** A has other viscosities from now on, one number a cell of this rank. Collective. */
    void
    set_viscosity(const std::vector<double> &viscosities);

    /** x = approximately A^{-1} b, a fixed symmetric linear map; full arrays. Collective. */
    void
    vmult(dealii::AlignedVector<Number> &x, const dealii::AlignedVector<Number> &b) const;

  private:
    const LaplaceOperator<Number>        &A_;
    CoarseSolver<Number>                  direct_;
    double                                smallest_ = 1., largest_ = 1.; // eigenvalues of C A
    mutable dealii::AlignedVector<Number> residual_, direction_;
  };
} // namespace tanktread

#endif
