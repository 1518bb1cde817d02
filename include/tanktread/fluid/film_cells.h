// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the size of the finest cells that a thin film of liquid asks for.

#ifndef tanktread_fluid_film_cells_h
#define tanktread_fluid_film_cells_h

namespace tanktread
{
  /**
   * How often finest cells of side h are halved for a film of width `gap`: as seldom as makes them gap/2 or smaller, at most `most` times. Where the mesh has
   * halved them `present` times already, larger ones come back only when the film would let them with a width of gap/1.5: films that waver keep their mesh.
   *
   * @param gap in a; infinite without a film, zero or less where shells overlap, which asks for all there is. @param h in a.
   */
  unsigned int
  film_halvings(double gap, double h, unsigned int most, unsigned int present);
} // namespace tanktread

#endif
