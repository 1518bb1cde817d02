// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: quadrature over the part of a cube that lies inside the shell.

#ifndef tanktread_fluid_cell_weights_h
#define tanktread_fluid_cell_weights_h

#include <array>

namespace tanktread
{
  /**
   * Weights at the 5 x 5 x 5 Gauss points of the unit cube, x fastest, that integrate polynomials of degree four along each axis as a quadrature with other
   * points does.
   */
  using CellWeights = std::array<double, 125>;

  /** Of the whole cube. */
  const CellWeights &
  whole_weights();

  /**
   * Of the part with phi < 0 of a level set given at the 27 nodes of the cube, in units of its edge.
   *
   * The eight half-size boxes are divided into six tetrahedra each, cut flat where phi changes its sign; the sliver between the flat cut and the zero of the
   * quadratic phi is added as points on the cut of weight dA delta, delta = -phi / (grad phi . n), in the middle of the sliver.
   */
  CellWeights
  inside_weights(const std::array<double, 27> &phi);

  /** Coordinates of the Gauss points along each axis. */
  const std::array<double, 5> &
  fine_gauss_abscissae();
} // namespace tanktread

#endif
