// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: numbers of things that have to fit into 32 bits.

#ifndef tanktread_base_counts_h
#define tanktread_base_counts_h

#include <cstddef>

namespace tanktread
{
  /**
   * n as MPI counts, entries of one message or one call. Not collective.
   * Throws NumericalError, which names what is counted, where n is more than 2^31 - 1: with a plain conversion a call would send a part, or nothing.
   */
  int
  mpi_count(std::size_t n, const char *what);

  /**
   * n as arrays of indices hold it. Not collective.
   * Throws NumericalError, which names what is counted, where n is more than 2^32 - 2; the largest number often says that there is none.
   */
  unsigned int
  index_count(std::size_t n, const char *what);
} // namespace tanktread

#endif
