// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: shells that share arrays because they are far from each other do not notice.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <oracle/given_forces.h>
#include <oracle/node_values.h>

#include <algorithm>
#include <cmath>
#include <utility>

using namespace tanktread;

namespace
{
  constexpr double finest_cell = 10. / 32., side = 10.;

  using Centres = std::vector<Eigen::RowVector3d>;

  /** Spheres of radius 1 in a box of 10a, whose forces and flows depend on positions alone. */
  struct Spheres : oracle::GivenForces
  {
    explicit Spheres(const Centres &centres, const double viscosity_ratio = 1.)
      : GivenForces(make_capsule({}, 2), Interface::enriched, side, {finest_cell, 2.5, 1.5}, centres, {viscosity_ratio, simple_shear(1.)})
    {}

    /** Of a velocity that is not smooth at all, the same at the same nodes of all meshes. */
    FluidBlockVector
    rough_flow() const
    {
      FluidBlockVector result;
      fluid.space().reinit(result);
      oracle::set_rough(fluid.mesh(), *fluid.space().velocity, 3, result.block(velocity_block));
      return result;
    }

    ShellFields
    waves(const double k) const
    {
      ShellFields result;
      for (unsigned int c = 0; c < shells.size(); ++c)
        result.push_back(nodal_forces(oracle::waves(X(c), k), c));
      return result;
    }

    ShellConfigurations
    moved(const Centres &by) const
    {
      ShellConfigurations result;
      for (unsigned int c = 0; c < shells.size(); ++c)
        result.push_back(std::make_shared<ShellConfiguration>(scene.capsule(), shells[c]->x().rowwise() + by[c]));
      return result;
    }

    unsigned int
    n_colours() const
    {
      return coupling.jumps().colours().size();
    }
  };


  double
  difference(const ControlPoints &f, const ControlPoints &g)
  {
    return (f - g).norm() / g.norm();
  }


  /** Two near pairs, half the box from each other in y. */
  Centres
  two_pairs()
  {
    const Eigen::RowVector3d a(-1.013, -2.469, -0.122), b = a + (2. + 0.3 * finest_cell) * Eigen::RowVector3d(1., 0.17, 0.29).normalized(),
                                                        across(0., 0.5 * side, 0.);
    return {a, b, a + across, b + across};
  }


  /** Two whose boxes are just farther from each other than the margin, six cells, and steps by which they come nearer than that. */
  const Centres just_far = {{-2.013, 0.031, -0.122}, {-2.013 + 2. + 6. * finest_cell + 0.03, 0.231, 0.157}},
                towards  = {{0.09, 0.02, 0.01}, {-0.08, 0.01, 0.03}};
} // namespace


TEST(ShellJumps, ShellsOfAColourMoveAsWithoutEachOther)
{
  for (const double viscosity_ratio : {1., 5.})
    {
      const Spheres all(two_pairs(), viscosity_ratio);
      EXPECT_EQ(all.n_colours(), 2u);
      const ShellFields f = all.waves(2.), velocity = all.coupling.interpolate(all.rough_flow(), f);
      for (const unsigned int first : {0, 2})
        {
          const Spheres     pair({two_pairs()[first], two_pairs()[first + 1]}, viscosity_ratio);
          const ShellFields wanted = pair.coupling.interpolate(pair.rough_flow(), pair.waves(2.));
          for (unsigned int c = 0; c < 2; ++c)
            EXPECT_LT(difference(velocity[first + c], wanted[c]), 1e-11);
        }
    }
}


TEST(ShellJumps, PowerOfShellsThatShareColoursIsThatReceivedByTheFluid)
{
  const Spheres     all(two_pairs(), 5.);
  const ShellFields f = all.waves(2.);
  FluidBlockVector  load, fields = all.rough_flow();
  oracle::set_rough(all.fluid.mesh(), *all.fluid.space().pressure, 5, fields.block(pressure_block));
  all.fluid.space().reinit(load);
  all.coupling.spread(f, load);
  const ShellFields velocity = all.coupling.interpolate(fields);
  double            power = 0., scale = 0.;
  for (unsigned int c = 0; c < 4; ++c)
    {
      power += f[c].cwiseProduct(velocity[c]).sum();
      scale += f[c].norm() * velocity[c].norm();
    }
  EXPECT_NEAR(power, load * fields, 1e-12 * scale);
}


TEST(ShellJumps, ViscousForcesStayWithTheirShellsWhenColoursChange)
{
  // Made where both have one colour, used where they have two, beside each sphere alone.
  const auto velocities = [](const Centres &centres, const Centres &steps, const bool update, const unsigned int n_colours) {
    Spheres           scene(centres, 5.);
    const ShellFields g = scene.coupling.density(scene.waves(2.));
    EXPECT_EQ(scene.n_colours(), 1u);
    if (update)
      scene.coupling.update_viscous_forces(scene.rough_flow(), g);
    scene.coupling.move(scene.moved(steps));
    EXPECT_EQ(scene.n_colours(), n_colours);
    ExtendedForces forces;
    scene.coupling.extend_whole(g, forces);
    FluidBlockVector zero;
    scene.fluid.space().reinit(zero);
    return scene.coupling.interpolate(zero, forces);
  };
  const ShellFields both = velocities(just_far, towards, true, 2), without = velocities(just_far, towards, false, 2);
  for (unsigned int c = 0; c < 2; ++c)
    {
      EXPECT_GT(difference(both[c], without[c]), 0.01);
      EXPECT_LT(difference(both[c], velocities({just_far[c]}, {towards[c]}, true, 1)[0]), 1e-11);
    }
}


TEST(ShellJumps, PressureTakesTheJumpsOfTheShellsAlong)
{
  // f_n = cos of the angle with e: what is added at a vertex that has changed sides is that, and nothing elsewhere, whatever the colours before and after.
  const Eigen::RowVector3d e = Eigen::RowVector3d(1., 0.3, -0.2).normalized();
  const auto change          = [&](const Centres &centres, const Centres &steps, std::vector<Eigen::RowVector3d> &places, const std::vector<double> &factors) {
    Spheres     scene(centres);
    VertexSides sides;
    ShellFields f;
    for (unsigned int c = 0; c < centres.size(); ++c)
      {
        const ControlPoints n = scene.X(c).rowwise() - centres[c];
        f.push_back(factors[c] * scene.nodal_forces((n * e.transpose()).asDiagonal() * n, c));
      }
    FluidBlockVector fields;
    scene.fluid.space().reinit(fields);
    scene.coupling.carry_pressure(f, sides, fields);
    EXPECT_EQ(fields.l2_norm(), 0.);
    scene.coupling.move(scene.moved(steps));
    scene.coupling.carry_pressure(f, sides, fields);
    places.clear();
    for (const dealii::Point<3> &x : oracle::node_positions(scene.fluid.mesh(), *scene.fluid.space().pressure))
      places.push_back({x[0], x[1], x[2]});
    return fields.block(pressure_block);
  };
  std::vector<Eigen::RowVector3d> places;
  const std::vector<double>       factors      = {1., 3.};
  const FluidVector               p            = change(just_far, towards, places, factors);
  unsigned int                    n_changed[2] = {0, 0};
  for (unsigned int i = 0; i < places.size(); ++i)
    {
      double wanted = 0., error = 0.;
      for (unsigned int c = 0; c < 2; ++c)
        {
          const Eigen::RowVector3d from = places[i] - just_far[c], to = from - towards[c];
          const int                turn = (from.norm() < 1.) - (to.norm() < 1.);
          // The sphere is that of the points but for their error.
          error += std::min(std::abs(from.norm() - 1.), std::abs(to.norm() - 1.)) < 2e-3 ? 10. : 0.;
          wanted += turn * factors[c] * to.dot(e) / to.norm();
          n_changed[c] += turn != 0;
        }
      EXPECT_NEAR(p.local_element(i), wanted, wanted != 0. ? 0.3 * factors[1] + error : error);
    }
  for (const unsigned int n : n_changed)
    EXPECT_GT(dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD), 10u);
  // Numbered the other way round all is the same.
  const FluidVector q = change({just_far[1], just_far[0]}, {towards[1], towards[0]}, places, {factors[1], factors[0]});
  for (unsigned int i = 0; i < places.size(); ++i)
    EXPECT_NEAR(p.local_element(i), q.local_element(i), 1e-13);
}


TEST(ShellJumps, ShellsThatAreToldToBeFarAndAreNotAreNoticed)
{
  Spheres                         scene({just_far[0], just_far[0] + Eigen::RowVector3d(2. + 0.3 * finest_cell, 0., 0.)});
  ShellJumps                      jumps(scene.fluid.space(), {}, 2);
  PointInterpolation              points(scene.fluid.space());
  std::vector<ShellTransfer>      transfers;
  const std::vector<ShellBox>     boxes = {shell_box(scene.X(0)), shell_box(scene.X(1))}, wrong = {boxes[0], {{{3., 3., 3.}}, {{4., 4., 4.}}}};
  const std::vector<unsigned int> numbers = {0, 1};
  for (unsigned int c = 0; c < 2; ++c)
    {
      transfers.emplace_back(scene.scene.capsule(), c * scene.coupling_surface.n_points());
    }
  points.reinit(Coupling::points(scene.shells));
  for (unsigned int c = 0; c < 2; ++c)
    transfers[c].move(scene.shells[c], points);
  EXPECT_NO_THROW(jumps.move(transfers, numbers, boxes, points));
  EXPECT_THROW(jumps.move(transfers, numbers, wrong, points), std::logic_error);
}
