// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one V-cycle for the velocities.

#include <tanktread/fluid/multigrid.h>
#include <tanktread/fluid/taylor_hood_space.h>

#include <utility>

namespace tanktread
{
  template <typename Number>
  Multigrid<Number>::Multigrid(const Options &options)
    : options_(options)
  {}


  template <typename Number>
  std::shared_ptr<const NodeSpace>
  Multigrid<Number>::nodes(const FluidMesh &mesh) const
  {
    return std::make_shared<NodeSpace>(ScalarSpace(mesh, options_.elements, options_.elements == 2), 3);
  }


  template <typename Number>
  void
  Multigrid<Number>::make_operator()
  {
    Level &level  = levels_.back();
    level.laplace = std::make_unique<LaplaceOperator<Number>>(*level.space);
    level.laplace->set_shift(shift_);
    level.x.resize(level.space->full_size(), Number(0));
    level.b.resize(level.space->full_size(), Number(0));
  }


  template <typename Number>
  void
  Multigrid<Number>::start(const FluidMesh &mesh)
  {
    levels_.clear();
    levels_.emplace_back();
    Level &level = levels_.back();
    level.space  = nodes(mesh);
    make_operator();
    first_rung_solver_ = std::make_unique<FirstRungSolver<Number>>(mesh, *level.laplace);
    first_rung_solver_->set_shift(shift_);
  }


  template <typename Number>
  void
  Multigrid<Number>::climb(FluidMesh &mesh)
  {
    const std::shared_ptr<const NodeSpace> coarse = levels_.back().space;
    levels_.emplace_back();
    Level                  &level = levels_.back();
    const InterpolationRows rows  = climb_with_interpolation(mesh, *coarse, [&]() -> const NodeSpace  &{
      level.space = nodes(mesh);
      return *level.space;
    });
    make_operator();
    level.smoother = std::make_unique<Smoother>(*level.laplace, *level.space, options_.smoother);
    level.transfer = std::make_unique<LevelTransfer<Number>>(rows, *coarse, *level.space);
    level.averages = std::make_unique<CellAverages>(rows.parent, *coarse, *level.space);
    prepare_smoother(level);
  }


  template <typename Number>
  void
  Multigrid<Number>::prepare_smoother(Level &level)
  {
    std::vector<Number> inverse_diagonal = level.laplace->diagonal();
    for (Number &d : inverse_diagonal)
      d = Number(1) / d;
    level.smoother->prepare(std::move(inverse_diagonal), level.x);
  }


  template <typename Number>
  void
  Multigrid<Number>::set_shift(const double shift)
  {
    if (shift == shift_)
      return;
    shift_ = shift;
    first_rung_solver_->set_shift(shift);
    for (Level &level : levels_)
      {
        level.laplace->set_shift(shift);
        if (level.smoother)
          prepare_smoother(level);
      }
  }


  template <typename Number>
  void
  Multigrid<Number>::set_viscosity(const std::vector<double> &viscosities)
  {
    set_viscosity(viscosities, levels_.size());
  }


  template <typename Number>
  void
  Multigrid<Number>::set_viscosity(std::vector<double> values, const unsigned int end)
  {
    for (unsigned int l = end - 1; l > 0; --l)
      {
        Level &level = levels_[l];
        level.laplace->set_viscosity(values);
        prepare_smoother(level);
        values = (*level.averages)(values);
      }
    levels_.front().laplace->set_viscosity(values);
    first_rung_solver_->set_viscosity(values);
  }


  template <typename Number>
  void
  Multigrid<Number>::set_viscosity(const Viscosity &viscosity)
  {
    if (levels_.size() == 1)
      return set_viscosity(viscosity.means());
    Level &last = levels_.back();
    last.laplace->set_strain_form(viscosity);
    prepare_smoother(last);
    set_viscosity((*last.averages)(viscosity.means()), levels_.size() - 1);
  }


  template <typename Number>
  void
  Multigrid<Number>::cycle(const unsigned int l)
  {
    Level &level = levels_[l];
    if (l == 0)
      return first_rung_solver_->vmult(level.x, level.b);
    Level &coarse = levels_[l - 1];
    level.smoother->vmult(level.x, level.b);
    level.transfer->restrict(level.smoother->residual(level.x, level.b), coarse.b.data());
    cycle(l - 1);
    level.transfer->prolongate(coarse.x.data(), level.x.data());
    level.smoother->step(level.x, level.b);
  }


  template <typename Number>
  void
  Multigrid<Number>::v_cycle()
  {
    cycle(levels_.size() - 1);
  }


  template class Multigrid<float>;
  template class Multigrid<double>;
} // namespace tanktread
