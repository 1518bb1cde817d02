// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kinds of errors a run can end with.

#ifndef tanktread_base_exceptions_h
#define tanktread_base_exceptions_h

#include <stdexcept>

namespace tanktread
{
  /** The user asked for something impossible; the program exits with code 1. The message says what, got, allowed and where. */
  class InputError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /** The computation failed (a solve that did not converge, a collapsed element); the program exits with code 2. */
  class NumericalError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };
  /**
   * A file could not be written (a full disk, a folder that is gone); the program exits with code 2. The message names the file and, where known, the reason.
   */
  class OutputError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };
} // namespace tanktread

#endif
