// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: control points that move along the shells, step by step.

#include <deal.II/base/mpi.h>

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


  ShellFields
  PointsAlong::velocity(const ShellConfigurations &shells, const double length) const
  {
    ShellFields result;
    for (std::size_t c = 0; c < shells.size(); ++c)
      result.push_back(even_mesh_.velocity(*shells[c], velocity_[c], 1. / (steps_to_relax * length)));
    return result;
  }


  double
  PointsAlong::longest_step(const Scene &scene, const State &state)
  {
    const double bending_modulus = scene.description().moduli.bending_modulus;
    double       radius          = std::numeric_limits<double>::infinity();
    if (bending_modulus == 0.)
      return radius;
    for (const CapsuleState &capsule : state.capsules)
      radius = std::min(radius, smallest_radius_of_curvature(scene.capsule().surface(), capsule.x));
    return longest_step_factor * dealii::Utilities::MPI::broadcast(scene.communicator(), radius, 0) / bending_modulus;
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
