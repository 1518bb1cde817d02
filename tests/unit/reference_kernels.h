// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: cubes that share nodes, and what the kernels on them should do by element matrices, for tests of the kernels.

#ifndef tanktread_tests_reference_kernels_h
#define tanktread_tests_reference_kernels_h

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <oracle/node_values.h>
#include <tanktread/fluid/assembled_stokes.h>
#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace tanktread
{
  /** Cubes of different sizes that share nodes at random; their number is odd, so some are left when several go together. */
  struct RandomCubes
  {
    static constexpr unsigned int n = 11, n_velocity_nodes = 100, n_pressure_nodes = 30;

    RandomCubes()
    {
      for (unsigned int cube = 0; cube < n; ++cube)
        {
          size.push_back(0.3 + 1.4 * cube / n);
          append(velocity_nodes, n_velocity_nodes, 27);
          append(pressure_nodes, n_pressure_nodes, 8);
        }
    }

    Cubes
    view() const
    {
      return {n, size.data(), velocity_nodes.data(), pressure_nodes.data()};
    }

    std::vector<double>
    random_numbers(const unsigned int how_many)
    {
      std::uniform_real_distribution<double> uniform(-1., 1.);
      std::vector<double>                    result(how_many);
      for (double &x : result)
        x = uniform(random);
      return result;
    }

    std::vector<double>       size;
    std::vector<unsigned int> velocity_nodes, pressure_nodes;
    std::mt19937              random{5};

  private:
    void
    append(std::vector<unsigned int> &nodes, const unsigned int n_all, const unsigned int n_one)
    {
      std::vector<unsigned int> all(n_all);
      for (unsigned int i = 0; i < n_all; ++i)
        all[i] = i;
      std::shuffle(all.begin(), all.end(), random);
      nodes.insert(nodes.end(), all.begin(), all.begin() + n_one);
    }
  };

  /** Element matrices of the unit cube from FEValues, nodes in lexicographic order. */
  struct UnitCube
  {
    UnitCube()
    {
      const ReferenceMatrices matrices;
      laplace       = oracle::lexicographic(matrices.laplace, 2, 2);
      pressure_mass = oracle::lexicographic(matrices.pressure_mass, 1, 1);
      for (unsigned int c = 0; c < 3; ++c)
        divergence[c] = oracle::lexicographic(matrices.divergence[c], 1, 2);

      dealii::Triangulation<3> cube;
      dealii::GridGenerator::hyper_cube(cube);
      const dealii::FE_Q<3>   fe(2);
      const dealii::QGauss<3> quadrature(3);
      dealii::FEValues<3>     values(fe, quadrature, dealii::update_values | dealii::update_gradients);
      values.reinit(cube.begin_active());
      const auto order = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(2);
      for (unsigned int q = 0; q < 27; ++q)
        {
          weight[q] = quadrature.weight(q);
          point[q]  = quadrature.point(q);
          for (unsigned int a = 0; a < 27; ++a)
            {
              value[q][a]    = values.shape_value(order[a], q);
              gradient[q][a] = values.shape_grad(order[a], q);
            }
        }
    }

    std::vector<double>                                  laplace, pressure_mass; // row by row
    std::array<std::vector<double>, 3>                   divergence;
    std::array<double, 27>                               weight;
    std::array<dealii::Point<3>, 27>                     point;
    std::array<std::array<double, 27>, 27>               value;    // at Gauss points, of shape functions
    std::array<std::array<dealii::Tensor<1, 3>, 27>, 27> gradient; // likewise
  };

  /** What the kernels should have added to arrays of zeros. */
  class ReferenceKernels
  {
  public:
    explicit ReferenceKernels(const Cubes &cubes)
      : cubes_(cubes)
    {}

    void
    add_laplace(const std::vector<double> &u, std::vector<double> &y) const
    {
      for_cubes([&](const double h, const unsigned int *nodes, const unsigned int *, unsigned int) {
        for (unsigned int a = 0; a < 27; ++a)
          for (unsigned int b = 0; b < 27; ++b)
            for (unsigned int c = 0; c < 3; ++c)
              y[4 * nodes[a] + c] += h * unit_.laplace[27 * a + b] * u[4 * nodes[b] + c];
      });
    }

    void
    add_pressure_gradient(const double factor, const std::vector<double> &p, std::vector<double> &y) const
    {
      for_cubes([&](const double h, const unsigned int *nodes, const unsigned int *p_nodes, unsigned int) {
        for (unsigned int a = 0; a < 27; ++a)
          for (unsigned int j = 0; j < 8; ++j)
            for (unsigned int c = 0; c < 3; ++c)
              y[4 * nodes[a] + c] += factor * h * h * unit_.divergence[c][27 * j + a] * p[p_nodes[j]];
      });
    }

    void
    subtract_divergence(const std::vector<double> &u, std::vector<double> &y) const
    {
      for_cubes([&](const double h, const unsigned int *nodes, const unsigned int *p_nodes, unsigned int) {
        for (unsigned int a = 0; a < 27; ++a)
          for (unsigned int j = 0; j < 8; ++j)
            for (unsigned int c = 0; c < 3; ++c)
              y[p_nodes[j]] -= h * h * unit_.divergence[c][27 * j + a] * u[4 * nodes[a] + c];
      });
    }

    void
    add_pressure_mass(const std::vector<double> &p, std::vector<double> &y) const
    {
      for_cubes([&](const double h, const unsigned int *, const unsigned int *p_nodes, unsigned int) {
        for (unsigned int i = 0; i < 8; ++i)
          for (unsigned int j = 0; j < 8; ++j)
            y[p_nodes[i]] += h * h * h * unit_.pressure_mass[8 * i + j] * p[p_nodes[j]];
      });
    }

    void
    add_viscous(const std::vector<double> &viscosity, const std::vector<double> &u, std::vector<double> &y) const
    {
      for_cubes([&](const double h, const unsigned int *nodes, const unsigned int *, const unsigned int cube) {
        for (unsigned int q = 0; q < 27; ++q)
          {
            dealii::Tensor<2, 3> gradient; // [component][direction]
            for (unsigned int a = 0; a < 27; ++a)
              for (unsigned int c = 0; c < 3; ++c)
                gradient[c] += u[4 * nodes[a] + c] * unit_.gradient[q][a];
            const dealii::Tensor<2, 3> stress = h * unit_.weight[q] * viscosity[27 * cube + q] * (gradient + transpose(gradient));
            for (unsigned int a = 0; a < 27; ++a)
              for (unsigned int c = 0; c < 3; ++c)
                y[4 * nodes[a] + c] += stress[c] * unit_.gradient[q][a];
          }
      });
    }

    void
    add_helmholtz(const double shift, const std::vector<double> &u, std::vector<double> &y) const
    {
      add_laplace(u, y);
      add_derivative_of_inertia(std::vector<double>(3 * cubes_.n, 0.), {}, {shift, 0.}, u, u, y);
    }

    /** mass (du, v) + convection ((u_inf + u) . grad du + du . grad (u_inf + theta u), v) */
    void
    add_derivative_of_inertia(const std::vector<double>        &corners,
                              const UndisturbedFlow            &undisturbed,
                              const InertiaCoefficients<double> factor,
                              const std::vector<double>        &u,
                              const std::vector<double>        &du,
                              std::vector<double>              &y,
                              const double                      theta = 1.) const
    {
      for_cubes([&](const double h, const unsigned int *nodes, const unsigned int *, const unsigned int cube) {
        for (unsigned int q = 0; q < 27; ++q)
          {
            dealii::Tensor<1, 3> wind, v;
            dealii::Tensor<2, 3> wind_gradient, v_gradient; // [component][direction]
            for (unsigned int a = 0; a < 27; ++a)
              for (unsigned int c = 0; c < 3; ++c)
                {
                  wind[c] += u[4 * nodes[a] + c] * unit_.value[q][a];
                  v[c] += du[4 * nodes[a] + c] * unit_.value[q][a];
                  wind_gradient[c] += theta / h * u[4 * nodes[a] + c] * unit_.gradient[q][a];
                  v_gradient[c] += 1. / h * du[4 * nodes[a] + c] * unit_.gradient[q][a];
                }
            const dealii::Point<3> x = dealii::Point<3>(corners[3 * cube], corners[3 * cube + 1], corners[3 * cube + 2]) + h * unit_.point[q];
            wind += undisturbed.velocity(x);
            wind_gradient += undisturbed.gradient(x);
            const dealii::Tensor<1, 3> f = h * h * h * unit_.weight[q] * (factor.mass * v + factor.convection * (v_gradient * wind + wind_gradient * v));
            for (unsigned int a = 0; a < 27; ++a)
              for (unsigned int c = 0; c < 3; ++c)
                y[4 * nodes[a] + c] += f[c] * unit_.value[q][a];
          }
      });
    }

  private:
    template <typename Function>
    void
    for_cubes(const Function &f) const
    {
      for (unsigned int cube = 0; cube < cubes_.n; ++cube)
        f(cubes_.size[cube], cubes_.velocity_nodes + 27 * cube, cubes_.pressure_nodes + 8 * cube, cube);
    }

    Cubes    cubes_;
    UnitCube unit_;
  };
} // namespace tanktread

#endif
