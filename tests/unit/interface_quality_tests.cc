// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of how much of a shell the enriched interface sees.

#include <gtest/gtest.h>
#include <tanktread/coupling/interface_quality.h>

#include "small_scene.h"

#include <cstdio>

using namespace tanktread;

namespace
{
  StartedScene
  scene(const CapsuleShapeParameters &capsule, const double finest_cell)
  {
    SceneDescription result    = small_scene({5., 0.}, 1., capsule, tight(1e-6, 1e-3, Interface::enriched), 10., finest_cell);
    result.places[0].centre[2] = 0.3; // the middle of a coarse cell, in which both sheets of a thin capsule lie then
    return StartedScene(std::move(result));
  }

  InterfaceQuality
  quality(StartedScene &scene)
  {
    scene.level().move_points(scene.state);
    return interface_quality(scene.coupling())[0];
  }

  CapsuleShapeParameters
  oblate(const double aspect_ratio)
  {
    CapsuleShapeParameters result;
    result.shape        = Shape::oblate;
    result.aspect_ratio = aspect_ratio;
    return result;
  }
} // namespace


TEST(InterfaceQuality, OfASphereIsNearlyPerfect)
{
  for (const double h : {0.625, 0.3125})
    {
      StartedScene           sphere = scene({}, h);
      const InterfaceQuality q      = quality(sphere);
      if (is_root())
        std::printf("sphere, cells of %.4f a: %.2e without jumps, %.2e folded\n", h, q.without_jumps, q.folded);
      EXPECT_LT(q.without_jumps, 0.01);
      EXPECT_EQ(q.folded, 0.);
    }
}


TEST(InterfaceQuality, SheetsThatAreNearerThanACellAreSeen)
{
  StartedScene           thin = scene(oblate(0.15), 0.625), resolved = scene(oblate(0.15), 0.15625);
  const InterfaceQuality coarse = quality(thin), fine = quality(resolved);
  if (is_root())
    std::printf("oblate 0.15, folded: %.3f with cells of 0.625 a, %.3f with 0.156 a\n", coarse.folded, fine.folded);
  EXPECT_GT(coarse.folded, 0.2);
  EXPECT_LT(fine.folded, 0.25 * coarse.folded);
}


TEST(InterfaceQuality, PartsThatHaveLeftTheFinestCellsAreWithoutJumps)
{
  StartedScene sphere = scene({}, 0.15625);
  EXPECT_LT(quality(sphere).without_jumps, 0.01);
  sphere.state.capsules[0].x.col(0).array() += 0.9;
  const double share = quality(sphere).without_jumps;
  if (is_root())
    std::printf("moved by 0.9 a: %.3f without jumps\n", share);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 1.);
  EXPECT_GT(sphere.coupling().jumps().n_coarse_cut_cells(), 0u);
}
