// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the folder that a run writes to.

#ifndef tanktread_base_output_folder_h
#define tanktread_base_output_folder_h

#include <string>

namespace tanktread
{
  /**
   * Checks that `folder` can be made and written, leaving nothing behind on disk.
   * @throws InputError naming the folder and the reason.
   */
  void
  check_output_folder(const std::string &folder);

  /**
   * Makes `folder` with its parents. One that holds a former run (a history.csv) is first moved aside to `folder`.previous, replacing an older one there,
   * so that no run overwrites another. To be called on one rank.
   * @return name of the folder that the former run was moved to, or an empty string
   * @throws InputError naming the folder and the reason when it cannot be made, moved or written.
   */
  std::string
  prepare_output_folder(const std::string &folder);
} // namespace tanktread

#endif
