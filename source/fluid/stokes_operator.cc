// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the discrete Stokes equations.

#include <tanktread/fluid/stokes_operator.h>

#include <algorithm>

namespace tanktread
{
  Cubes
  cubes(const TaylorHoodSpace &space)
  {
    const NodeSpace &u = *space.velocity;
    return {u.n_cells(), u.cell_sizes().data(), u.cell_nodes(0), space.pressure->cell_nodes(0)};
  }


  std::vector<double>
  lower_corners(const TaylorHoodSpace &space)
  {
    std::vector<double> result;
    result.reserve(3 * std::size_t(space.velocity->n_cells()));
    for (const auto &cell : space.mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int d = 0; d < 3; ++d)
          result.push_back(cell->vertex(0)[d]);
    return result;
  }


  StokesOperator::StokesOperator(const TaylorHoodSpace &space)
    : space_(space)
    , instructions_(best_instruction_set())
    , u_(space.velocity->full_size())
    , p_(space.pressure->full_size())
    , y_u_(u_.size())
    , y_p_(p_.size())
  {}


  void
  StokesOperator::set_viscosity(const Viscosity &viscosity)
  {
    viscosity_ = &viscosity;
    cut_sizes_.clear();
    cut_nodes_.clear();
    for (const unsigned int cell : viscosity.cut().cells)
      {
        const unsigned int *const nodes = space_.velocity->cell_nodes(cell);
        cut_sizes_.push_back(space_.velocity->cell_sizes()[cell]);
        cut_nodes_.insert(cut_nodes_.end(), nodes, nodes + 27);
      }
  }


  void
  StokesOperator::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    const NodeSpace &u = *space_.velocity, &p = *space_.pressure;
    u.load(src.block(velocity_block), u_.data());
    p.load(src.block(pressure_block), p_.data());
    u.update(u_.data());
    p.update(p_.data());
    std::fill(y_u_.begin(), y_u_.end(), 0.);
    std::fill(y_p_.begin(), y_p_.end(), 0.);
    if (viscosity_ == nullptr)
      add_stokes(instructions_, cubes(space_), u_.data(), p_.data(), y_u_.data(), y_p_.data());
    else
      {
        const double *const x_u = u_.data(), *const x_p = p_.data();
        if (viscosity_->in_cells().empty())
          add_viscous_stokes(instructions_, cubes(space_), viscosity_->at_points().data(), viscosity_->least(), x_u, x_p, y_u_.data(), y_p_.data());
        else
          add_uniform_viscous_stokes(instructions_, cubes(space_), viscosity_->in_cells().data(), viscosity_->least(), x_u, x_p, y_u_.data(), y_p_.data());
        const unsigned int n_cut = cut_sizes_.size();
        add_weighted_viscous(instructions_, {n_cut, cut_sizes_.data(), cut_nodes_.data(), nullptr}, viscosity_->cut().weights.data(), x_u, y_u_.data());
      }
    u.collect(y_u_.data());
    p.collect(y_p_.data());
    u.store(y_u_.data(), dst.block(velocity_block), false);
    p.store(y_p_.data(), dst.block(pressure_block), false);
  }
} // namespace tanktread
