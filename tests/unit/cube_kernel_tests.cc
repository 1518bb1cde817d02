// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kernels on cubes against element matrices.

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <gtest/gtest.h>
#include <oracle/assembled_stokes.h>
#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <algorithm>
#include <iostream>
#include <random>

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;
  template <typename Number>
  using Array = dealii::AlignedVector<Number>;

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
      const oracle::ReferenceMatrices matrices;
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
    std::array<Point, 27>                                point;
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
            const Point x = Point(corners[3 * cube], corners[3 * cube + 1], corners[3 * cube + 2]) + h * unit_.point[q];
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

  std::vector<InstructionSet>
  instruction_sets()
  {
    std::vector<InstructionSet> result;
    for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
      if (set <= best_instruction_set())
        result.push_back(set);
    return result;
  }

  template <typename Number>
  Array<Number>
  converted(const std::vector<double> &values)
  {
    Array<Number> result(values.size());
    std::copy(values.begin(), values.end(), result.begin());
    return result;
  }

  /** Largest difference, divided by the largest number expected. */
  template <typename Number>
  double
  difference(const Array<Number> &found, const std::vector<double> &expected)
  {
    double result = 0., size = 0.;
    for (unsigned int i = 0; i < expected.size(); ++i)
      {
        result = std::max(result, std::abs(found[i] - expected[i]));
        size   = std::max(size, std::abs(expected[i]));
      }
    return result / size;
  }

  /** All kernels with all instruction sets against matrices; what is in the fourth lanes must not matter. Returns the largest difference. */
  template <typename Number>
  double
  largest_kernel_difference()
  {
    RandomCubes               random;
    const Cubes               cubes = random.view();
    const ReferenceKernels    reference(cubes);
    const unsigned int        n_u = 4 * RandomCubes::n_velocity_nodes, n_p = RandomCubes::n_pressure_nodes;
    const std::vector<double> u = random.random_numbers(n_u), p = random.random_numbers(n_p), y_u = random.random_numbers(n_u),
                              y_p = random.random_numbers(n_p);
    std::vector<double> viscosity = random.random_numbers(27 * RandomCubes::n);
    for (double &mu : viscosity)
      mu = 1.1 + mu;
    std::vector<double> laplace = y_u, helmholtz = y_u, gradient = y_u, viscous = y_u, stokes_u, stokes_p = y_p, mass = y_p;
    reference.add_helmholtz(2.3, u, helmholtz);
    std::vector<double> masses;
    for (unsigned int i = 0; i < cubes.n; ++i)
      masses.push_back(2.3 * std::pow(cubes.size[i], 3));
    reference.add_laplace(u, laplace);
    reference.add_pressure_gradient(1., p, gradient);
    reference.add_viscous(viscosity, u, viscous);
    stokes_u = laplace;
    reference.add_pressure_gradient(-1., p, stokes_u);
    reference.subtract_divergence(u, stokes_p);
    reference.add_pressure_mass(p, mass);

    const auto u_n = converted<Number>(u), p_n = converted<Number>(p), viscosity_n = converted<Number>(viscosity);
    double     result = 0.;
    for (const InstructionSet set : instruction_sets())
      {
        auto found = converted<Number>(y_u), found_p = converted<Number>(y_p);
        add_laplace(set, cubes, u_n.data(), found.data());
        result = std::max(result, difference(found, laplace));
        found  = converted<Number>(y_u);
        add_helmholtz(set, cubes, masses.data(), u_n.data(), found.data());
        result = std::max(result, difference(found, helmholtz));
        found  = converted<Number>(y_u);
        add_pressure_gradient(set, cubes, p_n.data(), found.data());
        result = std::max(result, difference(found, gradient));
        found  = converted<Number>(y_u);
        add_viscous(set, cubes, viscosity_n.data(), u_n.data(), found.data());
        result = std::max(result, difference(found, viscous));
        found  = converted<Number>(y_u);
        add_stokes(set, cubes, u_n.data(), p_n.data(), found.data(), found_p.data());
        result  = std::max({result, difference(found, stokes_u), difference(found_p, stokes_p)});
        found_p = converted<Number>(y_p);
        add_pressure_mass(cubes, p_n.data(), found_p.data());
        result = std::max(result, difference(found_p, mass));
        for (unsigned int i = 3; i < n_u; i += 4)
          EXPECT_EQ(found[i], Number(y_u[i]));
      }
    return result;
  }

  /** Inertia and its derivative in that flow, likewise. */
  template <typename Number>
  double
  largest_inertia_difference(const UndisturbedFlow &undisturbed)
  {
    RandomCubes                       random;
    const Cubes                       cubes = random.view();
    const ReferenceKernels            reference(cubes);
    const unsigned int                n_u = 4 * RandomCubes::n_velocity_nodes;
    const std::vector<double>         u = random.random_numbers(n_u), du = random.random_numbers(n_u), y = random.random_numbers(n_u);
    const std::vector<double>         corners = random.random_numbers(3 * RandomCubes::n);
    const InertiaCoefficients<double> factor  = {0.7, 1.3};
    const InertiaCoefficients<Number> factor_n{Number(factor.mass), Number(factor.convection)};
    std::vector<double>               terms = y, derivative = y;
    reference.add_derivative_of_inertia(corners, undisturbed, factor, u, u, terms, 0.);
    reference.add_derivative_of_inertia(corners, undisturbed, factor, u, du, derivative);

    const auto u_n = converted<Number>(u), du_n = converted<Number>(du);
    double     result = 0.;
    for (const InstructionSet set : instruction_sets())
      {
        auto found = converted<Number>(y), found_derivative = found;
        add_inertia(set, cubes, corners.data(), undisturbed, factor_n, u_n.data(), found.data());
        add_inertia_derivative(set, cubes, corners.data(), undisturbed, factor_n, u_n.data(), du_n.data(), found_derivative.data());
        result = std::max({result, difference(found, terms), difference(found_derivative, derivative)});
        for (unsigned int i = 3; i < n_u; i += 4)
          EXPECT_TRUE(found[i] == Number(y[i]) && found_derivative[i] == Number(y[i]));
      }
    return result;
  }

  /** None, a linear and a quadratic one whose numbers all differ (not free of divergence, which the kernels do not mind). */
  std::vector<UndisturbedFlow>
  undisturbed_flows()
  {
    UndisturbedFlow linear, quadratic;
    for (unsigned int c = 0; c < 3; ++c)
      {
        linear.constant[c] = 0.3 - 0.2 * c;
        for (unsigned int d = 0; d < 3; ++d)
          {
            linear.linear[c][d] = 0.9 - 0.35 * c + 0.25 * d;
            for (unsigned int e = 0; e < 3; ++e)
              quadratic.quadratic[c][d][e] = 0.4 - 0.23 * c + 0.31 * (d + e) - 0.17 * d * e;
          }
      }
    quadratic.constant = linear.constant;
    quadratic.linear   = linear.linear;
    return {{}, linear, quadratic};
  }
} // namespace


TEST(CubeKernel, InertiaIsThatInEachUndisturbedFlow)
{
  for (const UndisturbedFlow &flow : undisturbed_flows())
    {
      const double in_double = largest_inertia_difference<double>(flow), in_float = largest_inertia_difference<float>(flow);
      std::cout << "largest relative difference " << in_double << " in double, " << in_float << " in float" << std::endl;
      EXPECT_LT(in_double, 2e-15);
      EXPECT_LT(in_float, 1e-6);
    }
}


TEST(CubeKernel, EqualsElementMatricesInDouble)
{
  const double found = largest_kernel_difference<double>();
  std::cout << "largest relative difference " << found << ", " << instruction_sets().size() << " instruction sets" << std::endl;
  EXPECT_LT(found, 2e-15);
}


TEST(CubeKernel, EqualsElementMatricesInFloat)
{
  const double found = largest_kernel_difference<float>();
  std::cout << "largest relative difference " << found << std::endl;
  EXPECT_LT(found, 1e-6);
}


TEST(CubeKernel, ViscousFormIsSymmetricAndBlindForRigidMotions)
{
  RandomCubes         random;
  const unsigned int  n_u       = 4 * RandomCubes::n_velocity_nodes;
  std::vector<double> viscosity = random.random_numbers(27 * RandomCubes::n);
  for (double &mu : viscosity)
    mu = 1.1 + mu;
  std::vector<double> u = random.random_numbers(n_u), v = random.random_numbers(n_u);
  for (unsigned int i = 3; i < n_u; i += 4)
    u[i] = v[i] = 0.;
  for (const InstructionSet set : instruction_sets())
    {
      const auto    u_n = converted<double>(u), v_n = converted<double>(v);
      Array<double> Au(n_u), Av(n_u);
      add_viscous(set, random.view(), viscosity.data(), u_n.data(), Au.data());
      add_viscous(set, random.view(), viscosity.data(), v_n.data(), Av.data());
      double uAv = 0., vAu = 0., uAu = 0.;
      for (unsigned int i = 0; i < n_u; ++i)
        {
          uAv += u[i] * Av[i];
          vAu += v[i] * Au[i];
          uAu += u[i] * Au[i];
        }
      EXPECT_NEAR(uAv, vAu, 1e-14 * uAu);
      EXPECT_GT(uAu, 0.);
    }

  const double              h = 0.7;
  std::vector<unsigned int> nodes(27);
  for (unsigned int a = 0; a < 27; ++a)
    nodes[a] = a;
  for (const bool rigid : {true, false})
    {
      std::array<double, 108> motion = {}, y = {};
      for (unsigned int a = 0; a < 27; ++a)
        {
          const Point x(0.5 * h * (a % 3), 0.5 * h * (a / 3 % 3), 0.5 * h * (a / 9));
          motion[4 * a]     = 0.3 - 1.1 * x[1] + 0.4 * x[2];
          motion[4 * a + 1] = -0.2 + 1.1 * x[0] - 0.9 * x[2];
          motion[4 * a + 2] = 0.5 - (rigid ? 0.4 : 0.41) * x[0] + 0.9 * x[1];
        }
      add_viscous(InstructionSet::baseline, Cubes{1, &h, nodes.data(), nullptr}, viscosity.data(), motion.data(), y.data());
      double largest = 0.;
      for (const double f : y)
        largest = std::max(largest, std::abs(f));
      if (rigid)
        EXPECT_LT(largest, 2e-15);
      else
        EXPECT_GT(largest, 1e-4);
    }
}
