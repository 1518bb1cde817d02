// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how near shells come to each other.

#ifndef tanktread_shell_gaps_h
#define tanktread_shell_gaps_h

#include <tanktread/shell/shell_configuration.h>

#include <array>
#include <limits>
#include <vector>

namespace tanktread
{
  /** The smallest gap between two shells of a scene, periodic images included. */
  struct ShellGap
  {
    double       gap   = std::numeric_limits<double>::infinity(); // distance in a; negative where they overlap
    unsigned int first = 0, second = 0;                           // numbers of the capsules; the same for a capsule and an image of itself
  };

  /**
   * Of all pairs of shells and their images by multiples of `periods` (infinite along axes without). Distances are those of the points of the coupling of one
   * shell from the nearest quadratic patch (or plane, without second
   * derivatives) of the other one; pairs that are farther apart than `reach` are judged by every 16th point and so to about the distance of these. A capsule
   * and images of itself count within `reach` only.
   */
  ShellGap
  smallest_gap(const ShellConfigurations &shells, const std::array<double, 3> &periods, double reach);

  /**
   * Smallest distance of parts of one shell that face opposite ways (normals at more than 154 degrees): two sheets with liquid between them, outside as where a dimple closes on itself, or inside as where a disk is
   * thin. Within `reach`, infinite beyond. A smooth rim of radius R is one of 2 R.
   */
  double
  smallest_self_gap(const ShellConfiguration &shell, double reach);

  /** Smallest distance of the shells' points from planes x_d = +-half_sides[d]; infinite half sides are no planes. Negative beyond them. */
  double
  smallest_distance_from_faces(const ShellConfigurations &shells, const std::array<double, 3> &half_sides);
} // namespace tanktread

#endif
