// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: control points that move along the shells, step by step.

#include <tanktread/simulation/points_along.h>
#include <tanktread/surface/mesh_quality.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace tanktread
{
  namespace
  {
    /** In so many steps unevenness falls by 1/e: slow enough for a velocity that is the same in the whole step. */
    constexpr double steps_to_relax = 5.;
  } // namespace


  PointsAlong::PointsAlong(const Scene &scene)
    : scene_(scene)
  {
    for (unsigned int k = 0; k < scene.capsules().n_kinds(); ++k)
      even_meshes_.emplace_back(scene.capsules().kind(k));
  }


  ShellFields
  PointsAlong::velocity(const ShellConfigurations &shells, const double length) const
  {
    ShellFields result;
    for (std::size_t c = 0; c < shells.size(); ++c)
      result.push_back(even_meshes_[scene_.capsules().kind_of(scene_.layout().own()[c])].velocity(*shells[c], velocity_[c], 1. / (steps_to_relax * length)));
    return result;
  }


  double
  PointsAlong::longest_step(const Scene &scene, const State &state)
  {
    double result = std::numeric_limits<double>::infinity();
    for (unsigned int i = 0; i < state.capsules.size(); ++i)
      if (const double bending_modulus = scene.description().kind(scene.layout().own()[i]).moduli.bending_modulus; bending_modulus > 0.)
        result = std::min(result, longest_step_factor * smallest_radius_of_curvature(scene.capsule(i).surface(), state.capsules[i].x) / bending_modulus);
    return -scene.layout().max(-result);
  }


  ShellFields
  unit_normals(const ShellConfigurations &shells)
  {
    ShellFields result;
    for (const std::shared_ptr<const ShellConfiguration> &shell : shells)
      result.push_back(shell->normal_field().rowwise().normalized());
    return result;
  }
} // namespace tanktread
