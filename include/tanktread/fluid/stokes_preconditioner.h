// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block-triangular preconditioner of the Stokes equations.

#ifndef tanktread_fluid_stokes_preconditioner_h
#define tanktread_fluid_stokes_preconditioner_h

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_precondition.h>

#include <tanktread/fluid/stokes_operator.h>

namespace tanktread
{
  /**
   * Upper block-triangular: pressure first, z_p = -mu M_p^{-1} r_p (the mass matrix is spectrally equivalent to the Schur complement B A^{-1} B^T / mu),
   * then one algebraic multigrid V-cycle for each velocity component of r_u + B^T z_p. The two halves are offered separately because the
   * monolithic system has more to say between them.
   */
  class StokesPreconditioner
  {
  public:
    explicit StokesPreconditioner(const StokesOperator &stokes);

    /** Approximates M_p^{-1} src by a fixed Chebyshev polynomial, so it is a linear map. */
    void
    apply_inverse_pressure_mass(FluidVector &dst, const FluidVector &src) const;

    /** Approximates A^{-1} src for one component. */
    void
    apply_inverse_laplace(FluidVector &dst, const FluidVector &src) const;

    /** dst = P^{-1} src on blocks 0 to 3. */
    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

    const StokesOperator &
    stokes() const
    {
      return stokes_;
    }

  private:
    using Diagonal  = dealii::DiagonalMatrix<FluidVector>;
    using Chebyshev = dealii::PreconditionChebyshev<dealii::TrilinosWrappers::SparseMatrix, FluidVector, Diagonal>;

    const StokesOperator                     &stokes_;
    dealii::TrilinosWrappers::PreconditionAMG multigrid_;
    Chebyshev                                 pressure_mass_inverse_;
    mutable FluidVector                       velocity_scratch_;
  };
} // namespace tanktread

#endif
