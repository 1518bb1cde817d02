// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of finest cells that follow the films between shells, and shell and wall.

#include <gtest/gtest.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/fluid/film_cells.h>

#include "nodal_velocity.h"
#include "small_scene.h"

#include <cmath>
#include <limits>

using namespace tanktread;

namespace
{
  constexpr double none = std::numeric_limits<double>::infinity();
}


TEST(FilmCells, TwoFitIntoTheGap)
{
  EXPECT_EQ(film_halvings(none, 0.5, 4, 0), 0u);
  EXPECT_EQ(film_halvings(1., 0.5, 4, 0), 0u);
  EXPECT_EQ(film_halvings(0.99, 0.5, 4, 0), 1u);
  EXPECT_EQ(film_halvings(0.26, 0.5, 4, 0), 2u);
  EXPECT_EQ(film_halvings(0.24, 0.5, 4, 0), 3u);
  EXPECT_EQ(film_halvings(0.01, 0.5, 4, 0), 4u); // no smaller ones are allowed
  EXPECT_EQ(film_halvings(-0.1, 0.5, 4, 0), 4u);
  EXPECT_EQ(film_halvings(0.01, 0.5, 0, 0), 0u);
}


TEST(FilmCells, GrowBackWhenTheGapIsWiderByHalf)
{
  EXPECT_EQ(film_halvings(0.99, 0.5, 4, 1), 1u);
  EXPECT_EQ(film_halvings(1.49, 0.5, 4, 1), 1u);
  EXPECT_EQ(film_halvings(1.51, 0.5, 4, 1), 0u);
  EXPECT_EQ(film_halvings(0.76, 0.5, 4, 3), 1u);
  EXPECT_EQ(film_halvings(0.24, 0.5, 4, 1), 3u); // at once where it closes
  EXPECT_EQ(film_halvings(none, 0.5, 4, 4), 0u);
}


TEST(FilmCells, MeshHasTheLevelsBetweenBothSizes)
{
  const double        inf = none;
  FluidMeshParameters parameters{0.625, 1.25, 1.5};
  const FluidMesh     plain(MPI_COMM_WORLD, 10., parameters);
  EXPECT_FALSE(plain.follows_films());
  EXPECT_TRUE(plain.suits(0.01));
  parameters.finest_in_gaps = 0.15625; // one that the octree has
  FluidMesh mesh(MPI_COMM_WORLD, 10., parameters);
  EXPECT_TRUE(mesh.follows_films());
  EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.finest_level()), 0.625);
  EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.film_level()), 0.15625);
  EXPECT_FALSE(mesh.suits(0.7));
  mesh.choose_finest_level(0.7);
  EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.finest_level()), 0.3125);
  EXPECT_TRUE(mesh.suits(0.7));
  mesh.adapt({{0.1, 0.2, 0.3}});
  EXPECT_EQ(mesh.triangulation().n_global_levels(), mesh.finest_level() + 1);
  EXPECT_TRUE(mesh.covers({{0.1, 0.2, 0.3}}));
  mesh.choose_finest_level(inf);
  EXPECT_TRUE(mesh.adapt({{0.1, 0.2, 0.3}})); // the same points, other cells
  EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.triangulation().n_global_levels() - 1), 0.625);
  parameters.finest_in_gaps = 0.16; // never below
  EXPECT_EQ(FluidMesh(MPI_COMM_WORLD, 10., parameters).film_level(), mesh.film_level() - 1);
}


namespace
{
  /** The rank's own ones of two spheres with that gap between them along x. */
  ShellFields
  spheres(const StartedScene &scene, const double gap)
  {
    ShellFields result;
    for (const unsigned int c : scene.layout().own())
      result.push_back(scene.capsules()[c].initial().rowwise() + Eigen::RowVector3d((c == 0 ? -1. : 1.) * (1. + 0.5 * gap), 0.03, 0.02));
    return result;
  }

  SceneDescription
  pair()
  {
    SceneDescription result          = small_scene({5., 0.}, 0., {}, tight(1e-5, 1e-2, Interface::enriched), 10., 0.625);
    result.places                    = {Eigen::RowVector3d(-2., 0.03, 0.02), Eigen::RowVector3d(2., 0.03, 0.02)};
    result.fluid_mesh.finest_in_gaps = 0.15625;
    return result;
  }
} // namespace


TEST(FilmCells, SceneFollowsItsGapAndFlowsGoAlong)
{
  StartedScene scene(pair());
  EXPECT_DOUBLE_EQ(scene.level().finest_cell(), 0.625);
  const auto parabola = [](const dealii::Point<3> &x) {
    const double u = 1. - x[2] * x[2] / 25.;
    return std::array<double, 3>{{u, -2. * u, 0.5 * u}};
  };
  scene.state.fluid = nodal_velocity(scene.fluid().space(), parabola); // which all meshes have
  for (const auto &[gap, h] : {std::pair(0.7, 0.3125), std::pair(0.4, 0.15625), std::pair(0.3, 0.15625), std::pair(1., 0.3125), std::pair(2., 0.625)})
    {
      const ShellFields x = spheres(scene, gap);
      for (unsigned int i = 0; i < x.size(); ++i)
        scene.state.capsules[i].x = x[i];
      const double before = scene.level().finest_cell();
      if (h != before)
        {
          EXPECT_FALSE(scene.covers(scene.state));
        }
      const FieldTransfer transfer(scene.fluid().space(), {&scene.state.fluid});
      scene.refine_around(scene.state);
      transfer.interpolate(scene.fluid().space(), {&scene.state.fluid});
      EXPECT_DOUBLE_EQ(scene.level().finest_cell(), h) << "gap " << gap;
      EXPECT_TRUE(scene.covers(scene.state));
      FluidBlockVector difference = nodal_velocity(scene.fluid().space(), parabola);
      const double     norm       = difference.block(velocity_block).l2_norm();
      difference -= scene.state.fluid;
      EXPECT_LT(difference.block(velocity_block).l2_norm(), 1e-12 * norm);
    }
}


TEST(FilmCells, PositionsToComeCount)
{
  StartedScene scene(pair());
  scene.refine_around(scene.state, {spheres(scene, 0.7)}); // as in a step that ends there
  EXPECT_DOUBLE_EQ(scene.level().finest_cell(), 0.3125);
}


TEST(FilmCells, WallsHaveFilmsToo)
{
  SceneDescription near_a_wall = pair();
  near_a_wall.places           = {Eigen::RowVector3d(0.01, 0.03, 3.6)};
  EXPECT_DOUBLE_EQ(StartedScene(near_a_wall).level().finest_cell(), 0.15625); // a gap of 0.4
  near_a_wall.places = {Eigen::RowVector3d(0.01, 3.6, 0.03)};                 // periodic faces are no walls; the image is 8 a away
  EXPECT_DOUBLE_EQ(StartedScene(near_a_wall).level().finest_cell(), 0.625);
}
