// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Stokes flows in unbounded liquid, as sums over points.

#ifndef tanktread_fluid_far_field_h
#define tanktread_fluid_far_field_h

#include <array>
#include <vector>

namespace tanktread
{
  /** Vectors at points: one array for each component, all of the same length. */
  using Columns = std::array<std::vector<double>, 3>;

  /**
   * velocity(x) += 1/(8 pi) sum_q [F_q/|y| + y (y . F_q)/|y|^3], y = x - X_q: what point forces F on a liquid of viscosity 1 at points X make at points x, none
   * of which may be one of X (Pozrikidis, Boundary integral and singularity methods, 1992, eq. 2.2.8). One third power of an inverse root a pair.
   */
  void
  add_stokeslets(const Columns &X, const Columns &F, const Columns &x, Columns &velocity);

  /**
   * velocity(x) += factor/(8 pi) sum_q 6 y (y . u_q)(y . a_q)/|y|^5, y = x - X_q. With the velocities u of a closed surface and its vector areas a (outward, of the
   * parts that the points X stand for) about the double layer that liquid of another viscosity inside makes: its flow outside has
   * factor = 1 - viscosity inside over outside (the same book, eq. 5.3.8). Where u is that of a rigid body it vanishes outside.
   */
  void
  add_double_layer(const Columns &X, const Columns &u, const Columns &a, double factor, const Columns &x, Columns &velocity);

  /** velocity(x) += 1/(8 pi) sum_q T_q x y/|y|^3, y = x - X_q: what torques T on the liquid make. */
  void
  add_rotlets(const Columns &X, const Columns &T, const Columns &x, Columns &velocity);
} // namespace tanktread

#endif
