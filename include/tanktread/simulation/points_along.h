// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: control points that move along the shells, step by step.

#ifndef tanktread_simulation_points_along_h
#define tanktread_simulation_points_along_h

#include <tanktread/shell/even_mesh.h>
#include <tanktread/solver/scene.h>

#include <vector>

namespace tanktread
{
  /** What a step needs so that control points move along the shells beside the material, see EvenMesh and doc/theory.md, section 5.4. */
  class PointsAlong
  {
  public:
    /** Longest step, in mu a^2 R / kappa_B, R the smallest radius of curvature; measured on a sphere, 0.2 is too long. */
    static constexpr double longest_step_factor = 0.1;

    /** Keeps `scene` by reference. */
    explicit PointsAlong(const Scene &scene);

    /** The velocity of the material at the level from which the step goes. */
    void
    begin_step(ShellFields velocity)
    {
      velocity_ = std::move(velocity);
    }

    /** How fast control points of the rank's own shells near `shells` are to move along them in a step of `length`. Throws NumericalError where a shell is degenerate. */
    ShellFields
    velocity(const ShellConfigurations &shells, double length) const;

    /** The same on all ranks; infinite without bending. Collective. */
    static double
    longest_step(const Scene &scene, const State &state);

  private:
    const Scene          &scene_;
    std::vector<EvenMesh> even_meshes_; // of the kinds of capsules
    ShellFields           velocity_;
  };

  /** Unit vectors along m at the control points. */
  ShellFields
  unit_normals(const ShellConfigurations &shells);
} // namespace tanktread

#endif
