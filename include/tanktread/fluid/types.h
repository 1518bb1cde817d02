// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vectors of the fluid.

#ifndef tanktread_fluid_types_h
#define tanktread_fluid_types_h

#include <deal.II/lac/la_parallel_block_vector.h>
#include <deal.II/lac/la_parallel_vector.h>

namespace tanktread
{
  /** Coefficients of one scalar field, distributed over the ranks. */
  using FluidVector = dealii::LinearAlgebra::distributed::Vector<double>;

  /** Blocks 0, 1, 2: velocity components (one scalar Q2 field each); block 3: Q1 pressure; the monolithic system appends block 4, see monolithic_system.h. */
  using FluidBlockVector = dealii::LinearAlgebra::distributed::BlockVector<double>;

  /** Number of the pressure block, which follows the three velocity components. */
  constexpr unsigned int pressure_block = 3;
} // namespace tanktread

#endif
