// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many cells the fluid's mesh may have.

#ifndef tanktread_fluid_number_of_cells_h
#define tanktread_fluid_number_of_cells_h

#include <cstdint>

namespace tanktread
{
  /**
   * Throws InputError for more cells in all than have nodes, 27 each, that this build of deal.II can count: 159072862 with 32 bits as in Debian, beyond which
   * their numbers might begin again at zero. NodeSpace allows fewer, but has to have been given a right number of nodes to say so. Not collective.
   */
  void
  check_number_of_cells(std::uint64_t n_cells);
} // namespace tanktread

#endif
