// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a viscosity that differs from place to place.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/viscosity.h>

#include <cmath>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    constexpr double gauss_weights[3] = {5. / 18, 8. / 18, 5. / 18};


    double
    weight(const unsigned int q)
    {
      return gauss_weights[q % 3] * gauss_weights[q / 3 % 3] * gauss_weights[q / 9];
    }


    /** [q][a][d]: weight of the point times dN_a/dx_d of the quadratic functions there, on the unit cube. */
    using WeightedGradients = std::array<std::array<std::array<double, 3>, 27>, 27>;

    const WeightedGradients &
    weighted_gradients()
    {
      static const WeightedGradients result = [] {
        double value[3][3], derivative[3][3];
        for (int q = 0; q < 3; ++q)
          {
            const double x   = gauss_abscissae()[q];
            value[q][0]      = (1. - x) * (1. - 2. * x);
            value[q][1]      = 4. * x * (1. - x);
            value[q][2]      = x * (2. * x - 1.);
            derivative[q][0] = 4. * x - 3.;
            derivative[q][1] = 4. - 8. * x;
            derivative[q][2] = 4. * x - 1.;
          }
        WeightedGradients gradients;
        for (unsigned int q = 0; q < 27; ++q)
          for (unsigned int a = 0; a < 27; ++a)
            for (unsigned int d = 0; d < 3; ++d)
              gradients[q][a][d] = weight(q) * (d == 0 ? derivative : value)[q % 3][a % 3] * (d == 1 ? derivative : value)[q / 3 % 3][a / 3 % 3] *
                (d == 2 ? derivative : value)[q / 9][a / 9];
        return gradients;
      }();
      return result;
    }
  } // namespace


  const std::array<double, 3> &
  gauss_abscissae()
  {
    static const std::array<double, 3> result = {{0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)}};
    return result;
  }


  Viscosity::Viscosity(std::vector<double> at_points, const double least)
    : at_points_(std::move(at_points))
    , means_(at_points_.size() / 27, 0.)
    , least_(least)
  {
    if (at_points_.size() % 27 != 0)
      throw std::invalid_argument("A viscosity needs 27 numbers a cell.");
    for (std::size_t i = 0; i < at_points_.size(); ++i)
      means_[i / 27] += weight(i % 27) * at_points_[i];
  }


  void
  Viscosity::add_excess_stress(const TaylorHoodSpace &space, const dealii::Tensor<2, 3> &gradient, FluidVector &y) const
  {
    const NodeSpace              &nodes = *space.velocity;
    dealii::AlignedVector<double> loads(nodes.full_size());
    std::fill(loads.begin(), loads.end(), 0.);
    for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
      {
        const double        h    = nodes.cell_sizes()[cell];
        const double *const mu   = &at_points_[27 * std::size_t(cell)];
        bool                some = false;
        for (unsigned int q = 0; q < 27; ++q)
          some = some || mu[q] != 1.;
        if (!some)
          continue;
        for (unsigned int a = 0; a < 27; ++a)
          {
            dealii::Tensor<1, 3> sum;
            for (unsigned int q = 0; q < 27; ++q)
              for (unsigned int d = 0; d < 3; ++d)
                sum[d] += (mu[q] - 1.) * weighted_gradients()[q][a][d];
            double *const node = &loads[4 * std::size_t(nodes.cell_nodes(cell)[a])];
            for (unsigned int c = 0; c < 3; ++c)
              for (unsigned int d = 0; d < 3; ++d)
                node[c] += h * h * (gradient[c][d] + gradient[d][c]) * sum[d];
          }
      }
    nodes.collect(loads.data());
    nodes.store(loads.data(), y, true);
  }


  double
  Viscosity::excess(const TaylorHoodSpace &space) const
  {
    double result = 0.;
    for (unsigned int cell = 0; cell < means_.size(); ++cell)
      result += std::pow(space.velocity->cell_sizes()[cell], 3) * (means_[cell] - 1.);
    return dealii::Utilities::MPI::sum(result, space.mesh.communicator());
  }
} // namespace tanktread
