// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: writing files so that failing is noticed.

#ifndef tanktread_base_output_file_h
#define tanktread_base_output_file_h

#include <fstream>
#include <string>

namespace tanktread
{
  /**
   * Writes beside `file` and renames, which POSIX does at once: a reader, or a kill, sees the old file or the new one. @throws OutputError; then nothing is
   * left beside it.
   */
  void
  replace_file(const std::string &file, const std::string &content);

  /** Cuts a file off after its first `size` bytes and opens it to go on from there. @throws OutputError. */
  void
  cut_and_open(std::ofstream &stream, const std::string &file, std::streamoff size);

  /** "cannot write FILE: REASON"; the reason is what `error`, a value of errno, stands for, none for zero. */
  std::string
  cannot_write(const std::string &file, int error);
} // namespace tanktread

#endif
