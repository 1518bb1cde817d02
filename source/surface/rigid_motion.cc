// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the part of a velocity that is no rigid motion.

#include <Eigen/Dense>
#include <tanktread/surface/rigid_motion.h>

namespace tanktread
{
  ControlPoints
  without_rigid_motion(const ControlPoints &x, const ControlPoints &velocity)
  {
    const Eigen::RowVector3d mean    = velocity.colwise().mean();
    const ControlPoints      r       = x.rowwise() - x.colwise().mean();
    ControlPoints            result  = velocity.rowwise() - mean;
    const Eigen::Matrix3d    moments = r.transpose() * r, products = r.transpose() * result;
    const Eigen::Vector3d    turning(products(1, 2) - products(2, 1), products(2, 0) - products(0, 2), products(0, 1) - products(1, 0)); // sum of r x U
    const Eigen::Vector3d    spin = (moments.trace() * Eigen::Matrix3d::Identity() - moments).ldlt().solve(turning);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      result.row(i) -= spin.cross(r.row(i).transpose()).transpose();
    return result;
  }
} // namespace tanktread
