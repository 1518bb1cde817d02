// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vectors of the fluid.

#ifndef tanktread_fluid_types_h
#define tanktread_fluid_types_h

#include <deal.II/lac/la_parallel_block_vector.h>
#include <deal.II/lac/la_parallel_vector.h>

namespace tanktread
{
  /** Numbers at the free nodes of one field (see NodeSpace), distributed over the ranks. */
  using FluidVector = dealii::LinearAlgebra::distributed::Vector<double>;

  /** Block 0: velocity, the three components of a node together; block 1: pressure; the monolithic system appends block 2, see monolithic_system.h. */
  using FluidBlockVector = dealii::LinearAlgebra::distributed::BlockVector<double>;

  constexpr unsigned int velocity_block = 0;
  constexpr unsigned int pressure_block = 1;
} // namespace tanktread

#endif
