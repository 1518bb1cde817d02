// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the part of a velocity that is no rigid motion.

#ifndef tanktread_surface_rigid_motion_h
#define tanktread_surface_rigid_motion_h

#include <tanktread/surface/types.h>

namespace tanktread
{
  /** A velocity of points x (both NP x 3) less the rigid motion that is nearest to it in the mean square. The points must not lie on one line. */
  ControlPoints
  without_rigid_motion(const ControlPoints &x, const ControlPoints &velocity);
} // namespace tanktread

#endif
