// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block preconditioner of the assembled Stokes equations with algebraic multigrid.

#ifndef tanktread_fluid_algebraic_preconditioner_h
#define tanktread_fluid_algebraic_preconditioner_h

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_precondition.h>

#include <tanktread/fluid/assembled_stokes.h>

namespace tanktread
{
  /** Upper block-triangular: z_p = -M_p^{-1} r_p by a Chebyshev polynomial, then one V-cycle of Trilinos ML for each velocity component of r_u + B^T z_p. */
  class AlgebraicPreconditioner
  {
  public:
    /** Keeps `stokes` by reference. Collective. */
    explicit AlgebraicPreconditioner(const AssembledStokes &stokes);

    /** Approximates A^{-1} src for one component. */
    void
    apply_inverse_laplace(FluidVector &dst, const FluidVector &src) const;

    /** dst = P^{-1} src. */
    void
    vmult(ComponentVector &dst, const ComponentVector &src) const;

  private:
    using Diagonal  = dealii::DiagonalMatrix<FluidVector>;
    using Chebyshev = dealii::PreconditionChebyshev<dealii::TrilinosWrappers::SparseMatrix, FluidVector, Diagonal>;

    const AssembledStokes                    &stokes_;
    dealii::TrilinosWrappers::PreconditionAMG multigrid_;
    Chebyshev                                 pressure_mass_inverse_;
    mutable FluidVector                       velocity_scratch_;
  };
} // namespace tanktread

#endif
