// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about cells that a shell cuts, distances from it and mean gradients at it.

#include <gtest/gtest.h>
#include <tanktread/coupling/mean_gradient.h>
#include <tanktread/surface/capsule_shape.h>

#include <cmath>
#include <iostream>

using namespace tanktread;

namespace
{
  /** Distances of a plane or a sphere from the nodes of a unit cube. */
  template <typename Function>
  std::array<double, 27>
  at_nodes(const Function &f)
  {
    std::array<double, 27> result;
    for (int a = 0; a < 27; ++a)
      result[a] = f(Eigen::Vector3d(0.5 * (a % 3), 0.5 * (a / 3 % 3), 0.5 * (a / 9)));
    return result;
  }
} // namespace


TEST(CutCell, PlanesAndSpheresHaveTheirVolume)
{
  // An oblique plane cuts off a corner: distance d from the origin along (1, 1, 1) leaves a tetrahedron of volume (sqrt(3) d)^3/6.
  const double d     = 0.37;
  const auto   plane = inside_matrices(at_nodes([&](const Eigen::Vector3d &x) { return x.sum() / std::sqrt(3.) - d; }));
  EXPECT_NEAR(plane.volume, std::pow(std::sqrt(3.) * d, 3) / 6., 1e-13);
  // Planes through the whole cell, both sides: their matrices add up to those of the cube, up to the rule for tetrahedra.
  const auto below = inside_matrices(at_nodes([](const Eigen::Vector3d &x) { return x[2] - 0.3; })),
             above = inside_matrices(at_nodes([](const Eigen::Vector3d &x) { return 0.3 - x[2]; }));
  EXPECT_NEAR(below.volume, 0.3, 1e-13);
  for (int a = 0; a < 27; ++a)
    for (int b = 0; b < 27; ++b)
      EXPECT_NEAR(below.laplace[a][b] + above.laplace[a][b], whole_cell_matrices().laplace[a][b], 0.02);
  // A sphere larger than the cell: second-order sliver correction.
  const auto sphere = inside_matrices(at_nodes([](const Eigen::Vector3d &x) { return (x - Eigen::Vector3d(-2., 0.5, 0.5)).norm() - 2.5; }));
  double     exact  = 0.;
  const int  n      = 400;
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < n; ++k)
      exact += (-2. + std::sqrt(6.25 - std::pow((j + 0.5) / n - 0.5, 2) - std::pow((k + 0.5) / n - 0.5, 2))) / (n * n);
  EXPECT_NEAR(sphere.volume, exact, 2e-4);
}


TEST(SignedDistance, ConvergesOnTheSphere)
{
  double before = 0.;
  for (const unsigned int level : {2, 3, 4})
    {
      const FittedShape        shape = make_capsule({}, level);
      const SubdivisionSurface surface(shape.topology, triangle_quadrature(3), Derivatives::second);
      const auto               patches = quadratic_patches(surface, shape.control_points);
      double                   largest = 0.;
      for (std::size_t q = 0; q < patches.size(); q += 7)
        {
          // A point off the surface, aside by half the distance of quadrature points.
          const Eigen::Vector3d y = patches[q].X + 0.3 * patches[q].a_1 + 0.05 * patches[q].X;
          largest                 = std::max(largest, std::abs(signed_distance(patches[q], y) - (y.norm() - 1.)));
        }
      std::cout << "level " << level << ": error of distances " << largest << std::endl;
      if (before > 0.)
        {
          EXPECT_LT(largest, before / 3.5); // the surface itself converges with second order to the sphere near its irregular vertices
        }
      before = largest;
    }
}


TEST(MeanGradient, LayersOfTwoLiquids)
{
  // A plane through the middle of a cell; U_z on both sides quadratic in x, with forces and pressures that keep it in balance, u_h its nodal interpolant.
  const double  h = 0.3, lambda = 5., slope_in = 0.7, slope_out = 1.9, second_in = -2., second_out = 3.5;
  NodeDistances nodes;
  for (unsigned int a = 0; a < 27; ++a)
    {
      nodes.phi[a]    = (0.5 * (a % 3) - 0.5) * h;
      nodes.inside[a] = nodes.phi[a] < 0.;
    }
  VertexForces F;
  for (unsigned int v = 0; v < 8; ++v)
    F[v] = Vector4(0., 0., -0.5 * (1. + lambda) * (slope_out - slope_in)) + Vector4(0., 0., 0., (second_out - lambda * second_in) * h * (v / 4));
  const double    left = -0.5 * h * slope_in + h * h / 8. * second_in, right = 0.5 * h * slope_out + h * h / 8. * second_out; // of U_z - U_z(middle)
  Eigen::Matrix3d of_u_h = Eigen::Matrix3d::Zero();
  of_u_h(2, 0)           = (right - left) / h;
  const Eigen::Vector3d laplacian(0., 0., 4. * (left + right) / (h * h));
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const QuadraticPatch  patch{zero, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), zero, zero, zero};
  const MeanGradient    mean(nodes, node_amplitudes(nodes, lambda), {0.5, 0.3, 0.8}, h, patch);
  const double          exact  = 0.5 * (slope_in + slope_out);
  const Eigen::Matrix3d result = mean(of_u_h, laplacian, F, lambda), rough = mean.without_second_jump(of_u_h, F);
  EXPECT_NEAR(result(2, 0), exact, 1e-12);
  EXPECT_NEAR(rough(2, 0), exact + h / 8. * (second_out - second_in), 1e-12);
  EXPECT_LT((result - result(2, 0) * Eigen::Vector3d::UnitZ() * Eigen::RowVector3d::UnitX()).norm(), 1e-12);
  // The normal derivative of the normal velocity is what the others leave of the divergence.
  of_u_h << 9., 0., 0., 0., 2., 0., 0., 0., -0.5;
  EXPECT_NEAR(mean.without_second_jump(of_u_h, {})(0, 0), -1.5, 1e-12);
}
