// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kernels on cubes against element matrices.

#include <deal.II/base/aligned_vector.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <algorithm>
#include <iostream>

#include "reference_kernels.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;
  template <typename Number>
  using Array = dealii::AlignedVector<Number>;

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


namespace
{
  /** Of the kernels for cubes of one viscosity each from those with 27 numbers a cube. */
  template <typename Number>
  double
  largest_uniform_difference()
  {
    RandomCubes         random;
    const unsigned int  n_u = 4 * RandomCubes::n_velocity_nodes, n_p = RandomCubes::n_pressure_nodes;
    std::vector<double> viscosity = random.random_numbers(RandomCubes::n), at_points, u = random.random_numbers(n_u);
    for (double &mu : viscosity)
      {
        mu = 1.5 + mu;
        at_points.insert(at_points.end(), 27, mu);
      }
    const double least = 0.4;
    const auto   u_n = converted<Number>(u), p_n = converted<Number>(random.random_numbers(n_p)), none = converted<Number>(std::vector<double>(n_p, 0.));
    const auto   at_points_n = converted<Number>(at_points);
    double       result      = 0.;
    const auto   from_array  = [](const Array<Number> &x) { return std::vector<double>(x.begin(), x.end()); };
    for (const InstructionSet set : instruction_sets())
      {
        Array<Number> expected(n_u), expected_p(n_p), found(n_u), found_p(n_p), alone(n_u);
        add_viscous_stokes(set, random.view(), at_points_n.data(), Number(least), u_n.data(), p_n.data(), expected.data(), expected_p.data());
        add_uniform_viscous_stokes(set, random.view(), viscosity.data(), least, u_n.data(), p_n.data(), found.data(), found_p.data());
        result = std::max({result, difference(found, from_array(expected)), difference(found_p, from_array(expected_p))});
        Array<Number> expected_alone(n_u), nothing(n_p);
        add_viscous_stokes(set, random.view(), at_points_n.data(), Number(least), u_n.data(), none.data(), expected_alone.data(), nothing.data());
        add_uniform_viscous(set, random.view(), viscosity.data(), least, u_n.data(), alone.data());
        result = std::max(result, difference(alone, from_array(expected_alone)));
      }
    return result;
  }
} // namespace


TEST(CubeKernel, UniformViscousFormIsTheViscousOne)
{
  const double in_double = largest_uniform_difference<double>(), in_float = largest_uniform_difference<float>();
  std::cout << "largest relative difference " << in_double << " in double, " << in_float << " in float" << std::endl;
  EXPECT_LT(in_double, 4e-15);
  EXPECT_LT(in_float, 2e-6);
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
