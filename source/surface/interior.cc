// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which points a closed surface encloses.

#include <tanktread/surface/interior.h>
#include <tanktread/surface/surface_geometry.h>

#include <cmath>

namespace tanktread
{
  Interior::Interior(const SubdivisionSurface &surface, const ControlPoints &x)
    : positions_(surface.S() * x)
    , low_(positions_.colwise().minCoeff())
    , high_(positions_.colwise().maxCoeff())
    , centre_(positions_.colwise().mean())
  {
    const Eigen::VectorXd areas = area_weights(surface, x);
    area_normals_               = areas.asDiagonal() * normals(surface, x);
    spacing_squared_            = areas.maxCoeff();
  }


  bool
  Interior::contains(const Eigen::Vector3d &y) const
  {
    if ((y.array() < low_.array()).any() || (y.array() > high_.array()).any())
      return false;
    double       solid_angle = 0., nearest = spacing_squared_;
    Eigen::Index nearest_point = -1;
    for (Eigen::Index q = 0; q < positions_.rows(); ++q)
      {
        const Eigen::RowVector3d r  = positions_.row(q) - y.transpose();
        const double             r2 = r.squaredNorm();
        if (r2 < nearest)
          {
            nearest       = r2;
            nearest_point = q;
          }
        solid_angle += area_normals_.row(q).dot(r) / (r2 * std::sqrt(r2) + 1e-300);
      }
    if (nearest_point >= 0)
      return area_normals_.row(nearest_point).dot(positions_.row(nearest_point) - y.transpose()) > 0.;
    return solid_angle > 6.283185307179586; // half of the full 4 pi
  }
} // namespace tanktread
