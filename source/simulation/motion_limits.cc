// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where a capsule relaxes to.

#include <tanktread/simulation/motion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tanktread
{
  namespace
  {
    constexpr Eigen::Index n_of_shape = 5;
  }


  std::vector<std::pair<std::string, RelaxationLimit>>
  MotionLimits::named() const
  {
    return {{"D", D}, {"theta", theta}, {"L", L}, {"B", B}, {"W", W}, {"intrinsic_viscosity", intrinsic_viscosity}, {"N1", N1}, {"N2", N2}};
  }


  double
  MotionLimits::largest_error() const
  {
    if (std::isnan(D.value) || std::isnan(L.value))
      return std::numeric_limits<double>::infinity();
    const double result = std::max({D.error / std::max(D.value, 0.01), L.error / L.value, B.error / B.value, W.error / W.value});
    return std::isnan(theta.value) ? result : std::max(result, theta.error);
  }


  MotionLimits
  motion_limits(const std::vector<MotionSample> &samples)
  {
    std::vector<double> times;
    Eigen::MatrixXd     values(samples.size(), n_of_shape + 3);
    for (const MotionSample &s : samples)
      {
        values.row(times.size()) << s.D, s.theta, s.L, s.B, s.W, s.intrinsic_viscosity, s.N1, s.N2;
        times.push_back(s.time);
      }
    const std::vector<RelaxationLimit> limit = relaxation_limits(times, values, n_of_shape);
    return {limit[0], limit[1], limit[2], limit[3], limit[4], limit[5], limit[6], limit[7]};
  }
} // namespace tanktread
