// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules held by one team each give what they give where all ranks hold all of them.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/simulation/capsule_moves.h>
#include <tanktread/solver/team_choice.h>

#include <cmath>
#include <numeric>

#include "small_scene.h"

using namespace tanktread;

namespace
{
  /** Four ellipsoids, two of them in the same cells, one across a periodic face. */
  SceneDescription
  four(const Interface interface, const unsigned int n_teams)
  {
    SceneDescription result = small_scene({5., 0.2}, 1., ellipsoid(1.2, 1., 0.8), tight(1e-8, 1e-8, interface), 10.);
    result.n_teams          = n_teams;
    result.places           = {Eigen::RowVector3d(-0.613, 0.131, 1.122),
                               Eigen::RowVector3d(0.713, -0.231, -0.952),
                               Eigen::RowVector3d(4.813, 3.131, -2.122),
                               Eigen::RowVector3d(-3.013, -3.231, 2.322)};
    return result;
  }

  /** Forces that tell the capsules apart. */
  ShellFields
  forces(const Scene &scene, const State &state)
  {
    ShellFields result;
    for (unsigned int i = 0; i < state.capsules.size(); ++i)
      {
        const double        k = 1. + 0.3 * scene.layout().own()[i];
        const ControlPoints x = state.capsules[i].x;
        result.push_back((k * x).array().sin().matrix());
      }
    return result;
  }

  FluidBlockVector
  flow(const Scene &scene, const TaylorHoodSpace &space)
  {
    FluidBlockVector result;
    space.reinit(result);
    for (unsigned int b = 0; b < 2; ++b)
      for (unsigned int i = 0; i < result.block(b).locally_owned_size(); ++i)
        result.block(b).local_element(i) = std::sin(0.37 * i + b + scene.layout().rank());
    return result;
  }
} // namespace


TEST(ShellGuests, CapsulesOfTeamsGiveWhatCapsulesOfAllRanksGive)
{
  for (const Interface interface : {Interface::plain, Interface::enriched})
    {
      StartedScene teams(four(interface, 0)), all(four(interface, 1));
      teams.move_points();
      all.move_points();
      const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      EXPECT_EQ(teams.layout().n_teams(), std::min(4u, n_ranks));
      EXPECT_EQ(all.layout().n_own(), 4u);
      if (n_ranks > 1)
        {
          EXPECT_LT(teams.layout().n_own(), 4u);
        }

      const ShellFields f = forces(teams, teams.state), f_all = forces(all, all.state);
      FluidBlockVector  load, load_of_all;
      teams.fluid().space().reinit(load);
      all.fluid().space().reinit(load_of_all);
      teams.coupling().spread(f, load);
      all.coupling().spread(f_all, load_of_all);
      const double scale = load_of_all.l2_norm();
      load -= load_of_all;
      EXPECT_GT(scale, 0.1);
      EXPECT_LT(load.l2_norm(), 1e-12 * scale);

      const FluidBlockVector u                  = flow(all, all.fluid().space());
      const ShellFields      velocity           = teams.coupling().interpolate(u, f);
      const ShellFields      of_all             = all.coupling().interpolate(u, f_all);
      const auto             undisturbed        = teams.coupling().undisturbed_velocity(plane_poiseuille(5.), teams.level().shells(teams.state));
      const auto             undisturbed_of_all = all.coupling().undisturbed_velocity(plane_poiseuille(5.), all.level().shells(all.state));
      for (unsigned int i = 0; i < velocity.size(); ++i)
        {
          const unsigned int c = teams.layout().own()[i];
          EXPECT_LT((velocity[i] - of_all[c]).norm(), 1e-11 * of_all[c].norm());
          EXPECT_LT((undisturbed[i] - undisturbed_of_all[c]).norm(), 1e-11 * undisturbed_of_all[c].norm());
        }
      const ShellGap gap = teams.gap(teams.state), gap_of_all = all.gap(all.state);
      EXPECT_EQ(gap.gap, gap_of_all.gap);
      EXPECT_EQ(gap.first, gap_of_all.first);
      EXPECT_EQ(gap.second, gap_of_all.second);
    }
}


TEST(CapsuleMoves, ThingsComeToTheNewTeamsInOrder)
{
  StartedScene       scene(four(Interface::plain, 0));
  const ShellLayout &layout  = scene.layout();
  const unsigned int n_teams = layout.n_teams();
  for (unsigned int turn = 1; turn <= 4; ++turn)
    {
      std::vector<unsigned int> team_of;
      for (unsigned int c = 0; c < 4; ++c)
        team_of.push_back((layout.team_of(c) * turn + c) % n_teams);
      for (unsigned int i = 0; i < layout.n_own(); ++i)
        scene.state.capsules[i].pressure_jump = 7. + layout.own()[i];
      const CapsuleMoves moves(layout, team_of);
      scene.state.capsules = moves.moved(scene.state.capsules);
      scene.reassign(team_of);
      ASSERT_EQ(scene.state.capsules.size(), layout.n_own());
      for (unsigned int i = 0; i < layout.n_own(); ++i)
        {
          const unsigned int c = layout.own()[i];
          EXPECT_EQ(layout.team_of(c), team_of[c]);
          EXPECT_EQ(scene.state.capsules[i].pressure_jump, 7. + c);
          EXPECT_EQ(scene.state.capsules[i].x, placed(scene.capsules()[c].initial(), scene.description().places[c]));
        }
    }
}


TEST(TeamChoice, CapsulesGoWhereTheirPointsAreAndTeamsAreLevel)
{
  const std::vector<double> work(4, 1.);
  using Teams = std::vector<unsigned int>;
  // Where they are.
  EXPECT_EQ(chosen_teams(work, {0, 0, 0, 0}, 2, {{0, 1, 9.}, {1, 0, 9.}, {2, 0, 9.}, {3, 1, 9.}}), (Teams{1, 0, 0, 1}));
  // No team gets all of them: the ones with the most points there stay.
  EXPECT_EQ(chosen_teams(work, {0, 0, 0, 0}, 2, {{0, 0, 9.}, {1, 0, 6.}, {2, 0, 8.}, {3, 0, 5.}}), (Teams{0, 1, 0, 1}));
  // A capsule on the border stays where it is.
  EXPECT_EQ(chosen_teams({1., 1.}, {1, 0}, 2, {{0, 0, 6.}, {0, 1, 5.}, {1, 0, 5.}, {1, 1, 6.}}), (Teams{1, 0}));
  // As many teams as capsules: one each, wherever they are.
  const Teams one_each = chosen_teams({1., 1., 1.}, {0, 1, 2}, 3, {{0, 2, 5.}, {1, 2, 9.}, {2, 2, 5.}});
  EXPECT_EQ(std::accumulate(one_each.begin(), one_each.end(), 0u), 3u);
  EXPECT_EQ(one_each[1], 2u);
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
