// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes equations with assembled matrices and algebraic multigrid, in the own numbering.

#ifndef tanktread_fluid_algebraic_stokes_h
#define tanktread_fluid_algebraic_stokes_h

#include <tanktread/fluid/stokes_system.h>

#include <memory>

namespace tanktread
{
  /**
   * The Stokes equations of one viscosity, (grad u, grad v) - (p, div v), -(q, div u), and their preconditioner as they are commonly made: AssembledStokes and
   * AlgebraicPreconditioner, with vectors that are carried to deal.II's numbering and back. The map equals StokesOperator to rounding; the preconditioner is
   * another one than StokesPreconditioner, without what inertia and a second viscosity ask for.
   */
  class AlgebraicStokes
  {
  public:
    /**
     * Assembles the matrices and sets up the multigrid. Keeps `space` by reference, and DoFHandlers attached to its mesh: to be gone before the mesh changes.
     * Collective.
     */
    explicit AlgebraicStokes(const TaylorHoodSpace &space);
    ~AlgebraicStokes();

    const StokesMap &
    map() const;
    const StokesInverse &
    inverse() const;

  private:
    struct Parts; // keeps Trilinos out of what includes this
    std::unique_ptr<const Parts> parts_;
  };
} // namespace tanktread

#endif
