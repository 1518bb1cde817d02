// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: versions of the program and of the libraries it was built with.

#ifndef tanktread_base_version_h
#define tanktread_base_version_h

#include <string>

namespace tanktread
{
  /** "Tanktread 0.1.0 (revision 1234abcd, Release)"; the revision is git's, "unknown" for a source tree without git. */
  std::string
  program_version();

  /** "deal.II 9.4.1, Trilinos 13.2.0, p4est 2.2, OpenSubdiv 3.5.0, Eigen 3.4.0". */
  std::string
  library_versions();
} // namespace tanktread

#endif
