// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the terms of inertia in the momentum equation.

#include <tanktread/fluid/inertia.h>
#include <tanktread/fluid/stokes_operator.h>

#include <algorithm>

namespace tanktread
{
  Inertia::Inertia(const TaylorHoodSpace &space, const double reynolds_number, const UndisturbedFlow &undisturbed)
    : space_(space)
    , instructions_(best_instruction_set())
    , reynolds_number_(reynolds_number)
    , undisturbed_(undisturbed)
    , corners_(lower_corners(space))
    , history_(space.velocity->partitioner())
    , flow_(space.velocity->full_size())
    , u_(flow_.size())
    , y_(flow_.size())
  {}


  void
  Inertia::set_flow(const UndisturbedFlow &undisturbed)
  {
    undisturbed_ = undisturbed;
  }


  InertiaCoefficients<double>
  Inertia::coefficients() const
  {
    return {mass_, reynolds_number_};
  }


  void
  Inertia::begin_step(const FluidVector &uhat, const double tau)
  {
    mass_                 = reynolds_number_ / tau;
    const NodeSpace &node = *space_.velocity;
    node.load(uhat, u_.data());
    node.update(u_.data());
    std::fill(y_.begin(), y_.end(), 0.);
    add_inertia(instructions_, cubes(space_), corners_.data(), {}, {mass_, 0.}, u_.data(), y_.data());
    node.collect(y_.data());
    node.store(y_.data(), history_, false);
  }


  void
  Inertia::add_residual(const FluidBlockVector &u, FluidBlockVector &residual) const
  {
    const NodeSpace &node = *space_.velocity;
    node.load(u.block(velocity_block), u_.data());
    node.update(u_.data());
    std::fill(y_.begin(), y_.end(), 0.);
    add_inertia(instructions_, cubes(space_), corners_.data(), undisturbed_, coefficients(), u_.data(), y_.data());
    node.collect(y_.data());
    node.store(y_.data(), residual.block(velocity_block), true);
    residual.block(velocity_block).add(-1., history_);
  }


  void
  Inertia::linearise(const FluidBlockVector &u)
  {
    const NodeSpace &node = *space_.velocity;
    node.load(u.block(velocity_block), flow_.data());
    node.update(flow_.data());
  }


  void
  Inertia::add_derivative(const FluidBlockVector &du, FluidBlockVector &y) const
  {
    const NodeSpace &node = *space_.velocity;
    node.load(du.block(velocity_block), u_.data());
    node.update(u_.data());
    std::fill(y_.begin(), y_.end(), 0.);
    add_inertia_derivative(instructions_, cubes(space_), corners_.data(), undisturbed_, coefficients(), flow_.data(), u_.data(), y_.data());
    node.collect(y_.data());
    node.store(y_.data(), y.block(velocity_block), true);
  }


  double
  Inertia::power(const FluidBlockVector &u) const
  {
    FluidBlockVector terms;
    space_.reinit(terms, 1);
    add_residual(u, terms);
    return terms.block(velocity_block) * u.block(velocity_block);
  }
} // namespace tanktread
