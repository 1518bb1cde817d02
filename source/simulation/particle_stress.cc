// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the capsule adds to the stress of the suspension.

#include <tanktread/simulation/particle_stress.h>
#include <tanktread/surface/surface_geometry.h>

#include <limits>

namespace tanktread
{
  Eigen::Matrix3d
  particle_stress(const ControlPoints &x, const ControlPoints &force)
  {
    const Eigen::Matrix3d moment    = (x.rowwise() - x.colwise().mean()).transpose() * force; // about the middle: forces may have a sum, of rounding at least
    const Eigen::Matrix3d symmetric = -0.5 * (moment + moment.transpose());
    return symmetric - symmetric.trace() / 3. * Eigen::Matrix3d::Identity();
  }


  Eigen::Matrix3d
  viscous_stress(const SubdivisionSurface &surface, const ControlPoints &x, const ControlPoints &velocity, const double viscosity_ratio)
  {
    const ControlPoints   U = surface.S() * velocity, n = normals(surface, x);
    const Eigen::Matrix3d moment    = U.transpose() * area_weights(surface, x).asDiagonal() * n;
    const Eigen::Matrix3d symmetric = (viscosity_ratio - 1.) * (moment + moment.transpose());
    return symmetric - symmetric.trace() / 3. * Eigen::Matrix3d::Identity();
  }


  Rheology
  rheology(const Eigen::Matrix3d &stress, const double volume, const double shear_rate)
  {
    const double scale = shear_rate > 0. ? 1. / (shear_rate * volume) : std::numeric_limits<double>::quiet_NaN();
    return {scale * stress(0, 2), scale * (stress(0, 0) - stress(2, 2)), scale * (stress(2, 2) - stress(1, 1))};
  }
} // namespace tanktread
