// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the limit surface as a fine triangle mesh with its normals, for pictures.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/limit_picture.h>
#include <tanktread/surface/subdivision_surface.h>

#include <Eigen/Geometry>

#include <cmath>
#include <string>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** The neighbours of each vertex, counter-clockwise. */
    std::vector<std::vector<int>>
    rings(const TriangleMesh &mesh)
    {
      std::vector<std::vector<std::pair<int, int>>> edges(mesh.vertices.size()); // opposite to each vertex, in the sense of their faces
      for (const auto &face : mesh.faces)
        for (unsigned int i = 0; i < 3; ++i)
          edges[face[i]].emplace_back(face[(i + 1) % 3], face[(i + 2) % 3]);
      std::vector<std::vector<int>> result;
      for (const auto &of_vertex : edges)
        {
          std::vector<int> ring = {of_vertex.front().first};
          while (ring.size() < of_vertex.size())
            for (const auto &[from, to] : of_vertex)
              if (from == ring.back())
                {
                  ring.push_back(to);
                  break;
                }
          result.push_back(std::move(ring));
        }
      return result;
    }

    /** T_1 and T_2 of a mesh. */
    std::pair<SparseMatrix, SparseMatrix>
    tangent_stencils(const TriangleMesh &mesh)
    {
      const auto                          neighbours = rings(mesh);
      const Eigen::Index                  n          = Eigen::Index(neighbours.size());
      std::vector<Eigen::Triplet<double>> cosines, sines;
      for (Eigen::Index v = 0; v < n; ++v)
        for (std::size_t i = 0; i < neighbours[v].size(); ++i)
          {
            const double angle = 2. * M_PI * double(i) / double(neighbours[v].size());
            cosines.emplace_back(v, neighbours[v][i], std::cos(angle));
            sines.emplace_back(v, neighbours[v][i], std::sin(angle));
          }
      std::pair<SparseMatrix, SparseMatrix> result{SparseMatrix(n, n), SparseMatrix(n, n)};
      result.first.setFromTriplets(cosines.begin(), cosines.end());
      result.second.setFromTriplets(sines.begin(), sines.end());
      return result;
    }
  } // namespace


  LimitPicture::LimitPicture(const TriangleMesh &topology, const unsigned int n_subdivisions)
  {
    TriangleMesh mesh = topology;
    SparseMatrix subdivision(Eigen::Index(mesh.vertices.size()), Eigen::Index(mesh.vertices.size()));
    subdivision.setIdentity();
    for (unsigned int l = 0; l < n_subdivisions; ++l)
      {
        subdivision = loop_subdivision(mesh) * subdivision;
        mesh        = loop_refine(mesh);
      }
    const auto [T_1, T_2] = tangent_stencils(mesh);
    S_                    = vertex_limit_stencils(mesh) * subdivision;
    T_1_                  = T_1 * subdivision;
    T_2_                  = T_2 * subdivision;
    faces_                = std::move(mesh.faces);
  }


  ControlPoints
  LimitPicture::normals(const ControlPoints &x) const
  {
    const ControlPoints a = T_1_ * x, b = T_2_ * x;
    ControlPoints       result(a.rows(), 3);
    for (Eigen::Index v = 0; v < a.rows(); ++v)
      {
        const Eigen::RowVector3d along  = a.row(v).cross(b.row(v));
        const double             length = along.norm();
        if (!(length > 0.) || !std::isfinite(length))
          throw NumericalError("The shell's surface has no normal at point " + std::to_string(v) + " of its picture.");
        result.row(v) = along / length;
      }
    return result;
  }
} // namespace tanktread
