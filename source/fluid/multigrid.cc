// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one V-cycle for the velocities.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/multigrid.h>
#include <tanktread/fluid/taylor_hood_space.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  Multigrid<Number>::start(const FluidMesh &mesh)
  {
    levels_.clear();
    smallest_viscosity_ = largest_viscosity_ = 1.;
    levels_.emplace_back();
    levels_.back().space = nodes(mesh);
    coarse_solver_       = std::make_unique<CoarseSolver<Number>>(mesh, *levels_.back().space);
    finish_level();
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
    level.transfer                = std::make_unique<LevelTransfer<Number>>(rows, *coarse, *level.space);
    level.averages                = std::make_unique<CellAverages>(rows.parent, *coarse, *level.space);
    finish_level();
  }


  template <typename Number>
  ChebyshevArrays<Number>
  Multigrid<Number>::arrays(Level &level)
  {
    return {level.inverse_diagonal, level.x, level.b, level.residual, level.direction};
  }


  template <typename Number>
  void
  Multigrid<Number>::finish_level()
  {
    Level &level  = levels_.back();
    level.laplace = std::make_unique<LaplaceOperator<Number>>(*level.space);
    for (auto *array : {&level.x, &level.b, &level.residual, &level.direction})
      array->resize(level.space->full_size(), Number(0));
    if (levels_.size() == 1)
      coarse_solver_->set_shift(shift_);
    else
      prepare_smoother(level);
  }


  template <typename Number>
  void
  Multigrid<Number>::set_shift(const double shift)
  {
    if (shift == shift_)
      return;
    shift_ = shift;
    coarse_solver_->set_shift(shift);
    levels_.front().laplace->set_shift(shift);
    for (std::size_t l = 1; l < levels_.size(); ++l)
      prepare_smoother(levels_[l]);
  }


  template <typename Number>
  void
  Multigrid<Number>::prepare_smoother(Level &level)
  {
    level.laplace->set_shift(shift_);
    level.inverse_diagonal = level.laplace->diagonal();
    for (Number &d : level.inverse_diagonal)
      d = Number(1) / d;
    const auto apply         = [&](Number *x, Number *y) { level.laplace->apply(x, y); };
    level.largest_eigenvalue = tanktread::largest_eigenvalue<4>(apply, *level.space, arrays(level));
  }


  template <typename Number>
  void
  Multigrid<Number>::set_viscosity(const std::vector<double> &viscosities)
  {
    std::vector<double> values = viscosities;
    for (unsigned int l = levels_.size(); l-- > 0;)
      {
        Level &level = levels_[l];
        level.laplace->set_viscosity(values);
        if (l == 0)
          break;
        prepare_smoother(level);
        values = (*level.averages)(values);
      }
    const MPI_Comm communicator = levels_.front().space->partitioner()->get_mpi_communicator();
    double         smallest = 1., largest = 1.; // a rank may have no cell; and the mass matrix of inertia counts like a viscosity of one
    for (const double mu : values)
      {
        smallest = std::min(smallest, mu);
        largest  = std::max(largest, mu);
      }
    smallest_viscosity_ = dealii::Utilities::MPI::min(smallest, communicator);
    largest_viscosity_  = dealii::Utilities::MPI::max(largest, communicator);
  }


  template <typename Number>
  void
  Multigrid<Number>::solve_first_rung()
  {
    // The eigenvalues of the direct solver times the matrix lie between the smallest and the largest viscosity, one included.
    Level        &level  = levels_.front();
    const double  center = 0.5 * (largest_viscosity_ + smallest_viscosity_), half = 0.5 * (largest_viscosity_ - smallest_viscosity_), t = center / half;
    Number *const x = level.x.data(), *const b = level.b.data(), *const residual = level.residual.data(), *const direction = level.direction.data();
    coarse_solver_->solve(b, x);
    const std::size_t n = 4 * std::size_t(level.space->n_owned());
    if (center == 1. && half == 0.)
      return;
    for (std::size_t j = 0; j < n; ++j)
      x[j] = direction[j] = x[j] / Number(center);
    double rho = 1. / t;
    for (double before = 1., polynomial = t; polynomial < 10.;)
      {
        level.laplace->apply(x, residual);
        for (std::size_t j = 0; j < n; ++j)
          residual[j] = b[j] - residual[j];
        coarse_solver_->solve(residual, residual);
        const double next = 1. / (2. * t - rho);
        const Number f_d = next * rho, f_r = 2. * next / half;
        for (std::size_t j = 0; j < n; ++j)
          x[j] += direction[j] = f_d * direction[j] + f_r * residual[j];
        rho                           = next;
        const double polynomial_after = 2. * t * polynomial - before;
        before                        = polynomial;
        polynomial                    = polynomial_after;
      }
  }


  template <typename Number>
  void
  Multigrid<Number>::cycle(const unsigned int l)
  {
    Level &level = levels_[l];
    if (l == 0)
      return solve_first_rung();
    const ChebyshevRange range{options_.degree, level.largest_eigenvalue / options_.range, level.largest_eigenvalue};
    const auto           apply = [&](Number *x, Number *y) { level.laplace->apply(x, y); };
    chebyshev<4>(apply, range, arrays(level), true);
    level.laplace->apply(level.x.data(), level.residual.data());
    for (std::size_t j = 0; j < 4 * std::size_t(level.space->n_owned()); ++j)
      level.residual[j] = level.b[j] - level.residual[j];
    level.transfer->restrict(level.residual.data(), levels_[l - 1].b.data());
    cycle(l - 1);
    level.transfer->prolongate(levels_[l - 1].x.data(), level.x.data());
    chebyshev<4>(apply, range, arrays(level), false);
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
