// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about spreading and interpolation.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/coupling/coupling.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>

#include <random>

#include "nodal_velocity.h"

using namespace tanktread;

namespace
{
  struct Scene
  {
    explicit Scene(const MPI_Comm communicator = MPI_COMM_WORLD)
      : mesh(communicator, 4., parameters())
      , shape(make_capsule({}, 2))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::first)
      , coupling(surface, area_weights(surface, shape.control_points))
      , x(shape.control_points)
    {
      x.col(0).array() += 1.3; // crosses the periodic face x = 2
      x.col(2) *= 0.8;
      // Off the planes of symmetry: there points lie on faces of cells, across which velocity gradients jump.
      x.rowwise() += Eigen::RowVector3d(0.00137, 0.00271, 0.00314);
      mesh.adapt(coupling.points(x));
      space = std::make_unique<TaylorHoodSpace>(mesh);
      coupling.attach(*space);
      coupling.move(x);
      space->reinit(u);
      std::mt19937                     random(7 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
      std::normal_distribution<double> normal;
      for (double &number : u.block(velocity_block))
        number = normal(random);
      std::mt19937 same_everywhere(3);
      f.resizeLike(x);
      for (Eigen::Index i = 0; i < f.size(); ++i)
        f.data()[i] = normal(same_everywhere);
    }

    static FluidMeshParameters
    parameters()
    {
      FluidMeshParameters p;
      p.coarsest_cell = 1.;
      p.finest_cell   = 0.25;
      return p;
    }

    FluidMesh                        mesh;
    FittedShape                      shape;
    SubdivisionSurface               surface;
    Coupling                         coupling;
    ControlPoints                    x, f;
    std::unique_ptr<TaylorHoodSpace> space;
    FluidBlockVector                 u;
  };
} // namespace


TEST(Coupling, PowerOfShellIsPowerReceivedByFluid)
{
  Scene            s;
  FluidBlockVector load;
  s.space->reinit(load);
  s.coupling.spread(s.f, load);
  const ControlPoints velocity = s.coupling.interpolate(s.u);
  const double        power    = s.f.cwiseProduct(velocity).sum();
  EXPECT_GT(std::abs(power), 1e-3);
  EXPECT_NEAR(load * s.u, power, 1e-12 * s.f.norm() * velocity.norm());
}


TEST(Coupling, SpreadingConservesTotalForce)
{
  // The constant velocity is in the space but for the walls, where it is constrained to zero; no point of this shell is in a cell at a wall.
  Scene            s;
  FluidBlockVector load;
  s.space->reinit(load);
  s.coupling.spread(s.f, load);
  const FluidVector &forces = load.block(velocity_block);
  for (unsigned int c = 0; c < 3; ++c)
    {
      double total = 0.;
      for (unsigned int node = 0; node < s.space->velocity->n_owned(); ++node)
        total += forces.local_element(3 * node + c);
      EXPECT_NEAR(dealii::Utilities::MPI::sum(total, MPI_COMM_WORLD), s.f.col(c).sum(), 1e-11 * s.f.norm());
    }
}


TEST(Coupling, MotionOfPointsIsTheDerivative)
{
  Scene                                  s;
  std::mt19937                           same_everywhere(11);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  const ControlPoints                    dx       = ControlPoints::NullaryExpr(s.x.rows(), 3, [&]() { return uniform(same_everywhere); });
  const auto                             power_at = [&](const ControlPoints &x) {
    s.coupling.move(x);
    return s.f.cwiseProduct(s.coupling.interpolate(s.u)).sum();
  };
  const double epsilon  = 1e-6;
  const double expected = (power_at(s.x + epsilon * dx) - power_at(s.x - epsilon * dx)) / (2. * epsilon);
  s.coupling.move(s.x);

  FluidBlockVector load;
  s.space->reinit(load);
  s.coupling.spread_with_motion(ControlPoints::Zero(s.x.rows(), 3), dx, s.coupling.density(s.f), load);
  const double scale = std::abs(expected) + 1.;
  EXPECT_NEAR(load * s.u, expected, 1e-5 * scale);

  SparseMatrix gamma;
  for (unsigned int call = 0; call < 2; ++call) // the second into the same matrix
    s.coupling.gradient_matrix(s.coupling.velocity_gradients(s.u), gamma);
  const ControlPoints   g        = s.coupling.density(s.f);
  const Eigen::VectorXd gamma_dx = gamma * Eigen::Map<const Eigen::VectorXd>(dx.data(), dx.size());
  EXPECT_NEAR(Eigen::Map<const Eigen::VectorXd>(g.data(), g.size()).dot(gamma_dx), expected, 1e-5 * scale);
}


TEST(Coupling, InterpolatesLinearVelocitiesExactly)
{
  // u = (z, 0, 0) at the nodes off the walls: in every cell that the shell cuts it is the linear field, which the surface reproduces, so J u is u at the control points.
  Scene s;
  s.u                          = nodal_velocity(*s.space, [](const dealii::Point<3> &x) { return std::array<double, 3>{{x[2], 0., 0.}}; });
  const ControlPoints velocity = s.coupling.interpolate(s.u);
  EXPECT_LT((velocity.col(0) - s.x.col(2)).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT(velocity.rightCols(2).cwiseAbs().maxCoeff(), 1e-14);
}


TEST(Coupling, DensityIsTheForceOverTheMass)
{
  Scene               s;
  const ControlPoints g = s.coupling.density(s.f);
  EXPECT_GT(g.norm(), s.f.norm());
  EXPECT_LT((s.coupling.mass() * g - s.f).norm(), 1e-12 * s.f.norm());
}


TEST(Coupling, SameOnAnyNumberOfRanks)
{
  Scene               together, alone(MPI_COMM_SELF);
  const Waves         waves(4.);
  const auto          u = nodal_velocity(*together.space, waves), all_u = nodal_velocity(*alone.space, waves);
  const ControlPoints moments = together.coupling.velocity_moments(u), all_moments = alone.coupling.velocity_moments(all_u);
  EXPECT_GT(all_moments.norm(), 0.1);
  EXPECT_LT((moments - all_moments).norm(), 1e-12 * all_moments.norm());
  EXPECT_LT((together.coupling.interpolate(u) - alone.coupling.interpolate(all_u)).norm(), 1e-12 * alone.coupling.interpolate(all_u).norm());

  SparseMatrix gamma, all_gamma;
  together.coupling.gradient_matrix(together.coupling.velocity_gradients(u), gamma);
  alone.coupling.gradient_matrix(alone.coupling.velocity_gradients(all_u), all_gamma);
  EXPECT_LT((gamma - all_gamma).norm(), 1e-12 * all_gamma.norm());

  const ControlPoints dx = ControlPoints::Ones(alone.x.rows(), 3) - 0.3 * alone.x, g = alone.coupling.density(alone.f);
  for (const bool motion : {false, true})
    {
      FluidBlockVector load, all_load;
      together.space->reinit(load);
      alone.space->reinit(all_load);
      if (motion)
        together.coupling.spread_with_motion(together.f, dx, g, load);
      else
        together.coupling.spread(together.f, load);
      if (motion)
        alone.coupling.spread_with_motion(alone.f, dx, g, all_load);
      else
        alone.coupling.spread(alone.f, all_load);
      EXPECT_NEAR(load.l2_norm(), all_load.l2_norm(), 1e-12 * all_load.l2_norm());
      for (const double phase : {0., 0.7, 1.9})
        {
          const auto v = nodal_velocity(*together.space, Waves(4., phase)), w = nodal_velocity(*alone.space, Waves(4., phase));
          EXPECT_NEAR(load * v, all_load * w, 1e-12 * all_load.l2_norm() * w.l2_norm());
        }
    }
}


TEST(Coupling, QuadratureFollowsTheFluidCell)
{
  const FittedShape shape = make_capsule({}, 2);
  EXPECT_EQ(coupling_quadrature(shape.topology, shape.control_points, Interface::plain, 0.5).weights.size(), 3);
  std::size_t last = 3;
  for (const double h : {0.25, 0.125, 0.0625})
    for (const Interface interface : {Interface::plain, Interface::enriched})
      {
        const TriangleQuadrature rule = coupling_quadrature(shape.topology, shape.control_points, interface, h);
        const SubdivisionSurface surface(shape.topology, rule, Derivatives::first);
        EXPECT_LE(std::sqrt(area_weights(surface, shape.control_points).mean()), (interface == Interface::plain ? 0.5 : 0.3) * h);
        EXPECT_GE(std::size_t(rule.weights.size()), last);
        last = rule.weights.size();
      }
}
