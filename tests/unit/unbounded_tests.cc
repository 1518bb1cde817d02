// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a small box in unbounded liquid: flows that are known without any box, one, several and other viscosities inside.

#include <gtest/gtest.h>
#include <oracle/given_forces.h>
#include <tanktread/surface/capsule_shape.h>

#include "small_scene.h"

#include <iostream>

using namespace tanktread;
using oracle::GivenForces;

namespace
{
  const Eigen::RowVector3d off_centre(0.013, 0.031, -0.022);

  /** Symmetric and without trace. */
  Eigen::Matrix3d
  strain()
  {
    Eigen::Matrix3d result;
    result << 0.3, 0.2, 0.5, 0.2, -0.1, -0.4, 0.5, -0.4, -0.2;
    return result;
  }


  /** Error on the shell of the flow of a traction of degree two, whose flow in unbounded liquid is known, in a box of that side. */
  double
  error_of_eigenfunction(const double side, const bool unbounded)
  {
    GivenForces scene(make_capsule({}, 2), Interface::enriched, side, {0.3125, 1.25, 1.5}, {off_centre}, {}, unbounded);
    const auto [traction, exact] = oracle::exact_on_sphere(scene.X(), scene.centre(), 2);
    const auto   flow            = scene.flow({scene.nodal_forces(traction)}, 1e-7);
    const double result          = scene.difference_at_points(scene.coupling_surface.S() * flow.velocity[0], exact);
    if (is_root())
      std::cout << "box " << side << " a, " << (unbounded ? "unbounded" : "walls and periodic faces") << ": "
                << scene.fluid.mesh().triangulation().n_global_active_cells() << " cells, error " << result << ", " << flow.iterations << " iterations"
                << std::endl;
    return result;
  }
} // namespace


TEST(UnboundedLiquid, ControlPointsAreQuadratureEnough)
{
  // At two radii, forces at the control points and at the points of a fine quadrature.
  for (const unsigned int level : {1, 2, 3})
    {
      const FittedShape        shape = make_capsule({}, level);
      const SubdivisionSurface surface(shape.topology, triangle_quadrature(12), Derivatives::first);
      const ControlPoints      X       = surface.S() * shape.control_points;
      const Eigen::VectorXd    weights = area_weights(surface, shape.control_points);
      const ControlPoints      f = oracle::exact_on_sphere(X, Eigen::RowVector3d::Zero(), 2).first, F = surface.S().transposed_times(weights.asDiagonal() * f);
      const auto               velocity_at = [](const ControlPoints &points, const ControlPoints &forces) {
        Columns place, force, at, result;
        for (unsigned int c = 0; c < 3; ++c)
          {
            place[c].assign(points.rows(), 0.);
            force[c].assign(points.rows(), 0.);
            for (Eigen::Index i = 0; i < points.rows(); ++i)
              {
                place[c][i] = points(i, c);
                force[c][i] = forces(i, c);
              }
            at[c]     = {c == 0 ? 2. : 0.3, c == 1 ? -2. : 0.1};
            result[c] = {0., 0.};
          }
        add_stokeslets(place, force, at, result);
        return Eigen::Vector3d(result[0][0], result[1][0], result[2][0]);
      };
      const Eigen::Vector3d fine = velocity_at(X, weights.asDiagonal() * f), coarse = velocity_at(shape.control_points, F);
      std::cout << shape.control_points.rows() << " control points: " << (coarse - fine).norm() / fine.norm() << std::endl;
      EXPECT_LT((coarse - fine).norm(), 0.1 * std::pow(4., 1. - level) * fine.norm());
    }
}


TEST(UnboundedLiquid, FlowOfKnownForcesInASmallBox)
{
  // Here 0.5 % is left by the cells; between walls and periodic faces there is more than the box of 10 a.
  const double small = error_of_eigenfunction(5., true), larger = error_of_eigenfunction(10., true), between_walls = error_of_eigenfunction(10., false);
  EXPECT_LT(small, 0.0058);
  EXPECT_LT(larger, 0.0056);
  EXPECT_GT(between_walls, 2. * larger);
}


TEST(UnboundedLiquid, FlowWithAnotherViscosityInside)
{
  // The force (2 lambda + 3) E n on a sphere moves its surface with E n.
  for (const double lambda : {0.2, 5.})
    {
      GivenForces         scene(make_capsule({}, 2), Interface::enriched, 6.25, {0.3125, 1.25, 1.5}, {off_centre}, {lambda, {}}, true);
      const ControlPoints exact = (scene.X().rowwise() - off_centre) * strain();
      const auto          flow  = scene.flow({scene.nodal_forces((2. * lambda + 3.) * exact)}, 1e-7, 4);
      const double        error = scene.difference_at_points(scene.coupling_surface.S() * flow.velocity[0], exact);
      if (is_root())
        std::cout << "lambda " << lambda << ": error " << error << ", " << flow.iterations << " iterations" << std::endl;
      EXPECT_LT(error, 0.01);
    }
}


TEST(UnboundedLiquid, NewtonEndsWithTheVelocitiesOfItsSolution)
{
  // After a step the residual, with velocities on the faces made anew of the state, is what the report says; and the number of iterations is that of the walls.
  SceneDescription description = small_scene({5., 0.2}, 1., {}, tight(1e-6, 1e-2, Interface::enriched), 7.5);
  description.box.faces.fill(Faces::prescribed);
  std::vector<unsigned int> iterations;
  for (const bool unbounded : {true, false})
    for (const double ratio : {1., 5.})
      {
        description.liquids.unbounded       = unbounded;
        description.liquids.viscosity_ratio = ratio;
        StartedScene scene(description);
        scene.solver().solve_flow(scene.state);
        const TimeStep     step{positions(scene.state), 0.1, 0.1};
        const NewtonReport report = scene.solver().solve(scene.state, step);
        ASSERT_TRUE(report.converged) << report.message;
        iterations.push_back(report.newton_iterations);
        if (is_root())
          {
            std::cout << (unbounded ? "unbounded" : "prescribed") << ", lambda " << ratio << ", residuals";
            for (const double residual : report.residuals)
              std::cout << ' ' << residual;
            std::cout << ", " << report.linear_iterations << " linear iterations" << std::endl;
          }
        const Residual r = scene.level().residual(scene.state, step, TimeLevel::Points::stay);
        EXPECT_LT(std::sqrt(r.capsules[0].velocity.squaredNorm() / r.capsules[0].velocity.rows()), 1e-6);
      }
  EXPECT_LE(iterations[0], iterations[2] + 1);
  EXPECT_LE(iterations[1], iterations[3] + 1);
}


TEST(UnboundedLiquid, CarriesOneShellWithTheFlowOfAnother)
{
  // The force 5 E n on a sphere; a second one without forces moves with the flow of the first.
  GivenForces         scene(make_capsule({}, 2), Interface::enriched, 7.5, {0.3125, 1.25, 1.5}, {{-0.513, -1.28, 0.514}, {0.513, 1.32, -0.531}}, {}, true);
  const ControlPoints none     = ControlPoints::Zero(scene.X().rows(), 3);
  const ControlPoints strained = (scene.X().rowwise() - scene.centre()) * strain();
  const auto          flow     = scene.flow({scene.nodal_forces(5. * strained), scene.nodal_forces(none, 1)}, 1e-7);
  ControlPoints       exact(scene.X(1).rows(), 3);
  for (Eigen::Index q = 0; q < exact.rows(); ++q)
    {
      const Eigen::RowVector3d y = scene.X(1).row(q) - scene.centre();
      const double             r = y.norm();
      exact.row(q)               = 2.5 * (y * strain()).dot(y) * (std::pow(r, -5) - std::pow(r, -7)) * y + std::pow(r, -5) * (y * strain());
    }
  const double error = (scene.coupling_surface.S() * flow.velocity[1] - exact).norm() / exact.norm(),
               own   = scene.difference_at_points(scene.coupling_surface.S() * flow.velocity[0], strained);
  if (is_root())
    std::cout << "errors " << own << ", of the other shell " << error << ", " << flow.iterations << " iterations" << std::endl;
  EXPECT_LT(own, 0.007);
  EXPECT_LT(error, 0.02);
}


TEST(UnboundedLiquid, OtherViscositiesInTwoShellsNeedNoLargeBox)
{
  // Two shells with a film thinner than a cell between them, and long ones side by side, of which each reaches to where the other's centre is nearer; their flow is that of a larger box.
  CapsuleShapeParameters long_one;
  long_one.shape                                                       = Shape::ellipsoid;
  long_one.axes                                                        = {{2.5, 1., 1.}};
  using Centres                                                        = std::vector<Eigen::RowVector3d>;
  const std::vector<std::pair<CapsuleShapeParameters, Centres>> scenes = {{{}, {{-0.313, -1.03, 0.114}, {0.213, 1.075, -0.131}}},
                                                                          {long_one, {{-0.983, -0.81, 0.114}, {1.013, 0.82, -0.031}}}};
  for (const auto &[shape, centres] : scenes)
    {
      std::vector<ShellFields> velocities;
      for (const double side : {7.5, 10.})
        {
          GivenForces         scene(make_capsule(shape, 2), Interface::enriched, side, {0.3125, 1.25, 1.5}, centres, {5., {}}, true);
          const ControlPoints strained = (scene.X().rowwise() - centres[0]) * strain(), pulled = ControlPoints::Constant(scene.X(1).rows(), 3, 0.2);
          velocities.push_back(scene.flow({scene.nodal_forces(13. * strained), scene.nodal_forces(pulled, 1)}, 1e-7, 4).velocity);
        }
      double difference = 0., norm = 0.;
      for (unsigned int c = 0; c < 2; ++c)
        {
          difference += (velocities[0][c] - velocities[1][c]).squaredNorm();
          norm += velocities[1][c].squaredNorm();
        }
      if (is_root())
        std::cout << "centres " << (centres[1] - centres[0]).norm() << " apart: boxes differ by " << std::sqrt(difference / norm) << std::endl;
      EXPECT_LT(std::sqrt(difference / norm), 1e-3);
    }
}
