// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: symmetric quadrature rules on the unit triangle.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/triangle_quadrature.h>

#include <cmath>
#include <string>
#include <vector>

namespace tanktread
{
  namespace
  {
    /** Points that the symmetries of the triangle map to each other, with barycentric coordinates (p, q, 1 - p - q); weight of each, all weights sum to 1. */
    struct Orbit
    {
      double p, q, weight;
    };

    std::vector<Orbit>
    orbits(const unsigned int n_points)
    {
      const double third = 1. / 3., root_15 = std::sqrt(15.);
      switch (n_points)
        {
          case 1:
            return {{third, third, 1.}};
          case 3:
            return {{1. / 6., 1. / 6., third}};
          case 6:
            return {{0.44594849091596488632, 0.44594849091596488632, 0.2233815896780114657},
                    {0.09157621350977074346, 0.09157621350977074346, 0.10995174365532186764}};
          case 7:
            return {{third, third, 9. / 40.},
                    {(6. - root_15) / 21., (6. - root_15) / 21., (155. - root_15) / 1200.},
                    {(6. + root_15) / 21., (6. + root_15) / 21., (155. + root_15) / 1200.}};
          case 12:
            return {{0.24928674517091042129, 0.24928674517091042129, 0.11678627572637936603},
                    {0.06308901449150222834, 0.06308901449150222834, 0.05084490637020681692},
                    {0.05314504984481694735, 0.31035245103378440542, 0.08285107561837357519}};
          default:
            throw InputError("There is no triangle quadrature with " + std::to_string(n_points) + " points; there is one with 1, 3, 6, 7 and 12.");
        }
    }

    void
    add_orbit(const Orbit &orbit, std::vector<Eigen::Vector3d> &rule)
    {
      const double p = orbit.p, q = orbit.q, r = 1. - p - q, w = orbit.weight / 2.;
      if (p == q && std::abs(r - p) < 1e-14)
        rule.emplace_back(p, q, w);
      else if (p == q)
        rule.insert(rule.end(), {{p, p, w}, {r, p, w}, {p, r, w}});
      else
        rule.insert(rule.end(), {{p, q, w}, {q, p, w}, {p, r, w}, {r, p, w}, {q, r, w}, {r, q, w}});
    }

    /** The three corner triangles of half the size and the middle one, which is turned by half a turn. */
    std::vector<Eigen::Vector3d>
    subdivide(const std::vector<Eigen::Vector3d> &rule)
    {
      std::vector<Eigen::Vector3d> fine;
      for (const auto &corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(.5, 0), Eigen::Vector2d(0, .5), Eigen::Vector2d(.5, .5)})
        for (const Eigen::Vector3d &p : rule)
          {
            const double sign = corner.sum() == 1. ? -.5 : .5;
            fine.emplace_back(corner[0] + sign * p[0], corner[1] + sign * p[1], p[2] / 4.);
          }
      return fine;
    }
  } // namespace


  TriangleQuadrature
  triangle_quadrature(const unsigned int n_points, const unsigned int n_subdivisions)
  {
    if (n_subdivisions > 5)
      throw InputError("A triangle quadrature can be subdivided at most 5 times, not " + std::to_string(n_subdivisions) + ".");
    std::vector<Eigen::Vector3d> rule;
    for (const Orbit &orbit : orbits(n_points))
      add_orbit(orbit, rule);
    for (unsigned int l = 0; l < n_subdivisions; ++l)
      rule = subdivide(rule);

    TriangleQuadrature quadrature;
    quadrature.points.resize(rule.size(), 2);
    quadrature.weights.resize(rule.size());
    for (std::size_t q = 0; q < rule.size(); ++q)
      {
        quadrature.points.row(q) = rule[q].head<2>();
        quadrature.weights[q]    = rule[q][2];
      }
    return quadrature;
  }
} // namespace tanktread
