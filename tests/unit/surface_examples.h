// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: meshes and fields that the tests of the surface layer share.

#ifndef tanktread_tests_surface_examples_h
#define tanktread_tests_surface_examples_h

#include <tanktread/surface/triangle_mesh.h>
#include <tanktread/surface/types.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace tanktread
{
  inline ControlPoints
  positions(const TriangleMesh &mesh)
  {
    ControlPoints x(mesh.vertices.size(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x.row(i) = mesh.vertices[i];
    return x;
  }

  inline ControlPoints
  random_field(const Eigen::Index n, const double size, const unsigned int seed)
  {
    std::mt19937                           engine(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return ControlPoints::NullaryExpr(n, 3, [&]() { return uniform(engine); });
  }

  inline TriangleMesh
  octahedron()
  {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}}, {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}}};
  }

  /** Icosphere with one edge flipped in the midst of vertices of valence 6: valences 5, 6 and 7. */
  inline TriangleMesh
  flipped_icosphere()
  {
    TriangleMesh                               mesh = icosphere(2);
    std::map<std::pair<int, int>, std::size_t> left;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (unsigned int i = 0; i < 3; ++i)
        left[{mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]}] = f;
    const auto opposite = [](const std::array<int, 3> &face, const int a, const int b) { return face[0] + face[1] + face[2] - a - b; };
    for (const auto &[edge, f] : left)
      if (edge.first > 42 && edge.second > 42)
        {
          const std::size_t g = left.at({edge.second, edge.first});
          const int         c = opposite(mesh.faces[f], edge.first, edge.second), d = opposite(mesh.faces[g], edge.first, edge.second);
          if (c < 12 || d < 12)
            continue;
          mesh.faces[f] = {{edge.first, d, c}};
          mesh.faces[g] = {{edge.second, c, d}};
          break;
        }
    return mesh;
  }

  inline double
  distance(const SparseMatrix &a, const SparseMatrix &b)
  {
    return SparseMatrix(a - b).norm();
  }

  inline double
  order(const double coarse, const double fine)
  {
    return std::log2(coarse / fine);
  }

  inline std::string
  write_file(const std::string &name, const std::string &text)
  {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << text;
    return path;
  }
} // namespace tanktread

#endif
