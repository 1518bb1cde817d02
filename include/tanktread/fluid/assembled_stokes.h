// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes equations assembled by deal.II.

#ifndef tanktread_fluid_assembled_stokes_h
#define tanktread_fluid_assembled_stokes_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <tanktread/fluid/taylor_hood_space.h>

#include <array>
#include <vector>

namespace tanktread
{
  /** Integrals over the unit cube by deal.II's FEValues, in deal.II's order of shape functions; a cube of side h scales them by h, h^2 and h^3. */
  struct ReferenceMatrices
  {
    ReferenceMatrices();

    dealii::FullMatrix<double>                laplace;       // 27 x 27: grad N_a . grad N_b
    std::array<dealii::FullMatrix<double>, 3> divergence;    // 8 x 27 each: M_j d_c N_a
    dealii::FullMatrix<double>                pressure_mass; // 8 x 8: M_i M_j
  };

  /** Degree of freedom, counted among the locally owned ones, of each owned node. Throws std::logic_error if that is not one to one. */
  std::vector<unsigned int>
  dofs_of_nodes(const ScalarSpace &space, const NodeSpace &nodes);

  /** Four blocks u_x, u_y, u_z, p in the numbering of deal.II's DoFHandlers, constrained degrees of freedom among them. */
  using ComponentVector = dealii::LinearAlgebra::distributed::BlockVector<double>;

  /**
   * (grad u, grad v) - (p, div v), -(q, div u) as Trilinos matrices: one scalar matrix for all three velocity components, three divergences. Rows and columns
   * of constrained degrees of freedom are condensed; those of the velocities carry a positive diagonal entry. Of NodeSpace it knows only in the two
   * conversions, so that the tests can compare the matrix-free operators with it.
   */
  class AssembledStokes
  {
  public:
    /** Keeps the mesh of `space` by reference, and DoFHandlers attached to it: to be gone before the mesh changes. Collective. */
    explicit AssembledStokes(const TaylorHoodSpace &space);

    /** Makes `vector` a zero vector of four blocks. */
    void
    reinit(ComponentVector &vector) const;

    /** dst = [A, -B^T; -B, 0] src. */
    void
    vmult(ComponentVector &dst, const ComponentVector &src) const;

    /** Adds B^T p to the velocity blocks of `dst`. */
    void
    add_pressure_gradient(ComponentVector &dst, const FluidVector &pressure) const;

    /** Free values from the own numbering to deal.II's; constrained entries become zero. */
    void
    to_components(const FluidBlockVector &from, ComponentVector &to) const;

    /** The same way back, constrained entries being left out; blocks from 2 on are not touched. */
    void
    to_nodes(const ComponentVector &from, FluidBlockVector &to) const;

    const FluidMesh &
    mesh() const
    {
      return mesh_;
    }
    const ScalarSpace &
    velocity() const
    {
      return velocity_;
    }
    const ScalarSpace &
    pressure() const
    {
      return pressure_;
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

    const FluidMesh                                      &mesh_;
    ScalarSpace                                           velocity_, pressure_;
    std::vector<unsigned int>                             velocity_dofs_, pressure_dofs_; // of the nodes
    ReferenceMatrices                                     reference_;
    dealii::TrilinosWrappers::SparseMatrix                laplace_;
    std::array<dealii::TrilinosWrappers::SparseMatrix, 3> divergence_;
    dealii::TrilinosWrappers::SparseMatrix                pressure_mass_;
    mutable FluidVector                                   velocity_scratch_, pressure_scratch_;
  };
} // namespace tanktread

#endif
