// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the known name that a misspelt one probably meant.

#ifndef tanktread_base_nearest_name_h
#define tanktread_base_nearest_name_h

#include <string>
#include <vector>

namespace tanktread
{
  /** Least number of inserted, deleted, replaced or exchanged neighbouring characters that turn `a` into `b`; upper and lower case count as equal. */
  unsigned int
  edit_distance(const std::string &a, const std::string &b);

  /** The member of `known` nearest to `name`, or an empty string when none is near (more than a third of the characters, and more than two, differ). */
  std::string
  nearest_name(const std::string &name, const std::vector<std::string> &known);

  /** "; did you mean "X"?" for the nearest of `known`, or an empty string. To be appended to an error message. */
  std::string
  did_you_mean(const std::string &name, const std::vector<std::string> &known);
} // namespace tanktread

#endif
