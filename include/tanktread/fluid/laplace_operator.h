// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vector Laplace operator on one rung.

#ifndef tanktread_fluid_laplace_operator_h
#define tanktread_fluid_laplace_operator_h

#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/node_space.h>
#include <tanktread/fluid/viscosity.h>

namespace tanktread
{
  /** Diagonal of the mass matrix of the velocities' functions, hanging nodes included exactly: one number an owned node. Collective. */
  std::vector<double>
  mass_diagonal(const NodeSpace &space);

  /**
   * (mu grad u, grad v) + shift (u, v) for each velocity component on the free nodes, on full arrays (see NodeSpace); mu is 1 or one number a cell, shift = 0
   * at first. `space` is kept by
   * reference. Its nodes may be those of linear functions too, then mu has to stay 1 and the shift zero.
   */
  template <typename Number>
  class LaplaceOperator
  {
  public:
    explicit LaplaceOperator(const NodeSpace &space);

    /** @param viscosities one number a cell. */
    void
    set_viscosity(const std::vector<double> &viscosities);

    /**
     * The form is (mu grad u, grad v) + ((mu - least) grad u^T, grad v) from now on, that of the Stokes equations with two viscosities, with 27 points in
     * cells where they meet.
     */
    void
    set_strain_form(const Viscosity &viscosity);

    /** y = A u for owned nodes; updates the rest of u, and what y has beyond its owned nodes is void. Collective. */
    void
    apply(Number *u, Number *y) const;

    /** Inertia puts `shift` times the mass matrix to the operator. */
    void
    set_shift(double shift);

    /** Diagonal of A, one number an owned node, hanging nodes included exactly. */
    std::vector<Number>
    diagonal() const;

    const NodeSpace &
    space() const
    {
      return space_;
    }

  private:
    void
    add_strain_form(const Number *u, Number *y) const;
    /** What the unit cube's matrix is multiplied by: mu h, one number a cell. */
    const std::vector<double> &
    factors() const
    {
      return own_factors_.empty() ? space_.cell_sizes() : own_factors_;
    }

    const NodeSpace     &space_;
    const InstructionSet instructions_;
    std::vector<double>  own_factors_; // empty with the viscosity 1; with the strain form those of the Laplace matrix with about its diagonal
    // Of the strain form: what is uniform in cells, and what there is more at the points of some.
    std::vector<double>       strain_viscosities_;
    double                    least_ = 0.;
    std::vector<double>       cut_sizes_;
    std::vector<unsigned int> cut_nodes_;
    std::vector<Number>       cut_viscosities_;
    std::vector<double>       zeros_;  // one a cell
    std::vector<double>       masses_; // shift times the cells' volumes; empty without a shift
  };
} // namespace tanktread

#endif
