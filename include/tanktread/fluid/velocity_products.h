// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: products of velocities over the box, which carry momentum.

#ifndef tanktread_fluid_velocity_products_h
#define tanktread_fluid_velocity_products_h

#include <deal.II/base/symmetric_tensor.h>

#include <tanktread/fluid/taylor_hood_space.h>

namespace tanktread
{
  /**
   * The integrals of u_i u_j over the box, exact for the Q2 functions u. Lengths and velocities of the scene: a^3 (gamma a)^2. Collective.
   *
   * @param u velocity block of a fluid vector.
   */
  dealii::SymmetricTensor<2, 3>
  integral_of_products(const TaylorHoodSpace &space, const FluidVector &u);
} // namespace tanktread

#endif
