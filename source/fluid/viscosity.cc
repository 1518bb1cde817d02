// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a viscosity that differs from place to place.

#include <tanktread/fluid/viscosity.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    /** Gradients of the 27 quadratic functions. */
    std::array<dealii::Tensor<1, 3>, 27>
    gradients(const double x, const double y, const double z)
    {
      const double t[3] = {x, y, z};
      double       value[3][3], slope[3][3];
      for (unsigned int d = 0; d < 3; ++d)
        {
          value[d][0] = (1. - t[d]) * (1. - 2. * t[d]);
          value[d][1] = 4. * t[d] * (1. - t[d]);
          value[d][2] = t[d] * (2. * t[d] - 1.);
          slope[d][0] = 4. * t[d] - 3.;
          slope[d][1] = 4. - 8. * t[d];
          slope[d][2] = 4. * t[d] - 1.;
        }
      std::array<dealii::Tensor<1, 3>, 27> result;
      for (unsigned int a = 0; a < 27; ++a)
        for (unsigned int d = 0; d < 3; ++d)
          result[a][d] = (d == 0 ? slope : value)[0][a % 3] * (d == 1 ? slope : value)[1][a / 3 % 3] * (d == 2 ? slope : value)[2][a / 9];
      return result;
    }


    /** Rule with n points along each axis: weights of the points in all functions' gradients, [point][a], and alone. */
    struct Rule
    {
      std::vector<double>                               weights;
      std::vector<std::array<dealii::Tensor<1, 3>, 27>> gradients;
    };

    const Rule &
    coarse_rule()
    {
      static const Rule result = [] {
        constexpr double w[3] = {5. / 18, 8. / 18, 5. / 18};
        const auto      &x    = gauss_abscissae();
        Rule             rule;
        for (unsigned int q = 0; q < 27; ++q)
          {
            rule.weights.push_back(w[q % 3] * w[q / 3 % 3] * w[q / 9]);
            rule.gradients.push_back(gradients(x[q % 3], x[q / 3 % 3], x[q / 9]));
          }
        return rule;
      }();
      return result;
    }

    const Rule &
    fine_rule()
    {
      static const Rule result = [] {
        const auto &x = fine_gauss_abscissae();
        Rule        rule;
        for (unsigned int q = 0; q < 125; ++q)
          {
            rule.weights.push_back(1.);
            rule.gradients.push_back(gradients(x[q % 5], x[q / 5 % 5], x[q / 25]));
          }
        return rule;
      }();
      return result;
    }


    /** Adds h^2 stress : gradient of the functions, summed over the points times `values`, to the loads of a cell's nodes. */
    template <typename Values>
    void
    add_stress(const Rule &rule, const Values &values, const double h, const dealii::Tensor<2, 3> &stress, const unsigned int *const nodes, double *const loads)
    {
      for (unsigned int a = 0; a < 27; ++a)
        {
          dealii::Tensor<1, 3> sum;
          for (unsigned int q = 0; q < rule.weights.size(); ++q)
            sum += rule.weights[q] * values(q) * rule.gradients[q][a];
          for (unsigned int c = 0; c < 3; ++c)
            loads[4 * std::size_t(nodes[a]) + c] += h * h * (stress[c] * sum);
        }
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
      means_[i / 27] += coarse_rule().weights[i % 27] * at_points_[i];
    for (std::size_t i = 0; i < cut_.cells.size(); ++i)
      means_[cut_.cells[i]] += std::accumulate(&cut_.weights[125 * i], &cut_.weights[125 * i] + 125, 0.);
  }


  void
  Viscosity::add_excess_stress(const TaylorHoodSpace &space, const dealii::Tensor<2, 3> &gradient, FluidVector &y) const
  {
    const NodeSpace              &nodes  = *space.velocity;
    const dealii::Tensor<2, 3>    stress = gradient + transpose(gradient);
    dealii::AlignedVector<double> loads(nodes.full_size());
    std::fill(loads.begin(), loads.end(), 0.);
    for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
      {
        const double *const mu = &at_points_[27 * std::size_t(cell)];
        if (std::any_of(mu, mu + 27, [](const double value) { return value != 1.; }))
          add_stress(
            coarse_rule(),
            [&](const unsigned int q) { return mu[q] - 1.; },
            nodes.cell_sizes()[cell],
            stress,
            nodes.cell_nodes(cell),
            loads.data());
      }
    for (std::size_t i = 0; i < cut_.cells.size(); ++i)
      add_stress(
        fine_rule(),
        [&](const unsigned int q) { return cut_.weights[125 * i + q]; },
        nodes.cell_sizes()[cut_.cells[i]],
        stress,
        nodes.cell_nodes(cut_.cells[i]),
        loads.data());
    nodes.collect(loads.data());
    nodes.store(loads.data(), y, true);
  }
} // namespace tanktread
