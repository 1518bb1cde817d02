// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which points a closed surface encloses.

#include <tanktread/surface/interior.h>
#include <tanktread/surface/surface_geometry.h>

#include <cmath>
#include <limits>

namespace tanktread
{
  Interior::Interior(const SubdivisionSurface &surface, const ControlPoints &x)
    : positions_(surface.S() * x)
    , normals_(normals(surface, x))
    , low_(positions_.colwise().minCoeff())
    , high_(positions_.colwise().maxCoeff())
    , centre_(positions_.colwise().mean())
  {
    const Eigen::VectorXd areas = area_weights(surface, x);
    box_size_                   = 3. * std::sqrt(areas.maxCoeff());
    for (Eigen::Index q = 0; q < positions_.rows(); ++q)
      points_[box(positions_.row(q))].push_back(q);
    box_centres_.resize(points_.size(), 3);
    box_area_normals_.setZero(points_.size(), 3);
    Eigen::Index b = 0;
    for (const auto &[key, points] : points_)
      {
        Eigen::RowVector3d sum(0., 0., 0.);
        double             area = 0.;
        for (const Eigen::Index q : points)
          {
            sum += areas[q] * positions_.row(q);
            area += areas[q];
            box_area_normals_.row(b) += areas[q] * normals_.row(q);
          }
        box_centres_.row(b++) = sum / area;
      }
  }


  Interior::Box
  Interior::box(const Eigen::Vector3d &y) const
  {
    const auto part = [&](const int d) { return static_cast<int>(std::floor(y[d] / box_size_)); };
    return {{part(0), part(1), part(2)}};
  }


  bool
  Interior::contains(const Eigen::Vector3d &y) const
  {
    if ((y.array() < low_.array()).any() || (y.array() > high_.array()).any())
      return false;
    const Box    home    = box(y);
    double       nearest = std::numeric_limits<double>::infinity();
    Eigen::Index found   = -1;
    for (int n = 0; n < 27; ++n)
      {
        const auto neighbour = points_.find({{home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1}});
        if (neighbour == points_.end())
          continue;
        for (const Eigen::Index q : neighbour->second)
          {
            const double distance = (positions_.row(q) - y.transpose()).squaredNorm();
            if (distance < nearest)
              {
                nearest = distance;
                found   = q;
              }
          }
      }
    if (found >= 0)
      return normals_.row(found).dot(positions_.row(found) - y.transpose()) > 0.;

    double solid_angle = 0.;
    for (Eigen::Index b = 0; b < box_centres_.rows(); ++b)
      {
        const Eigen::RowVector3d r  = box_centres_.row(b) - y.transpose();
        const double             r2 = r.squaredNorm();
        solid_angle += box_area_normals_.row(b).dot(r) / (r2 * std::sqrt(r2));
      }
    return solid_angle > 6.283185307179586; // half of the full 4 pi
  }
} // namespace tanktread
