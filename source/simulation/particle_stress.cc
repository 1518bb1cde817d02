// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the capsule adds to the stress of the suspension.

#include <tanktread/simulation/particle_stress.h>

#include <limits>

namespace tanktread
{
  Eigen::Matrix3d
  particle_stress(const ControlPoints &x, const ControlPoints &force)
  {
    const Eigen::Matrix3d moment    = x.transpose() * force;
    const Eigen::Matrix3d symmetric = -0.5 * (moment + moment.transpose());
    return symmetric - symmetric.trace() / 3. * Eigen::Matrix3d::Identity();
  }


  Rheology
  rheology(const Eigen::Matrix3d &stress, const double volume, const double shear_rate)
  {
    const double scale = shear_rate > 0. ? 1. / (shear_rate * volume) : std::numeric_limits<double>::quiet_NaN();
    return {scale * stress(0, 2), scale * (stress(0, 0) - stress(2, 2)), scale * (stress(2, 2) - stress(1, 1))};
  }
} // namespace tanktread
