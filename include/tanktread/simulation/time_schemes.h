// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the implicit time schemes as formulas.

#ifndef tanktread_simulation_time_schemes_h
#define tanktread_simulation_time_schemes_h

#include <vector>

namespace tanktread
{
  enum class TimeScheme
  {
    backward_euler,
    bdf2,
    bdf3,
    sdirk2,
    sdirk3
  };

  /** Order of its global error. */
  unsigned int
  order(TimeScheme scheme);

  /** Whether a step is one solution that looks back to `order` levels, in place of several stages that look back to one. */
  bool
  is_multistep(TimeScheme scheme);

  /** x = sum_i weights[i] x_{n-i} + tau dx/dt(x). */
  struct MultistepFormula
  {
    std::vector<double> weights; // of the levels, newest first
    double              tau;
  };

  /**
   * Backward differentiation: dx/dt at the new time is that of the polynomial through all these levels. At equal steps tau = 1, 2/3, 6/11 times the step for one,
   * two, three levels behind.
   *
   * @param times of the new level and of those behind it, newest first, at least two.
   */
  MultistepFormula
  backward_differentiation(const std::vector<double> &times);

  /**
   * Singly diagonally implicit Runge-Kutta scheme whose last stage is the step: with the displacement d_j = gamma dt dx/dt(x_j) of stage j
   *
   *     x_i = x_n + sum_{j < i} weights[i][j] d_j + gamma dt dx/dt(x_i)      at t_n + ends[i] dt.
   */
  struct SdirkScheme
  {
    double                           gamma;
    std::vector<std::vector<double>> weights;        // a_ij / gamma
    std::vector<double>              ends;           // c_i
    double                           error_constant; // local error of x' = k x over (k dt)^(order + 1) x
  };

  /** SDIRK2 or SDIRK3, L-stable schemes of two and three stages by R. Alexander, SIAM J. Numer. Anal. 14, 1006 (1977). */
  const SdirkScheme &
  sdirk(unsigned int order);
} // namespace tanktread

#endif
