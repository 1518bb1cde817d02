// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of control points that move along a shell other than the material.

#include <Eigen/Geometry>
#include <tanktread/shell/even_mesh.h>
#include <tanktread/surface/surface_geometry.h>

#include <gtest/gtest.h>

#include <cstdio>

#include "shell_examples.h"

namespace
{
  using namespace tanktread;

  constexpr double rounding = 1e-11;

  struct EllipsoidExample
  {
    explicit EllipsoidExample(const unsigned int level, const std::array<double, 3> &axes = {{2., 2., 1.}})
      : capsule(fitted(level, axes), {triangle_quadrature(3), triangle_quadrature(6)}, {}, {1., 0.})
      , even(capsule)
    {}

    static FittedShape
    fitted(const unsigned int level, const std::array<double, 3> &axes)
    {
      CapsuleShapeParameters shape;
      shape.shape = Shape::ellipsoid;
      shape.axes  = axes;
      return make_capsule(shape, level);
    }

    Capsule  capsule;
    EvenMesh even;
  };

  /** Control points of a smooth field that neither lies along the shell nor is a rigid motion. */
  ControlPoints
  smooth_field(const ControlPoints &x)
  {
    ControlPoints result(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      result.row(i) << 0.3 + x(i, 1) * x(i, 2), x(i, 0) - 0.5 * x(i, 1), 0.7 * x(i, 0) * x(i, 0) - x(i, 2);
    return result;
  }

  /** Root mean square over the area of the part of a field across the shell, over that of the field. */
  double
  share_across(const SubdivisionSurface &surface, const ControlPoints &x, const ControlPoints &field)
  {
    const ControlPoints   values = surface.S() * field;
    const Eigen::VectorXd areas = area_weights(surface, x), across = values.cwiseProduct(normals(surface, x)).rowwise().sum();
    return std::sqrt(areas.dot(across.cwiseAbs2()) / areas.dot(values.rowwise().squaredNorm()));
  }

  /** Moves x with w = rate r along the shell, by the classical Runge-Kutta scheme. */
  ControlPoints
  relaxed(const EllipsoidExample &example, ControlPoints x, const unsigned int n_steps, const double step)
  {
    const auto velocity = [&](const ControlPoints &at) {
      return example.even.velocity(ShellConfiguration(example.capsule, at), ControlPoints::Zero(at.rows(), 3), 1.);
    };
    for (unsigned int i = 0; i < n_steps; ++i)
      {
        const ControlPoints k1 = velocity(x), k2 = velocity(x + 0.5 * step * k1), k3 = velocity(x + 0.5 * step * k2), k4 = velocity(x + step * k3);
        x += step / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
      }
    return x;
  }
} // namespace


TEST(EvenMesh, RigidMotionsTakeThePointsAlong)
{
  // Undeformed, wherever it is: nothing to relax, nothing to leave behind.
  const EllipsoidExample   example(2);
  const Eigen::Matrix3d    turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1., -2., 0.5).normalized()).toRotationMatrix();
  const ControlPoints      x    = (example.capsule.initial() * turn.transpose()).rowwise() + Eigen::RowVector3d(3., -1., 0.4);
  const ShellConfiguration shell(example.capsule, x);
  ControlPoints            U(x.rows(), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    U.row(i) = Eigen::RowVector3d(0.2, -1., 0.6) + Eigen::RowVector3d(-0.4, 0.9, 1.3).cross(x.row(i));
  EXPECT_LT(example.even.velocity(shell, U, 2.).cwiseAbs().maxCoeff(), rounding);
  EXPECT_LT(example.even.relaxation(shell).cwiseAbs().maxCoeff(), rounding);
}


TEST(EvenMesh, TheVelocityTurnsWithTheShell)
{
  const EllipsoidExample example(2);
  const Eigen::Matrix3d  turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, 1., -0.6).normalized()).toRotationMatrix();
  const ControlPoints    x = example.capsule.initial() + random_field(example.capsule.n_control_points(), 0.02, 3), U = smooth_field(x);
  const ControlPoints    w      = example.even.velocity(ShellConfiguration(example.capsule, x), U, 2.);
  const ControlPoints    turned = example.even.velocity(ShellConfiguration(example.capsule, x * turn.transpose()), U * turn.transpose(), 2.);
  EXPECT_GT(w.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((turned - w * turn.transpose()).cwiseAbs().maxCoeff(), rounding);
}


TEST(EvenMesh, TheVolumeStays)
{
  const EllipsoidExample   example(2);
  const ControlPoints      x = example.capsule.initial() + random_field(example.capsule.n_control_points(), 0.02, 4);
  const ShellConfiguration shell(example.capsule, x);
  const ControlPoints      w = example.even.velocity(shell, smooth_field(x), 2.);
  EXPECT_LT(std::abs(shell.volume_gradient().cwiseProduct(w).sum()), rounding * shell.volume_gradient().norm() * w.norm());
}


TEST(EvenMesh, OrderOfThePartAcrossTheShell)
{
  // What of w is across the shell is what moves the surface.
  double across[5];
  for (unsigned int level = 2; level < 5; ++level)
    {
      const EllipsoidExample   example(level);
      const SubdivisionSurface surface(example.capsule.topology(), triangle_quadrature(12), Derivatives::first);
      const ControlPoints     &x = example.capsule.initial();
      across[level]              = share_across(surface, x, example.even.velocity(ShellConfiguration(example.capsule, x), smooth_field(x), 1.));
    }
  std::printf("part across the shell: %.2e %.2e %.2e (orders %.2f %.2f)\n",
              across[2],
              across[3],
              across[4],
              order(across[2], across[3]),
              order(across[3], across[4]));
  EXPECT_GT(order(across[2], across[3]), 2.);
  EXPECT_GT(order(across[3], across[4]), 2.);
  EXPECT_LT(across[3], 5e-3);
}


TEST(EvenMesh, OrderOfTheSurfaceOnWhichPointsRelax)
{
  // An evenly meshed sphere in place of a flat ellipsoid: its points crowd where those of the ellipsoid do, on the same sphere.
  double off[4];
  for (unsigned int level = 1; level < 4; ++level)
    {
      const EllipsoidExample example(level), sphere(level, {{1., 1., 1.}});
      const ControlPoints    start = sphere.capsule.initial(), end = relaxed(example, start, 20, 0.25);
      const auto             displacement = [&](const ControlPoints &x) {
        const ShellConfiguration shell(example.capsule, x);
        return example.even.along(shell, example.even.relaxation(shell)).rowwise().norm().maxCoeff();
      };
      const SubdivisionSurface surface(example.capsule.topology(), triangle_quadrature(3), Derivatives::first);
      const Eigen::VectorXd    radii = (surface.S() * end).rowwise().norm(), radii_before = (surface.S() * start).rowwise().norm();
      off[level] = (radii - radii_before).cwiseAbs().maxCoeff();
      std::printf("level %u: points move by up to %.3f, left to move %.2e of %.2e, radius off by %.2e, volume by %.1e\n",
                  level,
                  (end - start).rowwise().norm().maxCoeff(),
                  displacement(end),
                  displacement(start),
                  off[level],
                  enclosed_volume(surface, end) / enclosed_volume(surface, start) - 1.);
      EXPECT_GT((end - start).rowwise().norm().maxCoeff(), 0.1);
      EXPECT_LT(displacement(end), 0.02 * displacement(start));
      EXPECT_LT(std::abs(enclosed_volume(surface, end) / enclosed_volume(surface, start) - 1.), 1e-5);
    }
  std::printf("orders %.2f %.2f\n", order(off[1], off[2]), order(off[2], off[3]));
  EXPECT_GT(order(off[1], off[2]), 2.);
  EXPECT_GT(order(off[2], off[3]), 2.);
}


TEST(EvenMesh, PointsDrawnTogetherFindTheirPlacesAgain)
{
  // Pulled along their own shape, an ellipsoid of three axes, towards a point of it; then left alone.
  const EllipsoidExample example(2, {{2., 1.6, 1.}});
  const ControlPoints   &x0 = example.capsule.initial();
  ControlPoints          x  = x0;
  for (unsigned int i = 0; i < 20; ++i)
    {
      const ControlPoints pull = ((-x).rowwise() + Eigen::RowVector3d(1.2, 0.3, 0.)) * 0.02;
      x += example.even.along(ShellConfiguration(example.capsule, x), pull);
    }
  const double pulled = (x - x0).rowwise().norm().maxCoeff(), left = (relaxed(example, x, 24, 0.25) - x0).rowwise().norm().maxCoeff();
  std::printf("pulled by up to %.3f, then off their places by up to %.4f\n", pulled, left);
  EXPECT_GT(pulled, 0.2);
  EXPECT_LT(left, 0.1 * pulled);
}


TEST(EvenMesh, PlaceIsFreeWithoutMembraneAboutOneCurvature)
{
  for (const MembraneLaw law : {MembraneLaw::neo_hookean, MembraneLaw::skalak, MembraneLaw::none})
    for (const ReferenceCurvature reference : {ReferenceCurvature::flat, ReferenceCurvature::value, ReferenceCurvature::initial})
      for (const double thickness : {0., 0.1})
        {
          ShellParameters parameters;
          parameters.law       = law;
          parameters.reference = reference;
          parameters.thickness = thickness;
          EXPECT_EQ(parameters.place_is_free(), law == MembraneLaw::none && reference != ReferenceCurvature::initial && thickness == 0.);
        }
}
