// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where a capsule relaxes to.

#ifndef tanktread_simulation_motion_limits_h
#define tanktread_simulation_motion_limits_h

#include <tanktread/simulation/relaxation_limit.h>

#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  struct MotionSample;

  /** Where a capsule relaxes to; see relaxation_limits(). */
  struct MotionLimits
  {
    RelaxationLimit D, theta, L, B, W, intrinsic_viscosity, N1, N2;

    /** Names as in summary.csv. */
    std::vector<std::pair<std::string, RelaxationLimit>>
    named() const;

    /**
     * The largest bar of the shape, which is what Time/Limit tolerance is compared with: of D, L, B and W relative to their limits (of D below 0.01 to that), of theta / pi
     * absolute where it has a limit. Infinite without limits.
     */
    double
    largest_error() const;
  };

  /** @param samples in order of time, from the start of the run on. */
  MotionLimits
  motion_limits(const std::vector<MotionSample> &samples);
} // namespace tanktread

#endif
