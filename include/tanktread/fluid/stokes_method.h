// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the two ways in which the Stokes equations are solved.

#ifndef tanktread_fluid_stokes_method_h
#define tanktread_fluid_stokes_method_h

namespace tanktread
{
  /** How the linear solver applies the discrete Stokes equations and preconditions them; both find the same flow. */
  enum class StokesMethod
  {
    matrix_free, // StokesOperator, StokesPreconditioner: kernels on cubes and geometric multigrid
    assembled    // AlgebraicStokes: sparse matrices and algebraic multigrid, of one viscosity and without inertia
  };
} // namespace tanktread

#endif
