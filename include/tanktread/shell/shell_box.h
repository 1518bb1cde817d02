// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: boxes about shells, by which it is told which of them may be near to each other.

#ifndef tanktread_shell_shell_box_h
#define tanktread_shell_shell_box_h

#include <tanktread/surface/types.h>

#include <array>

namespace tanktread
{
  /** Lower and upper corner of the box about a shell's points, in a; along periodic axes wherever they are. */
  struct ShellBox
  {
    std::array<double, 3> lower, upper;
  };

  /** @param X points, n x 3. */
  ShellBox
  shell_box(const ControlPoints &X);

  /** About both. */
  ShellBox
  joined(const ShellBox &first, const ShellBox &second);

  /** Of a box from the nearest image of another one by multiples of `periods` (infinite along axes without); zero if they meet. */
  double
  box_distance(const ShellBox &first, const ShellBox &second, const std::array<double, 3> &periods);
} // namespace tanktread

#endif
