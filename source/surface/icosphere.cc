// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Loop's subdivision of a triangle mesh, and the icosphere that it makes.

#include <tanktread/surface/subdivision_surface.h>
#include <tanktread/surface/triangle_mesh.h>

#include <cmath>
#include <map>
#include <utility>

namespace tanktread
{
  namespace
  {
    TriangleMesh
    icosahedron()
    {
      const double t = (1. + std::sqrt(5.)) / 2.;
      return {{{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0}, {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t}, {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}},
              {{{0, 11, 5}}, {{0, 5, 1}}, {{0, 1, 7}}, {{0, 7, 10}}, {{0, 10, 11}}, {{1, 5, 9}}, {{5, 11, 4}}, {{11, 10, 2}}, {{10, 7, 6}}, {{7, 1, 8}},
               {{3, 9, 4}},  {{3, 4, 2}}, {{3, 2, 6}}, {{3, 6, 8}},  {{3, 8, 9}},   {{4, 9, 5}}, {{2, 4, 11}}, {{6, 2, 10}},  {{8, 6, 7}},  {{9, 8, 1}}}};
    }
  } // namespace


  double
  loop_weight(const unsigned int valence)
  {
    const double c = 3. / 8. + std::cos(2. * M_PI / valence) / 4.;
    return (5. / 8. - c * c) / valence;
  }


  TriangleMesh
  loop_refine(const TriangleMesh &coarse)
  {
    const std::size_t                          n = coarse.vertices.size();
    std::map<std::pair<int, int>, std::size_t> edges; // smaller and larger end -> vertex of the fine mesh
    std::vector<Eigen::Vector3d>               neighbours(n, Eigen::Vector3d::Zero());
    std::vector<unsigned int>                  valence(n, 0);
    TriangleMesh                               fine{coarse.vertices, {}};
    for (const auto &face : coarse.faces)
      {
        std::array<int, 3> middle;
        for (unsigned int i = 0; i < 3; ++i)
          {
            const int a = face[i], b = face[(i + 1) % 3], opposite = face[(i + 2) % 3];
            const auto [edge, is_new] = edges.emplace(std::minmax(a, b), fine.vertices.size());
            if (is_new)
              fine.vertices.push_back(3. / 8. * (coarse.vertices[a] + coarse.vertices[b]));
            fine.vertices[edge->second] += coarse.vertices[opposite] / 8.;
            middle[i] = int(edge->second);
            neighbours[a] += coarse.vertices[b];
            ++valence[a];
          }
        fine.faces.insert(fine.faces.end(), {{{face[0], middle[0], middle[2]}}, {{middle[0], face[1], middle[1]}}, {{middle[2], middle[1], face[2]}}, middle});
      }
    for (std::size_t v = 0; v < n; ++v)
      {
        const double beta = loop_weight(valence[v]);
        fine.vertices[v]  = (1. - valence[v] * beta) * coarse.vertices[v] + beta * neighbours[v];
      }
    return fine;
  }


  TriangleMesh
  icosphere(const unsigned int level)
  {
    TriangleMesh mesh = icosahedron();
    for (unsigned int l = 0; l < level; ++l)
      mesh = loop_refine(mesh);

    ControlPoints x(mesh.vertices.size(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x.row(i) = mesh.vertices[i];
    x = (vertex_limit_stencils(mesh) * x).rowwise().normalized().eval();
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      mesh.vertices[i] = x.row(i);
    return mesh;
  }
} // namespace tanktread
