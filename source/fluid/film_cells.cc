// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the size of the finest cells that a thin film of liquid asks for.

#include <tanktread/fluid/film_cells.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    constexpr double cells_in_a_film = 2.;
    constexpr double hysteresis      = 1.5;

    unsigned int
    needed_halvings(const double gap, double h, const unsigned int most)
    {
      unsigned int result = 0;
      for (; result < most && cells_in_a_film * h > gap; h *= 0.5)
        ++result;
      return result;
    }
  } // namespace


  unsigned int
  film_halvings(const double gap, const double h, const unsigned int most, const unsigned int present)
  {
    const unsigned int needed = needed_halvings(gap, h, most);
    return needed >= present ? needed : std::min(present, needed_halvings(gap / hysteresis, h, most));
  }
} // namespace tanktread
