// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about spreading and interpolation.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/solver/scene.h>
#include <tanktread/surface/surface_geometry.h>

#include <random>

#include "nodal_velocity.h"

using namespace tanktread;

namespace
{
  /** A shell that crosses the periodic face x = 2, a velocity and forces that are not smooth at all. */
  struct Example
  {
    explicit Example(const MPI_Comm communicator = MPI_COMM_WORLD)
      : scene(description(), communicator)
      , coupling(scene.coupling())
    {
      State state = scene.initial_state();
      state.capsules[0].x.col(2) *= 0.8;
      // Off the planes of symmetry: there points lie on faces of cells, across which velocity gradients jump.
      state.capsules[0].x.rowwise() += Eigen::RowVector3d(1.3 + 0.00137, 0.00271, 0.00314);
      x = state.capsules[0].x;
      scene.refine_around(state);
      move(x);
      space().reinit(u);
      std::mt19937                     random(7 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
      std::normal_distribution<double> normal;
      for (double &number : u.block(velocity_block))
        number = normal(random);
      std::mt19937 same_everywhere(3);
      normal.reset(); // numbers are made in pairs: where a rank has drawn an odd number of them, the next would be left from above
      f.resizeLike(x);
      for (Eigen::Index i = 0; i < f.size(); ++i)
        f.data()[i] = normal(same_everywhere);
    }

    static SceneDescription
    description()
    {
      SceneDescription result;
      result.box                      = 4.;
      result.kinds[0].shape           = make_capsule({}, 2);
      result.fluid_mesh.coarsest_cell = 1.;
      result.fluid_mesh.finest_cell   = 0.25;
      result.solver.interface         = Interface::plain;
      return result;
    }

    void
    move(const ControlPoints &to)
    {
      coupling.move(shell_configurations(scene.capsule(), {to}));
    }
    const TaylorHoodSpace &
    space()
    {
      return scene.fluid().space();
    }
    ControlPoints
    interpolated(const FluidBlockVector &v) const
    {
      return coupling.interpolate(v)[0];
    }

    Scene            scene;
    Coupling        &coupling;
    ControlPoints    x, f;
    FluidBlockVector u;
  };
} // namespace


TEST(Coupling, PowerOfShellIsPowerReceivedByFluid)
{
  Example          s;
  FluidBlockVector load;
  s.space().reinit(load);
  s.coupling.spread({s.f}, load);
  const ControlPoints velocity = s.interpolated(s.u);
  const double        power    = s.f.cwiseProduct(velocity).sum();
  EXPECT_GT(std::abs(power), 1e-3);
  EXPECT_NEAR(load * s.u, power, 1e-12 * s.f.norm() * velocity.norm());
}


TEST(Coupling, SpreadingConservesTotalForce)
{
  // The constant velocity is in the space but for the walls, where it is constrained to zero; no point of this shell is in a cell at a wall.
  Example          s;
  FluidBlockVector load;
  s.space().reinit(load);
  s.coupling.spread({s.f}, load);
  const FluidVector &forces = load.block(velocity_block);
  for (unsigned int c = 0; c < 3; ++c)
    {
      double total = 0.;
      for (unsigned int node = 0; node < s.space().velocity->n_owned(); ++node)
        total += forces.local_element(3 * node + c);
      EXPECT_NEAR(dealii::Utilities::MPI::sum(total, MPI_COMM_WORLD), s.f.col(c).sum(), 1e-11 * s.f.norm());
    }
}


TEST(Coupling, MotionOfPointsIsTheDerivative)
{
  Example                                s;
  std::mt19937                           same_everywhere(11);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  const ControlPoints                    dx       = ControlPoints::NullaryExpr(s.x.rows(), 3, [&]() { return uniform(same_everywhere); });
  const auto                             power_at = [&](const ControlPoints &x) {
    s.move(x);
    return s.f.cwiseProduct(s.interpolated(s.u)).sum();
  };
  const double epsilon  = 1e-6;
  const double expected = (power_at(s.x + epsilon * dx) - power_at(s.x - epsilon * dx)) / (2. * epsilon);
  s.move(s.x);

  FluidBlockVector load;
  s.space().reinit(load);
  s.coupling.spread_with_motion({ControlPoints::Zero(s.x.rows(), 3)}, {dx}, s.coupling.density({s.f}), load);
  const double scale = std::abs(expected) + 1.;
  EXPECT_NEAR(load * s.u, expected, 1e-5 * scale);

  const SparseMatrix    gamma    = s.coupling.gradient_matrices(s.coupling.shells(), {}, &s.u)[0];
  const ControlPoints   g        = s.coupling.density({s.f})[0];
  const Eigen::VectorXd gamma_dx = gamma * Eigen::Map<const Eigen::VectorXd>(dx.data(), dx.size());
  EXPECT_NEAR(Eigen::Map<const Eigen::VectorXd>(g.data(), g.size()).dot(gamma_dx), expected, 1e-5 * scale);
}


TEST(Coupling, InterpolatesLinearVelocitiesExactly)
{
  // u = (z, 0, 0) at the nodes off the walls: in every cell that the shell cuts it is the linear field, which the surface reproduces, so J u is u at the
  // control points.
  Example s;
  s.u                          = nodal_velocity(s.space(), [](const dealii::Point<3> &x) { return std::array<double, 3>{{x[2], 0., 0.}}; });
  const ControlPoints velocity = s.interpolated(s.u);
  EXPECT_LT((velocity.col(0) - s.x.col(2)).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT(velocity.rightCols(2).cwiseAbs().maxCoeff(), 1e-14);
}


TEST(Coupling, DensityIsTheForceOverTheMass)
{
  Example             s;
  const ControlPoints g = s.coupling.density({s.f})[0];
  EXPECT_GT(g.norm(), s.f.norm());
  EXPECT_LT((s.scene.capsule().mass() * g - s.f).norm(), 1e-12 * s.f.norm());
}


TEST(Coupling, SameOnAnyNumberOfRanks)
{
  Example             together, alone(MPI_COMM_SELF);
  const Waves         waves(4.);
  const auto          u = nodal_velocity(together.space(), waves), all_u = nodal_velocity(alone.space(), waves);
  const ControlPoints moments = together.coupling.velocity_moments(u)[0], all_moments = alone.coupling.velocity_moments(all_u)[0];
  EXPECT_GT(all_moments.norm(), 0.1);
  EXPECT_LT((moments - all_moments).norm(), 1e-12 * all_moments.norm());
  EXPECT_LT((together.interpolated(u) - alone.interpolated(all_u)).norm(), 1e-12 * alone.interpolated(all_u).norm());

  const SparseMatrix gamma     = together.coupling.gradient_matrices(together.coupling.shells(), {}, &u)[0];
  const SparseMatrix all_gamma = alone.coupling.gradient_matrices(alone.coupling.shells(), {}, &all_u)[0];
  EXPECT_LT((gamma - all_gamma).norm(), 1e-12 * all_gamma.norm());

  const ControlPoints dx = ControlPoints::Ones(alone.x.rows(), 3) - 0.3 * alone.x, g = alone.coupling.density({alone.f})[0];
  for (const bool motion : {false, true})
    {
      FluidBlockVector load, all_load;
      together.space().reinit(load);
      alone.space().reinit(all_load);
      if (motion)
        together.coupling.spread_with_motion(together.coupling.density({together.f}), {dx}, {g}, load);
      else
        together.coupling.spread({together.f}, load);
      if (motion)
        alone.coupling.spread_with_motion({g}, {dx}, {g}, all_load);
      else
        alone.coupling.spread({alone.f}, all_load);
      EXPECT_NEAR(load.l2_norm(), all_load.l2_norm(), 1e-12 * all_load.l2_norm());
      for (const double phase : {0., 0.7, 1.9})
        {
          const auto v = nodal_velocity(together.space(), Waves(4., phase)), w = nodal_velocity(alone.space(), Waves(4., phase));
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
