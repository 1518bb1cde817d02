// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block-triangular preconditioner of the Stokes equations.

#include <tanktread/fluid/stokes_preconditioner.h>

#include <algorithm>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** On cubes the diagonally scaled trilinear mass matrix has its eigenvalues in [1/8, 27/8]; hanging nodes change little. */
    constexpr ChebyshevOptions all_eigenvalues = {5, 20., 1.05};
  } // namespace


  StokesPreconditioner::StokesPreconditioner(const TaylorHoodSpace &space, Multigrid<float> &multigrid, Multigrid<float> &pressure_multigrid)
    : space_(space)
    , multigrid_(multigrid)
    , instructions_(best_instruction_set())
    , projection_(space, pressure_multigrid)
    , pressure_mass_(*space.pressure)
    , pressure_mass_inverse_(pressure_mass_, *space.pressure, all_eigenvalues)
    , p_(space.pressure->full_size())
    , r_p_(space.pressure->full_size())
    , load_(space.velocity->full_size())
  {
    prepare_pressure_mass();
  }


  void
  StokesPreconditioner::set_viscosity(const Viscosity &viscosity)
  {
    multigrid_.set_viscosity(viscosity);
    pressure_mass_.set_viscosity(viscosity.means());
    prepare_pressure_mass();
  }


  void
  StokesPreconditioner::prepare_pressure_mass()
  {
    std::vector<float> inverse_diagonal;
    for (const double d : pressure_mass_.diagonal())
      inverse_diagonal.push_back(1. / d);
    pressure_mass_inverse_.prepare(std::move(inverse_diagonal), p_);
  }


  void
  StokesPreconditioner::set_shift(const double shift)
  {
    shift_ = shift;
    multigrid_.set_shift(shift);
  }


  void
  StokesPreconditioner::solve_pressure(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    const NodeSpace &u = *space_.velocity, &p = *space_.pressure;
    p.load(src.block(pressure_block), r_p_.data());
    for (float &r : r_p_)
      r = -r;
    pressure_mass_inverse_.vmult(p_, r_p_);
    projection_.add(src.block(velocity_block), shift_, r_p_.data(), p_.data());
    p.store(p_.data(), dst.block(pressure_block), false);

    p.update(p_.data());
    std::fill(load_.begin(), load_.end(), 0.f);
    add_pressure_gradient(instructions_, cubes(space_), p_.data(), load_.data());
    u.collect(load_.data());
  }


  void
  StokesPreconditioner::vmult(FluidBlockVector &dst, const FluidBlockVector &src, Timings *const timings) const
  {
    const NodeSpace &u = *space_.velocity;
    {
      const Timings::Scope scope(timings, "- pressure mass and gradient");
      solve_pressure(dst, src);
    }
    const Timings::Scope scope(timings, "- V-cycle");
    float *const         b = multigrid_.right_hand_side();
    u.load(src.block(velocity_block), b);
    for (std::size_t i = 0; i < std::size_t(u.stride()) * u.n_owned(); ++i)
      b[i] += load_[i];
    multigrid_.v_cycle();
    u.store(multigrid_.solution(), dst.block(velocity_block), false);
  }
} // namespace tanktread
