// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the discrete Stokes equations of one viscosity.

#ifndef tanktread_fluid_stokes_operator_h
#define tanktread_fluid_stokes_operator_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <tanktread/fluid/taylor_hood_space.h>

#include <array>

namespace tanktread
{
  /** Integrals over the unit cube in deal.II's order of shape functions; a cube of side h scales them by h, h^2 and h^3. */
  struct ReferenceMatrices
  {
    ReferenceMatrices();

    dealii::FullMatrix<double>                laplace;       // 27 x 27: grad N_a . grad N_b
    std::array<dealii::FullMatrix<double>, 3> divergence;    // 8 x 27 each: M_j d_c N_a
    dealii::FullMatrix<double>                pressure_mass; // 8 x 8: M_i M_j
  };

  /**
   * mu (grad u, grad v) - (p, div v), -(q, div u): with one viscosity in the whole box the same flow as the strain form, and its velocity block is
   * one scalar matrix for all three components. Rows and columns of constrained degrees of freedom are condensed; those of the velocity block carry
   * a positive diagonal entry. The viscosity of the outer fluid is the unit, mu = 1.
   */
  class StokesOperator
  {
  public:
    explicit StokesOperator(const TaylorHoodSpace &space);

    /** dst = [A, -B^T; -B, 0] src on blocks 0 to 3; blocks from 4 on are not touched. */
    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

    /** Adds B^T p to the velocity blocks of `dst`. */
    void
    add_pressure_gradient(FluidBlockVector &dst, const FluidVector &pressure) const;

    /**
     * rhs -= operator applied to a field with its own wall values.
     *
     * @param field full nodal values, all constraints resolved, ghost values up to date; need not vanish at the walls.
     */
    void
    subtract_applied(const FluidBlockVector &field, FluidBlockVector &rhs) const;

    const TaylorHoodSpace &
    space() const
    {
      return space_;
    }
    const dealii::TrilinosWrappers::SparseMatrix &
    laplace() const
    {
      return laplace_;
    }
    const dealii::TrilinosWrappers::SparseMatrix &
    pressure_mass() const
    {
      return pressure_mass_;
    }

  private:
    void
    make_sparsity();
    void
    assemble();

    const TaylorHoodSpace                                &space_;
    ReferenceMatrices                                     reference_;
    dealii::TrilinosWrappers::SparseMatrix                laplace_;
    std::array<dealii::TrilinosWrappers::SparseMatrix, 3> divergence_;
    dealii::TrilinosWrappers::SparseMatrix                pressure_mass_;
    mutable FluidVector                                   velocity_scratch_;
    mutable FluidVector                                   pressure_scratch_;
  };
} // namespace tanktread

#endif
