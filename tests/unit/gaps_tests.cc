// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the gaps between shells, and between shells and walls.

#include <tanktread/shell/gaps.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

using namespace tanktread;

namespace
{
  constexpr double infinity = std::numeric_limits<double>::infinity();

  const std::array<double, 3> unbounded = {{infinity, infinity, infinity}};

  /** Points of the coupling are about 0.03 a apart: the nearest of them misses the nearest point of a sphere by a thousandth. */
  constexpr double resolution = 1e-3;

  struct Capsules
  {
    explicit Capsules(const Shape shape, const Derivatives derivatives = Derivatives::second)
      : capsule(fitted(shape), {triangle_quadrature(3), triangle_quadrature(12), derivatives}, {}, {1., 0.})
    {}

    static FittedShape
    fitted(const Shape shape)
    {
      CapsuleShapeParameters parameters;
      parameters.shape = shape;
      return make_capsule(parameters, 3);
    }

    ShellConfigurations
    at(const std::vector<Eigen::RowVector3d> &centres) const
    {
      ShellFields x;
      for (const Eigen::RowVector3d &centre : centres)
        x.push_back(capsule.initial().rowwise() + centre);
      return shell_configurations(capsule, x);
    }

    Capsule capsule;
  };

  /** Off all symmetries of the control mesh, of length one. */
  Eigen::RowVector3d
  direction()
  {
    return Eigen::RowVector3d(0.3, -0.5, 0.7).normalized();
  }
} // namespace


TEST(Gaps, OfTwoSpheresApartTouchingAndOverlapping)
{
  // Their radius is 1.
  const Capsules spheres(Shape::sphere), with_planes(Shape::sphere, Derivatives::first);
  for (const double gap : {0.5, 0.1, 0.01, 0., -0.01, -0.1, -0.5})
    for (const Capsules *const capsules : {&spheres, &with_planes})
      {
        const std::vector<Eigen::RowVector3d> centres  = {0.2 * direction(), (2.2 + gap) * direction()};
        const ShellGap                        smallest = smallest_gap(capsules->at(centres), unbounded, 1.);
        std::cout << "gap " << gap << ": error " << smallest.gap - gap << std::endl;
        EXPECT_NEAR(smallest.gap, gap, resolution);
        EXPECT_EQ(smallest.first, 0u);
        EXPECT_EQ(smallest.second, 1u);
      }
}


TEST(Gaps, OfShellsFarApartAreNearlyRight)
{
  // Every 16th point of one of them: about 0.1 a apart. The boxes about them are farther from each other than `reach`.
  const Capsules spheres(Shape::sphere);
  const ShellGap gap = smallest_gap(spheres.at({Eigen::RowVector3d::Zero(), {5., 0.3, 0.2}}), unbounded, 0.5);
  EXPECT_NEAR(gap.gap, std::sqrt(25. + 0.09 + 0.04) - 2., 0.02);
}


TEST(Gaps, TheSmallestOfSeveralIsFound)
{
  const Capsules spheres(Shape::sphere);
  const ShellGap gap = smallest_gap(spheres.at({{-4., 0., 0.}, {0., 0., 0.}, {0., 2.5, 1.5}, {0., 5.2, 1.4}}), unbounded, 1.);
  EXPECT_NEAR(gap.gap, std::sqrt(2.7 * 2.7 + 0.01) - 2., resolution);
  EXPECT_EQ(gap.first, 2u);
  EXPECT_EQ(gap.second, 3u);
  const ShellGap one = smallest_gap(spheres.at({{0., 0., 0.}}), unbounded, 1.);
  EXPECT_EQ(one.gap, infinity);
}


TEST(Gaps, PeriodicImagesCount)
{
  const Capsules              spheres(Shape::sphere);
  const std::array<double, 3> periods = {{5., infinity, infinity}};
  // 2.7 to the right, 2.3 to the left of an image.
  EXPECT_NEAR(smallest_gap(spheres.at({{0.1, 0., 0.}, {2.8, 0., 0.}}), unbounded, 1.).gap, 0.7, resolution);
  const ShellGap gap = smallest_gap(spheres.at({{0.1, 0., 0.}, {2.8, 0., 0.}}), periods, 1.);
  EXPECT_NEAR(gap.gap, 0.3, resolution);
  EXPECT_EQ(gap.first + gap.second, 1u);
  // The same along another axis, where there are no images.
  EXPECT_NEAR(smallest_gap(spheres.at({{0., 0.1, 0.}, {0., 2.8, 0.}}), periods, 1.).gap, 0.7, resolution);
  // Across a corner of a box that is periodic in two directions.
  EXPECT_NEAR(smallest_gap(spheres.at({{2., 2., 0.}, {-1.2, -1.4, 0.1}}), {{5., 5., infinity}}, 1.).gap,
              std::sqrt(1.8 * 1.8 + 1.6 * 1.6 + 0.01) - 2.,
              resolution);
  // Nearly in the same place: no point of one is deeper than the way between their middles inside the other.
  EXPECT_NEAR(smallest_gap(spheres.at({{2.4, 0., 0.}, {-2.4, 0., 0.}}), periods, 1.).gap, -0.2, resolution);
}


TEST(Gaps, OwnImagesCountWithinReach)
{
  const Capsules              spheres(Shape::sphere);
  const std::array<double, 3> periods = {{2.3, infinity, 2.2}};
  const ShellGap              gap     = smallest_gap(spheres.at({{10., 0., 0.}}), periods, 1.);
  EXPECT_NEAR(gap.gap, 0.2, resolution);
  EXPECT_EQ(gap.first, 0u);
  EXPECT_EQ(gap.second, 0u);
  EXPECT_EQ(smallest_gap(spheres.at({{10., 0., 0.}}), periods, 0.1).gap, infinity);
  EXPECT_NEAR(smallest_gap(spheres.at({{0., 0., 0.}}), {{1.9, infinity, infinity}}, 0.1).gap, -0.1, resolution);
}


TEST(Gaps, BoxesAwayAreTheSame)
{
  const Capsules              spheres(Shape::sphere);
  const std::array<double, 3> periods = {{5., 6., infinity}};
  const double                gap     = smallest_gap(spheres.at({{0.1, 0.2, 0.}, {2.8, 0.3, 0.1}}), periods, 1.).gap;
  EXPECT_NEAR(gap, std::sqrt(2.3 * 2.3 + 0.02) - 2., resolution);
  EXPECT_NEAR(smallest_gap(spheres.at({{0.1, 0.2, 0.}, {2.8 + 15., 0.3 - 12., 0.1}}), periods, 1.).gap, gap, 1e-12);
  EXPECT_NEAR(smallest_gap(spheres.at({{0.1 - 500., 0.2 + 600., 0.}, {2.8 + 1e4, 0.3 - 12., 0.1}}), periods, 1.).gap, gap, 1e-9);
}


namespace
{
  /** Smallest distance of the points of two shells. */
  double
  distance_of_points(const ShellConfiguration &first, const ShellConfiguration &second)
  {
    double result = infinity;
    for (Eigen::Index q = 0; q < first.points().rows(); ++q)
      result = std::min(result, (second.points().rowwise() - first.points().row(q)).rowwise().squaredNorm().minCoeff());
    return std::sqrt(result);
  }
} // namespace


TEST(Gaps, OfConcaveShells)
{
  // The rim of one disk, on edge, in the hollow of another: the boxes about them overlap, the shells do not until the rim meets the bottom.
  const Capsules       disks(Shape::biconcave);
  const ControlPoints &flat = disks.capsule.initial();
  ControlPoints        upright(flat.rows(), 3);
  upright << flat.col(2), flat.col(0), flat.col(1);
  const double height = flat.col(2).maxCoeff(), radius = flat.col(0).maxCoeff();
  bool         in_the_hollow = false, overlap = false;
  for (const double lowest : {0.45, 0.3, 0.2, -0.05})
    {
      const ControlPoints       above  = upright.rowwise() + Eigen::RowVector3d(0.01, 0.02, radius + lowest);
      const ShellConfigurations shells = shell_configurations(disks.capsule, {flat, above});
      const double              gap = smallest_gap(shells, unbounded, 1.).gap, distance = distance_of_points(*shells[0], *shells[1]);
      std::cout << "rim at height " << lowest << " (hollow up to " << height << "): gap " << gap << ", distance of points " << distance << std::endl;
      if (gap > 0.)
        {
          EXPECT_LE(gap, distance + 1e-12);
          EXPECT_GT(gap, distance - 0.02);
        }
      in_the_hollow = in_the_hollow || (gap > 0. && lowest < 0.8 * height);
      overlap       = overlap || gap < -0.02;
    }
  EXPECT_TRUE(in_the_hollow);
  EXPECT_TRUE(overlap);
}


TEST(Gaps, DistanceFromFaces)
{
  const Capsules spheres(Shape::sphere);
  EXPECT_NEAR(smallest_distance_from_faces(spheres.at({{0.3, 0., 0.5}, {7., 0., -0.2}}), {{infinity, infinity, 2.}}), 0.5, resolution);
  EXPECT_NEAR(smallest_distance_from_faces(spheres.at({{0.3, 0., 0.5}}), {{infinity, 1.2, 2.}}), 0.2, resolution);
  EXPECT_NEAR(smallest_distance_from_faces(spheres.at({{0., 0., -1.4}}), {{infinity, infinity, 2.}}), -0.4, resolution);
  EXPECT_EQ(smallest_distance_from_faces(spheres.at({{50., 0., 0.}}), unbounded), infinity);
}


TEST(Gaps, OfTheSheetsOfOneShell)
{
  const Capsules            spheres(Shape::sphere), disks(Shape::biconcave);
  const ShellConfigurations sphere = spheres.at({direction()}), disk = disks.at({direction()});
  EXPECT_EQ(smallest_self_gap(*sphere[0], 0.5), infinity);

  // A disk is thinnest in the middle, 4 points of the coupling across: what its points there are apart.
  const ControlPoints points = disk[0]->points().rowwise() - direction();
  double              upper  = infinity;
  for (Eigen::Index q = 0; q < points.rows(); ++q)
    if (points.row(q).head<2>().norm() < 0.1)
      upper = std::min(upper, std::abs(points(q, 2)));
  std::cout << "thickness of the disk " << 2. * upper << ", self gap " << smallest_self_gap(*disk[0], 1.) << std::endl;
  EXPECT_NEAR(smallest_self_gap(*disk[0], 1.), 2. * upper, 0.02);
  EXPECT_EQ(smallest_self_gap(*disk[0], 1.9 * upper), infinity);

  // The same disk half as thick.
  ControlPoints x = disks.capsule.initial();
  x.col(2) *= 0.5;
  const ShellConfigurations flat = shell_configurations(disks.capsule, {x});
  EXPECT_NEAR(smallest_self_gap(*flat[0], 1.), upper, 0.02);
}
