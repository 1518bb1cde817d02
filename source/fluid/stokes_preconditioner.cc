// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block-triangular preconditioner of the Stokes equations.

#include <tanktread/fluid/stokes_preconditioner.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    /** Of the trilinear functions on the unit cube. */
    std::vector<double>
    pressure_mass_matrix()
    {
      std::vector<double> result(64, 1. / 216.);
      for (unsigned int i = 0; i < 8; ++i)
        for (unsigned int j = 0; j < 8; ++j)
          for (unsigned int bit = 1; bit < 8; bit *= 2)
            result[8 * i + j] *= (i & bit) == (j & bit) ? 2. : 1.;
      return result;
    }
  } // namespace


  StokesPreconditioner::StokesPreconditioner(const TaylorHoodSpace &space, Multigrid<float> &multigrid, Multigrid<float> *const pressure_multigrid)
    : space_(space)
    , multigrid_(multigrid)
    , pressure_multigrid_(pressure_multigrid)
    , instructions_(best_instruction_set())
    , mass_sizes_(space.pressure->cell_sizes())
    , load_(space.velocity->full_size())
  {
    for (auto *array : {&p_, &r_p_, &residual_, &direction_})
      array->resize(space.pressure->full_size());
    prepare_pressure_mass();
  }


  void
  StokesPreconditioner::set_viscosity(const Viscosity &viscosity)
  {
    multigrid_.set_viscosity(viscosity.means());
    for (std::size_t i = 0; i < mass_sizes_.size(); ++i)
      mass_sizes_[i] = space_.pressure->cell_sizes()[i] / std::cbrt(viscosity.means()[i]);
    prepare_pressure_mass();
  }


  void
  StokesPreconditioner::prepare_pressure_mass()
  {
    const NodeSpace    &p = *space_.pressure;
    std::vector<double> factors;
    for (const double h : mass_sizes_)
      factors.push_back(std::pow(h, 3));
    inverse_diagonal_.clear();
    for (const double d : p.diagonal(pressure_mass_matrix(), factors))
      inverse_diagonal_.push_back(1. / d);
    // On cubes the diagonally scaled trilinear mass matrix has its eigenvalues in [1/8, 27/8]; hanging nodes change little.
    const auto   apply   = [&](float *x, float *y) { apply_pressure_mass(x, y); };
    const double largest = largest_eigenvalue<1>(apply, p, arrays());
    range_               = {5, largest / 20., 1.05 * largest};
  }


  void
  StokesPreconditioner::set_shift(const double shift)
  {
    if (shift != 0. && pressure_multigrid_ == nullptr)
      throw std::logic_error("StokesPreconditioner::set_shift: made without a multigrid for the pressure.");
    shift_ = shift;
    multigrid_.set_shift(shift);
  }


  void
  StokesPreconditioner::add_inertial_pressure() const
  {
    const unsigned int n = space_.pressure->n_owned();
    float *const       b = pressure_multigrid_->right_hand_side();
    for (unsigned int i = 0; i < n; ++i)
      {
        b[4 * i]     = r_p_[i];
        b[4 * i + 1] = b[4 * i + 2] = b[4 * i + 3] = 0.f;
      }
    pressure_multigrid_->v_cycle();
    const float *const solution = pressure_multigrid_->solution();
    for (unsigned int i = 0; i < n; ++i)
      p_[i] += float(shift_) * solution[4 * i];
  }


  ChebyshevArrays<float>
  StokesPreconditioner::arrays() const
  {
    return {inverse_diagonal_, p_, r_p_, residual_, direction_};
  }


  void
  StokesPreconditioner::apply_pressure_mass(float *const p, float *const y) const
  {
    space_.pressure->update(p);
    std::fill(y, y + space_.pressure->full_size(), 0.f);
    add_pressure_mass({space_.pressure->n_cells(), mass_sizes_.data(), nullptr, space_.pressure->cell_nodes(0)}, p, y);
    space_.pressure->collect(y);
  }


  void
  StokesPreconditioner::solve_pressure(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    const NodeSpace &u = *space_.velocity, &p = *space_.pressure;
    p.load(src.block(pressure_block), r_p_.data());
    for (float &r : r_p_)
      r = -r;
    chebyshev<1>([&](float *x, float *y) { apply_pressure_mass(x, y); }, range_, arrays(), true);
    if (shift_ != 0.)
      add_inertial_pressure();
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
