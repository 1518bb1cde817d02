// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the steps of a run leave over in the balance of energy.

#ifndef tanktread_simulation_energy_balance_h
#define tanktread_simulation_energy_balance_h

#include <vector>

namespace tanktread
{
  /**
   * Stored energy E and power P = F . U that a shell gives to the liquid are known exactly at each level, and dE/dt = -P whatever the mesh: what
   *
   *     sum_n |E_{n+1} - E_n + integral of P from t_n to t_{n+1}| / integral of |P|
   *
   * is more than zero is due to the steps (theory.md, section 5.3). The integrals are those of the cubics through four levels. Not a number for fewer than four
   * samples, or where one is not a number.
   *
   * @param times ascending. @param energies, powers at these times.
   */
  double
  energy_defect(const std::vector<double> &times, const std::vector<double> &energies, const std::vector<double> &powers);

  /**
   * Of the last step alone, E_n - E_{n-1} + integral of P from t_{n-1} to t_n: the integral is that of the polynomial through the last levels, four at most. Zero before there is a step.
   *
   * @param times ascending. @param energies, powers at these times.
   */
  double
  energy_residual(const std::vector<double> &times, const std::vector<double> &energies, const std::vector<double> &powers);
} // namespace tanktread

#endif
