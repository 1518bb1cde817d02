// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: from the parameters of a run to its scene.

#ifndef tanktread_simulation_scene_description_h
#define tanktread_simulation_scene_description_h

#include <tanktread/simulation/parameters.h>
#include <tanktread/solver/scene.h>

namespace tanktread
{
  /** What the parameters say about the scene. Throws InputError where make_capsule() does. */
  SceneDescription
  scene_description(const Parameters &parameters);

  /**
   * Throws InputError for what only the shapes themselves tell: capsules larger than the box, beyond its faces, too near to images of themselves or
   * overlapping, shells too thick for their curvature.
   */
  void
  check_scene(const Parameters &parameters);
} // namespace tanktread

#endif
