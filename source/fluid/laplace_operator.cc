// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vector Laplace operator on one rung.

#include <tanktread/fluid/laplace_operator.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace tanktread
{
  namespace
  {
    /** Of the linear functions. */
    std::vector<double>
    linear_unit_cube_matrix()
    {
      const double                      size  = 1.;
      const std::array<unsigned int, 8> nodes = {{0, 1, 2, 3, 4, 5, 6, 7}};
      std::vector<double>               result(64);
      for (unsigned int b = 0; b < 8; ++b)
        {
          std::array<double, 32> p = {}, y = {};
          p[4 * b] = 1.;
          add_linear_laplace(Cubes{1, &size, nullptr, nodes.data()}, p.data(), y.data());
          for (unsigned int a = 0; a < 8; ++a)
            result[8 * a + b] = y[4 * a];
        }
      return result;
    }


    /** Row by row: Laplace and mass matrix with these factors. */
    std::vector<double>
    unit_cube_matrix(const double laplace, const double mass)
    {
      const double                 size = 1.;
      std::array<unsigned int, 27> nodes;
      std::iota(nodes.begin(), nodes.end(), 0);
      const Cubes         cube{1, &size, nodes.data(), nullptr};
      std::vector<double> result(27 * 27);
      for (unsigned int b = 0; b < 27; ++b)
        {
          std::array<double, 108> u = {}, Ku = {}, sum = {};
          u[4 * b] = 1.;
          add_laplace(InstructionSet::baseline, cube, u.data(), Ku.data());
          add_helmholtz(InstructionSet::baseline, cube, &size, u.data(), sum.data());
          for (unsigned int a = 0; a < 27; ++a)
            result[27 * a + b] = laplace * Ku[4 * a] + mass * (sum[4 * a] - Ku[4 * a]);
        }
      return result;
    }
  } // namespace


  template <typename Number>
  LaplaceOperator<Number>::LaplaceOperator(const NodeSpace &space)
    : space_(space)
    , instructions_(best_instruction_set())
  {}


  template <typename Number>
  void
  LaplaceOperator<Number>::set_viscosity(const std::vector<double> &viscosities)
  {
    strain_viscosities_.clear();
    own_factors_ = viscosities;
    for (std::size_t i = 0; i < own_factors_.size(); ++i)
      own_factors_[i] *= space_.cell_sizes()[i];
  }


  template <typename Number>
  void
  LaplaceOperator<Number>::set_strain_form(const Viscosity &viscosity)
  {
    // (grad u^T, grad v) has on average over the directions a third of the Laplace matrix's diagonal.
    std::vector<double> of_diagonal = viscosity.means();
    for (double &mu : of_diagonal)
      mu += (mu - viscosity.least()) / 3.;
    set_viscosity(of_diagonal);
    least_ = viscosity.least();
    zeros_.assign(space_.n_cells(), 0.);
    cut_sizes_.clear();
    cut_nodes_.clear();
    cut_viscosities_.clear();
    const auto add_cut = [&](const unsigned int cell, const double *const more, const double less) {
      const unsigned int *const nodes = space_.cell_nodes(cell);
      cut_sizes_.push_back(space_.cell_sizes()[cell]);
      cut_nodes_.insert(cut_nodes_.end(), nodes, nodes + 27);
      for (unsigned int q = 0; q < 27; ++q)
        cut_viscosities_.push_back(more[q] - less);
    };
    for (unsigned int cell = 0; cell < space_.n_cells(); ++cell)
      {
        const double *const mu         = &viscosity.at_points()[27 * std::size_t(cell)];
        const auto [smallest, largest] = std::minmax_element(mu, mu + 27);
        strain_viscosities_.push_back(*smallest);
        if (*smallest < *largest)
          add_cut(cell, mu, *smallest);
      }
    const std::vector<double> cut = viscosity.cut_at_points();
    for (std::size_t i = 0; i < viscosity.cut().cells.size(); ++i)
      add_cut(viscosity.cut().cells[i], &cut[27 * i], 0.);
  }


  template <typename Number>
  void
  LaplaceOperator<Number>::add_strain_form(const Number *const u, Number *const y) const
  {
    const Cubes all{space_.n_cells(), space_.cell_sizes().data(), space_.cell_nodes(0), nullptr};
    add_uniform_viscous(instructions_, all, strain_viscosities_.data(), least_, u, y);
    const unsigned int n_cut = cut_sizes_.size();
    add_viscous(instructions_, {n_cut, cut_sizes_.data(), cut_nodes_.data(), nullptr}, cut_viscosities_.data(), u, y);
    if (masses_.empty())
      return;
    add_helmholtz(instructions_, {all.n, zeros_.data(), all.velocity_nodes, nullptr}, masses_.data(), u, y);
  }


  template <typename Number>
  void
  LaplaceOperator<Number>::set_shift(const double shift)
  {
    masses_.clear();
    if (shift != 0.)
      for (const double h : space_.cell_sizes())
        masses_.push_back(shift * h * h * h);
  }


  template <typename Number>
  void
  LaplaceOperator<Number>::apply(Number *const u, Number *const y) const
  {
    space_.update(u);
    std::fill(y, y + space_.full_size(), Number(0));
    const bool  linear = space_.nodes_per_cell() == 8;
    const Cubes cells{space_.n_cells(), factors().data(), space_.cell_nodes(0), linear ? space_.cell_nodes(0) : nullptr};
    if (linear)
      add_linear_laplace(cells, u, y);
    else if (!strain_viscosities_.empty())
      add_strain_form(u, y);
    else if (masses_.empty())
      add_laplace(instructions_, cells, u, y);
    else
      add_helmholtz(instructions_, cells, masses_.data(), u, y);
    space_.collect(y);
  }


  template <typename Number>
  std::vector<Number>
  LaplaceOperator<Number>::diagonal() const
  {
    std::vector<double> result = space_.diagonal(space_.nodes_per_cell() == 8 ? linear_unit_cube_matrix() : unit_cube_matrix(1., 0.), factors());
    if (!masses_.empty())
      {
        const std::vector<double> mass = space_.diagonal(unit_cube_matrix(0., 1.), masses_);
        for (std::size_t i = 0; i < result.size(); ++i)
          result[i] += mass[i];
      }
    return {result.begin(), result.end()};
  }


  std::vector<double>
  mass_diagonal(const NodeSpace &space)
  {
    return space.diagonal(unit_cube_matrix(0., 1.), 3);
  }


  template class LaplaceOperator<float>;
  template class LaplaceOperator<double>;
} // namespace tanktread
