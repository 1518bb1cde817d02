// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Stokes flows in boxes with three different sides and faces of either kind.

#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/fluid/nearest_point.h>
#include <tanktread/fluid/point_interpolation.h>

#include <random>

#include "full_arrays.h"
#include "nodal_velocity.h"
#include "stokes_problem.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  /** Divergence-free velocity that is one wave long along each axis of a box, and zero on none of its faces, with a pressure: -laplace u + grad p = f. */
  class Waves3
  {
  public:
    explicit Waves3(const Box &box)
    {
      for (unsigned int d = 0; d < 3; ++d)
        k_[d] = 2. * dealii::numbers::PI / box.side[d];
      amplitude_ = {{1., 1., -(k_[0] + k_[1]) / k_[2]}};
    }

    std::array<double, 3>
    velocity(const Point &x) const
    {
      return {{amplitude_[0] * s(x, 0) * c(x, 1) * c(x, 2), amplitude_[1] * c(x, 0) * s(x, 1) * c(x, 2), amplitude_[2] * c(x, 0) * c(x, 1) * s(x, 2)}};
    }
    double
    pressure(const Point &x) const
    {
      return s(x, 0) * c(x, 1) * s(x, 2);
    }
    std::array<double, 3>
    force(const Point &x) const
    {
      const std::array<double, 3> u  = velocity(x);
      const double                k2 = k_[0] * k_[0] + k_[1] * k_[1] + k_[2] * k_[2];
      return {
        {k2 * u[0] + k_[0] * c(x, 0) * c(x, 1) * s(x, 2), k2 * u[1] - k_[1] * s(x, 0) * s(x, 1) * s(x, 2), k2 * u[2] + k_[2] * s(x, 0) * c(x, 1) * c(x, 2)}};
    }

  private:
    double
    s(const Point &x, const unsigned int d) const
    {
      return std::sin(k_[d] * x[d] + 0.4 * (d + 1));
    }
    double
    c(const Point &x, const unsigned int d) const
    {
      return std::cos(k_[d] * x[d] + 0.4 * (d + 1));
    }

    std::array<double, 3> k_, amplitude_;
  };

  /** A shear flow along the faces in y, which pass in x, and a pressure that falls along x. */
  struct Poiseuille
  {
    std::array<double, 3>
    velocity(const Point &x) const
    {
      return {{x[1] * x[1] - 0.5 * x[1], 0., 0.}};
    }
    double
    pressure(const Point &x) const
    {
      return 2. * x[0];
    }
    std::array<double, 3>
    force(const Point &) const
    {
      return {{0., 0., 0.}};
    }
  };
} // namespace


TEST(StokesInBricks, OrdersWithPrescribedFaces)
{
  expect_orders(Waves3(closed_brick), closed_brick, {2., 1., 0.5}, {}, 0);
}


TEST(StokesInBricks, OrdersWithPeriodicFaces)
{
  expect_orders(Waves3(brick_along_yz), brick_along_yz, {2., 1., 0.5}, {}, 0);
  expect_orders(Waves3(brick_along_z), brick_along_z, {2., 1., 0.5}, {}, 0);
}


TEST(StokesInBricks, OrdersOnAdaptiveMeshes)
{
  for (const Box &box : {closed_brick, brick_along_yz})
    expect_orders(Waves3(box), box, {1., 0.5}, oracle::sphere_points(Point(-2., -4., 6.), 1.7), 1);
}


TEST(StokesInBricks, PoiseuilleFlowIsExact)
{
  // Fine cells at faces with inflow, with walls and with nothing.
  const Problem problem(MPI_COMM_WORLD, brick_along_z, 4., 0.5, oracle::sphere_points(Point(-2.9, 4.9, 7.9), 1.));
  LinearReport  report;
  const auto    solution = problem.solve(Poiseuille(), report);
  EXPECT_TRUE(report.converged);
  const auto e = errors(Poiseuille(), problem.assembled, solution);
  EXPECT_LT(e.first, 1e-8);
  EXPECT_LT(e.second, 1e-8);
}


TEST(StokesInBricks, ARankWithoutCells)
{
  // On three ranks one has nothing; on rung 0 of the second box two have.
  struct Case
  {
    Box          box;
    double       coarsest, finest;
    unsigned int n_rung_0;
  };
  const Faces             open = Faces::periodic, closed = Faces::prescribed;
  const std::vector<Case> cases = {{{{{2., 1., 1.}}, {{closed, closed, closed}}}, 1., 1., 2},
                                   {{{{1., 1., 1.}}, {{closed, closed, closed}}}, 1., 0.25, 1},
                                   {{{{2., 1., 1.}}, {{open, closed, closed}}}, 1., 0.5, 2}};
  for (const Case &c : cases)
    {
      const std::vector<Point> points = {Point(0.01, 0.02, 0.03)};
      const Problem            together(MPI_COMM_WORLD, c.box, c.coarsest, c.finest, points), alone(MPI_COMM_SELF, c.box, c.coarsest, c.finest, points);
      EXPECT_EQ(together.fluid.mesh().n_rung_0()[0] * together.fluid.mesh().n_rung_0()[1] * together.fluid.mesh().n_rung_0()[2], int(c.n_rung_0));
      LinearReport report, report_alone;
      const auto   e = errors(Waves3(c.box), together.assembled, together.solve(Waves3(c.box), report)),
                 f   = errors(Waves3(c.box), alone.assembled, alone.solve(Waves3(c.box), report_alone));
      EXPECT_TRUE(report.converged);
      EXPECT_EQ(report.iterations, report_alone.iterations);
      EXPECT_NEAR(e.first, f.first, 1e-9);
      EXPECT_NEAR(e.second, f.second, 1e-9);

      // Points, and both viscosities with inertia.
      PointInterpolation interpolation(together.fluid.space());
      interpolation.reinit(points);
      EXPECT_EQ(dealii::Utilities::MPI::sum(interpolation.local_points().size(), MPI_COMM_WORLD), 1u);
      Fluid fluid(MPI_COMM_WORLD, c.box, cells(c.coarsest, c.finest));
      fluid.adapt(points);
      const unsigned int n_cells = fluid.space().velocity->n_cells();
      fluid.set_viscosity(Viscosity(std::vector<double>(27 * n_cells, 2.), 1., {}));
      fluid.set_shift(3.);
      FluidBlockVector x, rhs;
      fluid.space().reinit(x);
      fluid.space().reinit(rhs);
      oracle::set_rough(fluid.mesh(), *fluid.space().velocity, 1, rhs.block(velocity_block));
      fluid.preconditioner().vmult(x, rhs);
      EXPECT_GT(x.block(velocity_block) * rhs.block(velocity_block), 0.);
    }
}


TEST(StokesInBricks, FlowsAreCarriedToNewMeshes)
{
  for (const Box &box : {closed_brick, brick_along_z, brick_along_yz})
    {
      FluidMesh mesh(MPI_COMM_WORLD, box, cells(4., 0.5));
      mesh.adapt({Point(3.9, 5.9, 7.9), Point(-3.9, 0., 1.)});
      auto space = std::make_unique<TaylorHoodSpace>(mesh);
      // Functions of the spaces on any mesh: along axes that are not periodic, quadratic ones that vanish at both ends, or linear ones.
      const auto set = [&](const TaylorHoodSpace &where) {
        FluidBlockVector result = nodal_velocity(where, [&](const Point &x) {
          double u = 1.;
          for (unsigned int d = 0; d < 3; ++d)
            u *= box.is_periodic(d) ? 1. : 1. - std::pow(2. * x[d] / box.side[d], 2);
          return std::array<double, 3>{{u, 2. * u, -u}};
        });
        const auto       x      = oracle::node_positions(where.mesh, *where.pressure);
        for (unsigned int i = 0; i < x.size(); ++i)
          {
            double p = 1.;
            for (unsigned int d = 0; d < 3; ++d)
              p += box.is_periodic(d) ? 0. : x[i][d];
            result.block(pressure_block).local_element(i) = p;
          }
        return result;
      };
      FluidBlockVector    u = set(*space);
      const FieldTransfer transfer(*space, {&u});
      space.reset();
      ASSERT_TRUE(mesh.adapt({Point(3.9, -5.9, 7.9), Point(0.2, 0., 1.)}));
      space = std::make_unique<TaylorHoodSpace>(mesh);
      transfer.interpolate(*space, {&u});
      u -= set(*space);
      EXPECT_LT(u.block(velocity_block).linfty_norm(), 1e-13);
      EXPECT_LT(u.block(pressure_block).linfty_norm(), 1e-9); // nodes on the upper faces are moved inwards a little
    }
}


TEST(StokesInBricks, PointsAtUpperFaces)
{
  for (const Box &box : {closed_brick, brick_along_z, brick_along_yz})
    {
      FluidMesh mesh(MPI_COMM_WORLD, box, cells(4., 0.5));
      mesh.adapt({Point(3.9, 5.9, 7.9)});
      const TaylorHoodSpace space(mesh);
      PointInterpolation    interpolation(space);
      // Just below faces with prescribed velocity, and on or beyond those that are periodic.
      Point corner;
      for (unsigned int d = 0; d < 3; ++d)
        corner[d] = 0.5 * box.side[d] * (box.is_periodic(d) ? 3. : 1. - 1e-15);
      interpolation.reinit({corner, corner, Point()});
      EXPECT_EQ(dealii::Utilities::MPI::sum(interpolation.local_points().size(), MPI_COMM_WORLD), 3u);
      for (unsigned int d = 0; d < 3; ++d)
        if (!box.is_periodic(d))
          for (const double sign : {-1.01, 1.}) // a point on a face belongs to the upper cell
            {
              Point outside;
              outside[d] = sign * 0.5 * box.side[d];
              EXPECT_THROW(interpolation.reinit({outside}), NumericalError);
            }
    }
}


TEST(Box, NearestPointIsThatOfTheNearestImage)
{
  std::mt19937                           random(5);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  for (const Box &box : {closed_brick, brick_along_z, brick_along_yz})
    {
      const auto anywhere = [&] {
        return Point(0.5 * box.side[0] * uniform(random), 0.5 * box.side[1] * uniform(random), 0.5 * box.side[2] * uniform(random));
      };
      std::vector<Point> points;
      for (unsigned int p = 0; p < 20; ++p)
        points.push_back(anywhere());
      if (box.is_periodic(2))
        points[3][2] += 3. * box.side[2]; // anywhere along it
      const NearestPoint nearest(points, box);
      for (unsigned int trial = 0; trial < 200; ++trial)
        {
          const Point  x     = anywhere();
          unsigned int found = 0;
          for (unsigned int p = 1; p < points.size(); ++p)
            if (box.wrapped(Point(x - points[p])).norm() < box.wrapped(Point(x - points[found])).norm())
              found = p;
          EXPECT_EQ(nearest(x), found);
        }
    }
}
