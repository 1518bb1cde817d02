// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: element matrices of the part of a cube that lies inside the shell.

#ifndef tanktread_fluid_cut_cell_h
#define tanktread_fluid_cut_cell_h

#include <tanktread/fluid/cell_weights.h>

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
   * The part with phi < 0 of a level set given at the 27 nodes of the cube, in units of its edge: sums over the points of inside_weights().
   *
   * @param products made too, unless null.
   */
  PartialCellMatrices
  inside_matrices(const std::array<double, 27> &phi, GradientProducts *products = nullptr);
} // namespace tanktread

#endif
