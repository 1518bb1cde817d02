// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Stokes flows as sums over points: flows that are known, and the identities of the double layer.

#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/far_field.h>

#include <cmath>
#include <functional>
#include <random>

using namespace tanktread;
using Vector = dealii::Tensor<1, 3>;

namespace
{
  const double pi = dealii::numbers::PI;

  void
  append(Columns &columns, const Vector &vector)
  {
    for (unsigned int c = 0; c < 3; ++c)
      columns[c].push_back(vector[c]);
  }


  Columns
  columns(const std::vector<Vector> &vectors)
  {
    Columns result;
    for (const Vector &vector : vectors)
      append(result, vector);
    return result;
  }


  Vector
  row(const Columns &columns, const std::size_t i)
  {
    return Vector({columns[0][i], columns[1][i], columns[2][i]});
  }


  Columns
  zeros(const std::size_t n)
  {
    Columns result;
    result.fill(std::vector<double>(n, 0.));
    return result;
  }


  /** Points of a sphere with vector areas, exact for harmonics of degree below 2 n. */
  struct Sphere
  {
    Sphere(const double radius, const Vector &centre, const unsigned int n)
    {
      const dealii::QGauss<1> height(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < 2 * n; ++j)
          {
            const double z = 2. * height.point(i)[0] - 1., s = std::sqrt(1. - z * z), angle = pi * (j + 0.5) / n;
            normals.push_back(Vector({s * std::cos(angle), s * std::sin(angle), z}));
            append(points, centre + radius * normals.back());
            append(areas, 2. * height.weight(i) * pi / n * radius * radius * normals.back());
          }
    }

    template <typename Function>
    Columns
    field(const Function &function) const
    {
      Columns result;
      for (std::size_t q = 0; q < normals.size(); ++q)
        append(result, function(normals[q]));
      return result;
    }

    double
    area(const std::size_t q) const
    {
      return row(areas, q).norm();
    }

    std::vector<Vector> normals;
    Columns             points, areas;
  };


  const dealii::Tensor<2, 3> strain({{0.3, 0.2, 0.5}, {0.2, -0.1, -0.4}, {0.5, -0.4, -0.2}}); // without trace
  const Vector               centre({0.1, -0.2, 0.3});

  /** Velocity outside the unit sphere whose surface moves with strain r, at rest far away. */
  Vector
  outside_of_strained_sphere(const Vector &y)
  {
    const double r = y.norm(), yEy = y * strain * y;
    return 2.5 * yEy * (std::pow(r, -5) - std::pow(r, -7)) * y + std::pow(r, -5) * (strain * y);
  }


  std::vector<Vector>
  places(const double smallest, const double largest, const unsigned int n)
  {
    std::vector<Vector>                    result;
    std::mt19937                           random(7);
    std::uniform_real_distribution<double> in_cube(-1., 1.), distance(smallest, largest);
    while (result.size() < n)
      {
        const Vector x({in_cube(random), in_cube(random), in_cube(random)});
        if (x.norm() > 0.1 && x.norm() < 1.)
          result.push_back(centre + distance(random) / x.norm() * x);
      }
    return result;
  }


  double
  largest_error(const Columns &velocity, const std::vector<Vector> &places, const std::function<Vector(const Vector &)> &exact)
  {
    double result = 0.;
    for (std::size_t i = 0; i < places.size(); ++i)
      result = std::max(result, (row(velocity, i) - exact(places[i] - centre)).norm());
    return result;
  }
} // namespace


TEST(Stokeslet, IsTheFlowOfAPointForce)
{
  // Along the force 1/(4 pi r), across it 1/(8 pi r).
  Columns velocity = zeros(2);
  add_stokeslets(columns({centre}), columns({Vector({0., 0., 3.})}), columns({centre + Vector({0., 0., 2.}), centre + Vector({2., 0., 0.})}), velocity);
  EXPECT_NEAR(velocity[2][0], 3. / (4. * pi * 2.), 1e-15);
  EXPECT_NEAR(velocity[2][1], 3. / (8. * pi * 2.), 1e-15);
  EXPECT_NEAR(std::abs(velocity[0][0]) + std::abs(velocity[1][0]) + std::abs(velocity[0][1]) + std::abs(velocity[1][1]), 0., 1e-15);
}


TEST(Stokeslet, AddsUpForManyPointsAtAnyLength)
{
  // More points than are taken at a time, one by one and all together; what was there stays.
  const std::vector<Vector> at = places(2., 5., 1037);
  const Sphere              sphere(1., centre, 6);
  const Columns             forces   = sphere.field([](const Vector &n) { return n[0] * Vector({1., 2., 3.}) + n; });
  Columns                   together = zeros(at.size());
  together[1].back()                 = 7.;
  add_stokeslets(sphere.points, forces, columns(at), together);
  for (std::size_t i = 0; i < at.size(); ++i)
    {
      Columns one = zeros(1);
      for (std::size_t q = 0; q < sphere.normals.size(); ++q)
        add_stokeslets(columns({row(sphere.points, q)}), columns({row(forces, q)}), columns({at[i]}), one);
      for (unsigned int c = 0; c < 3; ++c)
        EXPECT_NEAR(together[c][i], one[c][0] + (c == 1 && i + 1 == at.size() ? 7. : 0.), 1e-13);
    }
}


TEST(Stokeslet, PressureOnAClosedSurfaceDrivesNoFlow)
{
  const Sphere              sphere(1., centre, 24);
  const std::vector<Vector> at       = places(2., 5., 20);
  Columns                   velocity = zeros(at.size());
  add_stokeslets(sphere.points, sphere.areas, columns(at), velocity);
  EXPECT_LT(largest_error(velocity, at, [](const Vector &) { return Vector(); }), 1e-12);
}


TEST(Stokeslet, OfARigidSphereInStrain)
{
  // The traction 5 E n on a rigid unit sphere in the strain E makes the flow that brings the surface to rest: single layer of -5 E n (Einstein).
  const Sphere              sphere(1., centre, 24);
  const std::vector<Vector> at       = places(2., 5., 20);
  Columns                   velocity = zeros(at.size()), forces;
  for (std::size_t q = 0; q < sphere.normals.size(); ++q)
    append(forces, -5. * sphere.area(q) * (strain * sphere.normals[q]));
  add_stokeslets(sphere.points, forces, columns(at), velocity);
  EXPECT_LT(largest_error(velocity, at, [](const Vector &y) { return -outside_of_strained_sphere(y); }), 1e-10);
}


TEST(DoubleLayer, OfARigidMotionVanishesOutsideAndIsMinusItInside)
{
  const Sphere sphere(1., centre, 40);
  const Vector velocity_of_centre({1., -2., 0.5}), spin({0.3, 0.1, -0.7});
  const auto   motion = [&](const Vector &y) { return velocity_of_centre + dealii::cross_product_3d(spin, y); };
  for (const bool outside : {true, false})
    {
      const std::vector<Vector> at       = outside ? places(1.8, 5., 20) : places(0.05, 0.5, 20);
      Columns                   velocity = zeros(at.size());
      add_double_layer(sphere.points, sphere.field(motion), sphere.areas, 1., columns(at), velocity);
      EXPECT_LT(largest_error(velocity, at, [&](const Vector &y) { return outside ? Vector() : -motion(y); }), 1e-10);
    }
}


TEST(DoubleLayer, TogetherWithForcesIsTheFlowOutsideLiquidOfAnotherViscosity)
{
  // Inside the flow E r with the traction 2 lambda E n, outside the one above with -3 E n: the shell between them pushes with (2 lambda + 3) E n.
  const Sphere              sphere(1., centre, 24);
  const std::vector<Vector> at = places(2., 5., 20);
  for (const double lambda : {0., 0.2, 1., 5.})
    {
      Columns velocity = zeros(at.size()), forces;
      for (std::size_t q = 0; q < sphere.normals.size(); ++q)
        append(forces, (2. * lambda + 3.) * sphere.area(q) * (strain * sphere.normals[q]));
      add_stokeslets(sphere.points, forces, columns(at), velocity);
      add_double_layer(sphere.points, sphere.field([](const Vector &n) { return strain * n; }), sphere.areas, 1. - lambda, columns(at), velocity);
      EXPECT_LT(largest_error(velocity, at, outside_of_strained_sphere), 1e-10) << "lambda = " << lambda;
    }
}
