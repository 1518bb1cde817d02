// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the error of a number from what coarser computations give for it.

#include <tanktread/simulation/error_estimate.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tanktread
{
  ErrorEstimate
  error_estimate(const std::vector<double> &values, const double ratio, const double expected_order)
  {
    if (values.size() < 2 || !(ratio > 1.) || !(expected_order > 0.))
      throw std::invalid_argument("An error is estimated from two values or more, a ratio above one and an order above zero.");
    const double  difference = values[0] - values[1];
    ErrorEstimate result{expected_order, false, 0., 0.};
    if (values.size() > 2 && difference * (values[1] - values[2]) > 0.)
      {
        const double observed = std::log((values[1] - values[2]) / difference) / std::log(ratio);
        if (observed >= 0.5)
          {
            result.order       = observed;
            result.is_observed = true;
          }
      }
    const double distance = difference / (std::pow(ratio, std::min(result.order, expected_order)) - 1.);
    result.extrapolated   = values[0] + distance;
    result.error          = (result.is_observed ? 1.25 : 3.) * std::abs(distance);
    return result;
  }


  ErrorEstimate
  error_of_the_coarsest(const std::vector<double> &values, const double ratio, const double expected_order)
  {
    ErrorEstimate result = error_estimate(values, ratio, expected_order);
    result.error         = 1.25 * std::abs(values.back() - result.extrapolated);
    return result;
  }
} // namespace tanktread
