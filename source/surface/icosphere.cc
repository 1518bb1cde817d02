// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Loop's subdivision of a triangle mesh, and the icosphere that it makes.

#include <tanktread/surface/subdivision_surface.h>
#include <tanktread/surface/triangle_mesh.h>

#include <algorithm>
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


  namespace
  {
    /** What a step of Loop's subdivision makes of connectivity: faces, and the rule for positions. */
    struct LoopStep
    {
      explicit LoopStep(const TriangleMesh &coarse);

      std::vector<std::array<int, 3>>     faces;
      std::vector<Eigen::Triplet<double>> weights;
      int                                 n_vertices;
    };


    LoopStep::LoopStep(const TriangleMesh &coarse)
      : n_vertices(int(coarse.vertices.size()))
    {
      std::map<std::pair<int, int>, int> edges; // smaller and larger end -> vertex of the fine mesh
      std::vector<unsigned int>          valence(n_vertices, 0);
      for (const auto &face : coarse.faces)
        for (const int vertex : face)
          ++valence[vertex];
      for (std::size_t v = 0; v < valence.size(); ++v)
        weights.emplace_back(v, v, 1. - valence[v] * loop_weight(valence[v]));
      for (const auto &face : coarse.faces)
        {
          std::array<int, 3> middle;
          for (unsigned int i = 0; i < 3; ++i)
            {
              const int a = face[i], b = face[(i + 1) % 3], opposite = face[(i + 2) % 3];
              const auto [edge, is_new] = edges.emplace(std::minmax(a, b), n_vertices);
              middle[i]                 = edge->second;
              if (is_new)
                {
                  weights.emplace_back(middle[i], a, 3. / 8.);
                  weights.emplace_back(middle[i], b, 3. / 8.);
                  ++n_vertices;
                }
              weights.emplace_back(middle[i], opposite, 1. / 8.);
              weights.emplace_back(a, b, loop_weight(valence[a]));
            }
          faces.insert(faces.end(), {{{face[0], middle[0], middle[2]}}, {{middle[0], face[1], middle[1]}}, {{middle[2], middle[1], face[2]}}, middle});
        }
    }
  } // namespace


  SparseMatrix
  loop_subdivision(const TriangleMesh &coarse)
  {
    const LoopStep step(coarse);
    SparseMatrix   result(step.n_vertices, Eigen::Index(coarse.vertices.size()));
    result.setFromTriplets(step.weights.begin(), step.weights.end());
    return result;
  }


  TriangleMesh
  loop_refine(const TriangleMesh &coarse)
  {
    LoopStep     step(coarse);
    TriangleMesh fine{std::vector<Eigen::Vector3d>(step.n_vertices, Eigen::Vector3d::Zero()), std::move(step.faces)};
    for (const auto &weight : step.weights)
      fine.vertices[weight.row()] += weight.value() * coarse.vertices[weight.col()];
    return fine;
  }


  std::optional<TriangleMesh>
  loop_coarsen(const TriangleMesh &fine)
  {
    if (fine.faces.size() % 4 != 0 || fine.faces.empty())
      return {};
    TriangleMesh coarse;
    int          n = int(fine.vertices.size()); // of the coarse vertices; those in the middle of edges come behind them
    for (std::size_t f = 0; f < fine.faces.size(); f += 4)
      {
        coarse.faces.push_back({{fine.faces[f][0], fine.faces[f + 1][1], fine.faces[f + 2][2]}});
        for (const int middle : fine.faces[f + 3])
          n = std::min(n, middle);
      }
    coarse.vertices.assign(n, Eigen::Vector3d::Zero());
    std::vector<unsigned int> valence(n, 0);
    for (const auto &face : coarse.faces)
      for (const int vertex : face)
        if (vertex >= n || ++valence[vertex] > fine.faces.size())
          return {};
    const LoopStep step(coarse);
    if (step.n_vertices != int(fine.vertices.size()) || step.faces != fine.faces)
      return {};
    return coarse;
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
