// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: classes of shells that are far from each other.

#ifndef tanktread_coupling_shell_colours_h
#define tanktread_coupling_shell_colours_h

#include <tanktread/fluid/box.h>
#include <tanktread/shell/shell_box.h>

#include <vector>

namespace tanktread
{
  /**
   * A number 0, 1, ... for each shell, its colour: boxes of the same colour, periodic images included, are at least `margin` from each other along one axis.
   * Each shell takes the least number that no earlier one so near to it has, so there are no more colours than the most neighbours of a shell and one. Time goes
   * with the number of shells and of their neighbours.
   */
  std::vector<unsigned int>
  shell_colours(const std::vector<ShellBox> &shells, const Box &box, double margin);
} // namespace tanktread

#endif
