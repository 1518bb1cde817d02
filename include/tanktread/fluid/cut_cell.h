// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: element matrices of the part of a cube that lies inside the shell.

#ifndef tanktread_fluid_cut_cell_h
#define tanktread_fluid_cut_cell_h

#include <array>

namespace tanktread
{
  /** Integrals over a part K of the unit cube, of the quadratic functions N_a (27) and the linear functions M_j (8), both in lexicographic order, x fastest. */
  struct PartialCellMatrices
  {
    double                                   volume = 0.;
    std::array<std::array<float, 27>, 27>    laplace;    // grad N_a . grad N_b, symmetric
    std::array<std::array<float, 3 * 27>, 8> divergence; // M_j dN_a/dx_c at [j][27 c + a]
  };

  /** Integral of dN_b/dx_d dN_a/dx_c over the part at [b][a][3 d + c]: what the strain form needs in addition. */
  using GradientProducts = std::array<std::array<std::array<float, 9>, 27>, 27>;

  /** The whole unit cube. */
  const PartialCellMatrices &
  whole_cell_matrices();
  const GradientProducts &
  whole_gradient_products();

  /**
   * The part with phi < 0 of a level set given at the 27 nodes of the cube, in units of its edge.
   *
   * The eight half-size boxes are divided into six tetrahedra each, cut flat where phi changes its sign; the sliver between the flat cut and the zero of the quadratic phi is added as points on
   * the cut of weight dA delta, delta = -phi / (grad phi . n), in the middle of the sliver. All points are then condensed into weights at 5 x 5 x 5 Gauss points that integrate
   * polynomials of degree four along each axis as those points do, and the matrices are sums of products over these.
   *
   * @param products made too, unless null.
   */
  PartialCellMatrices
  inside_matrices(const std::array<double, 27> &phi, GradientProducts *products = nullptr);

  /** Those weights at the 5 x 5 x 5 Gauss points, x fastest; of the whole cube and of the part with phi < 0. */
  using CellWeights = std::array<double, 125>;
  const CellWeights &
  whole_weights();
  CellWeights
  inside_weights(const std::array<double, 27> &phi);

  /** Coordinates of the Gauss points along each axis. */
  const std::array<double, 5> &
  fine_gauss_abscissae();
} // namespace tanktread

#endif
