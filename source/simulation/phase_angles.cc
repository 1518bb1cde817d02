// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how far the shell's material has turned about the capsule, and how far it has turned against the shape.

#include <tanktread/simulation/phase_angles.h>
#include <tanktread/surface/subdivision_surface.h>

#include <cmath>

namespace tanktread
{
  namespace
  {
    const double pi = 3.14159265358979323846;
  }


  PhaseAngles::PhaseAngles(const TriangleMesh &topology, const ControlPoints &x, const InertiaEllipsoid &ellipsoid, const double theta_over_pi)
    : limit_(vertex_limit_stencils(topology))
    , theta_(theta_over_pi)
  {
    const double             theta = std::isnan(theta_over_pi) ? 0. : pi * theta_over_pi;
    const Eigen::RowVector3d axis(std::cos(theta), 0., std::sin(theta));
    (limit_ * x * axis.transpose()).eval().col(0).maxCoeff(&marker_);
    alpha_  = marker_angle(x, ellipsoid);
    offset_ = alpha_ - theta_;
  }


  PhaseAngles::PhaseAngles(const TriangleMesh &topology, const std::array<double, 4> &numbers)
    : limit_(vertex_limit_stencils(topology))
    , marker_(Eigen::Index(numbers[0]))
    , alpha_(numbers[1])
    , theta_(numbers[2])
    , offset_(numbers[3])
  {}


  double
  PhaseAngles::marker_angle(const ControlPoints &x, const InertiaEllipsoid &ellipsoid) const
  {
    const Eigen::RowVector3d position = limit_.row(marker_) * x;
    return std::atan2(position[2] - ellipsoid.centroid[2], position[0] - ellipsoid.centroid[0]) / pi;
  }


  void
  PhaseAngles::update(const ControlPoints &x, const InertiaEllipsoid &ellipsoid, const double theta_over_pi)
  {
    alpha_ += std::remainder(marker_angle(x, ellipsoid) - alpha_, 2.);
    if (std::isnan(theta_over_pi))
      return;
    if (std::isnan(theta_))
      {
        theta_  = theta_over_pi;
        offset_ = alpha_ - theta_;
      }
    theta_ += std::remainder(theta_over_pi - theta_, 1.);
  }
} // namespace tanktread
