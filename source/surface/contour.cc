// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the outline of a capsule in the shear plane.

#include <tanktread/surface/contour.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tanktread
{
  namespace
  {
    double
    signed_area(const std::vector<Eigen::Vector2d> &loop)
    {
      double area = 0;
      for (std::size_t i = 0; i < loop.size(); ++i)
        {
          const Eigen::Vector2d &p = loop[i], &q = loop[(i + 1) % loop.size()];
          area += (p[0] * q[1] - p[1] * q[0]) / 2.;
        }
      return area;
    }

    Eigen::Vector2d
    crossing(const Eigen::Vector3d &p, const Eigen::Vector3d &q)
    {
      const Eigen::Vector3d x = (q[1] * p - p[1] * q) / (q[1] - p[1]);
      return {x[0], x[2]};
    }
  } // namespace


  std::vector<Eigen::Vector2d>
  shear_plane_contour(const TriangleMesh &positions)
  {
    // Vertices with y = 0 count as y > 0. So a face that is cut has one edge that enters y < 0 and one that leaves it, and the neighbour across the
    // leaving edge enters there: following them runs through a loop.
    using Edge                    = std::pair<int, int>;
    const auto           is_above = [&](const int v) { return positions.vertices[v][1] >= 0.; };
    std::map<Edge, Edge> next; // entering edge, as its face sees it -> the same of the next face
    for (const auto &face : positions.faces)
      {
        Edge entering{-1, -1}, leaving{-1, -1};
        for (unsigned int i = 0; i < 3; ++i)
          {
            const int a = face[i], b = face[(i + 1) % 3];
            if (is_above(a) && !is_above(b))
              entering = {a, b};
            else if (!is_above(a) && is_above(b))
              leaving = {a, b};
          }
        if (entering.first >= 0)
          next[entering] = {leaving.second, leaving.first};
      }

    std::vector<Eigen::Vector2d> largest;
    while (!next.empty())
      {
        std::vector<Eigen::Vector2d> loop;
        for (auto edge = next.begin(); edge != next.end();)
          {
            loop.push_back(crossing(positions.vertices[edge->first.first], positions.vertices[edge->first.second]));
            const Edge following = edge->second;
            next.erase(edge);
            edge = next.find(following);
          }
        if (largest.empty() || std::abs(signed_area(loop)) > std::abs(signed_area(largest)))
          largest = loop;
      }
    if (signed_area(largest) < 0)
      std::reverse(largest.begin(), largest.end());
    return largest;
  }
} // namespace tanktread
