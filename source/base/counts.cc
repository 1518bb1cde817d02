// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: numbers of things that have to fit into 32 bits.

#include <tanktread/base/counts.h>
#include <tanktread/base/exceptions.h>

#include <limits>
#include <string>

namespace tanktread
{
  namespace
  {
    void
    check(const std::size_t n, const std::size_t most, const char *const what)
    {
      if (n > most)
        throw NumericalError("A rank has " + std::to_string(n) + ' ' + what + "; allowed: at most " + std::to_string(most) + ". More ranks have less each.");
    }
  } // namespace


  int
  mpi_count(const std::size_t n, const char *const what)
  {
    check(n, std::numeric_limits<int>::max(), what);
    return static_cast<int>(n);
  }


  unsigned int
  index_count(const std::size_t n, const char *const what)
  {
    check(n, std::numeric_limits<unsigned int>::max() - 1u, what);
    return static_cast<unsigned int>(n);
  }
} // namespace tanktread
