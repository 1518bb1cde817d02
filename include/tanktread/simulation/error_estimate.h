// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the error of a number from what coarser computations give for it.

#ifndef tanktread_simulation_error_estimate_h
#define tanktread_simulation_error_estimate_h

#include <vector>

namespace tanktread
{
  /** What a series of computations says about the limit of its finest value. */
  struct ErrorEstimate
  {
    double order;        // observed where three values fall towards their limit, otherwise the expected one
    bool   is_observed;  // whether the order is that of the values
    double extrapolated; // limit of the power law through the two finest values
    double error;        // bar: distance from the limit times a factor of safety
  };

  /**
   * Richardson's extrapolation of q(h) = q + C h^p, with the bar of the grid convergence index (P. J. Roache, J. Fluids Eng. 116, 405 (1994)): |q(h) - q| times
   * 1.25 where the three finest values give an order, times 3 where they do not or there are only two, p being `expected_order` then. Observed orders above the
   * expected one count as that, those below a half are not believed.
   *
   * @param values at least two, the finest first, each `ratio` (> 1) times as coarse as the one before. Throws std::invalid_argument otherwise.
   */
  ErrorEstimate
  error_estimate(const std::vector<double> &values, double ratio, double expected_order);

  /** The same for the coarsest of the values, the distance of which from the limit is nearly measured: the factor is 1.25. */
  ErrorEstimate
  error_of_the_coarsest(const std::vector<double> &values, double ratio, double expected_order);
} // namespace tanktread

#endif
