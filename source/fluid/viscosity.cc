// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a viscosity that differs from place to place.

#include <tanktread/fluid/cell_weights.h>
#include <tanktread/fluid/stokes_operator.h>
#include <tanktread/fluid/viscosity.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    using CellArray = std::array<double, 4 * 27>; // of a cell's own, four numbers a node

    /** The flow less its value at the cell's corner: the 27 nodes hold it exactly, being of degree two. */
    CellArray
    nodal_values(const UndisturbedFlow &flow, const dealii::Point<3> &corner, const double h)
    {
      const dealii::Tensor<2, 3> gradient = flow.gradient(corner);
      CellArray                  result{};
      for (unsigned int a = 0; a < 27; ++a)
        {
          const dealii::Tensor<1, 3> offset = 0.5 * h * dealii::Point<3>(a % 3, a / 3 % 3, a / 9),
                                     value  = (gradient + 0.5 * (flow.quadratic * offset)) * offset;
          for (unsigned int c = 0; c < 3; ++c)
            result[4 * a + c] = value[c];
        }
      return result;
    }


    constexpr std::array<double, 3> gauss_weights = {{5. / 18, 8. / 18, 5. / 18}};


    /** Values at the five fine Gauss points of the quadratic functions that are one at one of the three and zero at the others: [fine][coarse]. */
    std::array<std::array<double, 3>, 5>
    coarse_lagrange()
    {
      std::array<std::array<double, 3>, 5> result;
      const std::array<double, 3>         &x = gauss_abscissae();
      for (unsigned int p = 0; p < 5; ++p)
        for (unsigned int q = 0; q < 3; ++q)
          {
            const double a = x[(q + 1) % 3], b = x[(q + 2) % 3];
            result[p][q] = (fine_gauss_abscissae()[p] - a) * (fine_gauss_abscissae()[p] - b) / ((x[q] - a) * (x[q] - b));
          }
      return result;
    }
  } // namespace


  const std::array<double, 3> &
  gauss_abscissae()
  {
    static const std::array<double, 3> result = {{0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)}};
    return result;
  }


  Viscosity::Viscosity(std::vector<double> at_points, const double least, CutCells cut)
    : at_points_(std::move(at_points))
    , means_(at_points_.size() / 27, 0.)
    , least_(least)
    , cut_(std::move(cut))
  {
    if (at_points_.size() % 27 != 0)
      throw std::invalid_argument("A viscosity needs 27 numbers a cell.");
    for (std::size_t i = 0; i < at_points_.size(); ++i)
      means_[i / 27] += gauss_weights[i % 3] * gauss_weights[i / 3 % 3] * gauss_weights[i % 27 / 9] * at_points_[i];
    for (std::size_t i = 0; i < at_points_.size(); i += 27)
      {
        if (std::any_of(&at_points_[i], &at_points_[i] + 27, [&](const double mu) { return mu != at_points_[i]; }))
          {
            in_cells_.clear();
            break;
          }
        in_cells_.push_back(at_points_[i]);
      }
    for (std::size_t i = 0; i < cut_.cells.size(); ++i)
      means_[cut_.cells[i]] += std::accumulate(&cut_.weights[125 * i], &cut_.weights[125 * i] + 125, 0.);
  }


  std::vector<double>
  Viscosity::cut_at_points() const
  {
    static const auto   lagrange = coarse_lagrange();
    std::vector<double> result(27 * cut_.cells.size(), 0.);
    for (std::size_t i = 0; i < cut_.cells.size(); ++i)
      {
        double *const sums = &result[27 * i];
        for (unsigned int p = 0; p < 125; ++p)
          for (unsigned int q = 0; q < 27; ++q)
            sums[q] += cut_.weights[125 * i + p] * lagrange[p % 5][q % 3] * lagrange[p / 5 % 5][q / 3 % 3] * lagrange[p / 25][q / 9];
        double whole = 0., positive = 0.;
        for (unsigned int q = 0; q < 27; ++q)
          {
            whole += sums[q];
            positive += sums[q] = std::max(sums[q], 0.);
          }
        for (unsigned int q = 0; q < 27; ++q)
          sums[q] *= positive > 0. ? std::max(whole, 0.) / (positive * gauss_weights[q % 3] * gauss_weights[q / 3 % 3] * gauss_weights[q / 9]) : 0.;
      }
    return result;
  }


  void
  Viscosity::add_excess_stress(const TaylorHoodSpace &space, const UndisturbedFlow &flow, FluidVector &y) const
  {
    const NodeSpace              &nodes        = *space.velocity;
    const std::vector<double>     corners      = lower_corners(space);
    const InstructionSet          instructions = best_instruction_set();
    dealii::AlignedVector<double> loads(nodes.full_size());
    std::array<unsigned int, 27>  own_nodes;
    std::iota(own_nodes.begin(), own_nodes.end(), 0);
    // The strain form of the flow cell by cell, since nodes that periodic copies share cannot hold it.
    const auto add = [&](const unsigned int cell, const auto &kernel, const double *const viscosity) {
      const double *const corner = &corners[3 * std::size_t(cell)];
      const double        h      = nodes.cell_sizes()[cell];
      const CellArray     values = nodal_values(flow, {corner[0], corner[1], corner[2]}, h);
      CellArray           load{};
      kernel(instructions, Cubes{1, &h, own_nodes.data(), nullptr}, viscosity, values.data(), load.data());
      for (unsigned int a = 0; a < 27; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          loads[4 * std::size_t(nodes.cell_nodes(cell)[a]) + c] += load[4 * a + c];
    };
    std::array<double, 27> excess;
    for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
      {
        const double *const mu = &at_points_[27 * std::size_t(cell)];
        std::transform(mu, mu + 27, excess.begin(), [](const double value) { return value - 1.; });
        if (std::any_of(excess.begin(), excess.end(), [](const double value) { return value != 0.; }))
          add(cell, add_viscous<double>, excess.data());
      }
    for (std::size_t i = 0; i < cut_.cells.size(); ++i)
      add(cut_.cells[i], add_weighted_viscous<double>, &cut_.weights[125 * i]);
    nodes.collect(loads.data());
    nodes.store(loads.data(), y, true);
  }
} // namespace tanktread
