// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the check that a triangle mesh is a closed surface.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/triangle_mesh.h>

#include <Eigen/Geometry>

#include <map>
#include <utility>

namespace tanktread
{
  namespace
  {
    std::string
    face_text(const TriangleMesh &mesh, const std::size_t f)
    {
      return "face " + std::to_string(f) + " (vertices " + std::to_string(mesh.faces[f][0]) + ", " + std::to_string(mesh.faces[f][1]) + ", " +
        std::to_string(mesh.faces[f][2]) + ")";
    }

    void
    check_vertices(const TriangleMesh &mesh, const std::string &name)
    {
      std::map<std::array<double, 3>, std::size_t> seen;
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        {
          const Eigen::Vector3d &x = mesh.vertices[v];
          if (!x.allFinite())
            throw InputError(name + ": vertex " + std::to_string(v) + " has a coordinate that is not finite.");
          const auto [entry, is_new] = seen.emplace(std::array<double, 3>{{x[0], x[1], x[2]}}, v);
          if (!is_new)
            throw InputError(name + ": vertices " + std::to_string(entry->second) + " and " + std::to_string(v) +
                             " have the same position; faces that meet have to share the vertex.");
        }
    }

    /** Maps each directed edge (from, to) to the face on its left. */
    using EdgeMap = std::map<std::pair<int, int>, std::size_t>;

    EdgeMap
    check_edges(const TriangleMesh &mesh, const std::string &name)
    {
      EdgeMap edges;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        {
          const auto &face = mesh.faces[f];
          for (const int v : face)
            if (v < 0 || v >= int(mesh.vertices.size()))
              throw InputError(name + ": " + face_text(mesh, f) + " names a vertex that does not exist; there are " + std::to_string(mesh.vertices.size()) +
                               ".");
          if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
            throw InputError(name + ": " + face_text(mesh, f) + " names a vertex twice.");
          for (unsigned int i = 0; i < 3; ++i)
            {
              const int a = face[i], b = face[(i + 1) % 3];
              const auto [entry, is_new] = edges.emplace(std::make_pair(a, b), f);
              if (!is_new)
                throw InputError(name + ": edge " + std::to_string(a) + "-" + std::to_string(b) + " runs in the same direction in " +
                                 face_text(mesh, entry->second) + " and " + face_text(mesh, f) +
                                 "; neighbouring faces have to be oriented alike, and an edge has two faces.");
            }
        }
      for (const auto &[edge, f] : edges)
        if (edges.count({edge.second, edge.first}) == 0)
          throw InputError(name + ": edge " + std::to_string(edge.first) + "-" + std::to_string(edge.second) + " of " + face_text(mesh, f) +
                           " has no second face; the surface has to be closed.");
      return edges;
    }

    /** Walks around every vertex: each has faces, and they form one fan. */
    void
    check_fans(const TriangleMesh &mesh, const EdgeMap &edges, const std::string &name)
    {
      std::vector<unsigned int> n_faces(mesh.vertices.size(), 0);
      std::vector<int>          some_neighbour(mesh.vertices.size(), -1);
      for (const auto &face : mesh.faces)
        for (unsigned int i = 0; i < 3; ++i)
          {
            ++n_faces[face[i]];
            some_neighbour[face[i]] = face[(i + 1) % 3];
          }
      for (int v = 0; v < int(mesh.vertices.size()); ++v)
        {
          if (n_faces[v] == 0)
            throw InputError(name + ": vertex " + std::to_string(v) + " belongs to no face.");
          unsigned int n_in_fan = 0;
          int          u        = some_neighbour[v];
          do
            {
              const auto &face = mesh.faces[edges.at({v, u})];
              for (const int w : face)
                if (w != v && w != u)
                  {
                    u = w;
                    break;
                  }
              ++n_in_fan;
          } while (u != some_neighbour[v] && n_in_fan <= n_faces[v]);
          if (n_in_fan != n_faces[v])
            throw InputError(name + ": the surface touches itself at vertex " + std::to_string(v) + ".");
          if (n_faces[v] < 3)
            throw InputError(name + ": vertex " + std::to_string(v) + " has only " + std::to_string(n_faces[v]) + " faces; at least 3 are needed.");
        }
    }

    void
    check_one_component(const TriangleMesh &mesh, const EdgeMap &edges, const std::string &name)
    {
      std::vector<bool> reached(mesh.vertices.size(), false);
      std::vector<int>  front = {0};
      reached[0]              = true;
      while (!front.empty())
        {
          const int v = front.back();
          front.pop_back();
          for (auto edge = edges.lower_bound({v, 0}); edge != edges.end() && edge->first.first == v; ++edge)
            if (const int u = edge->first.second; !reached[u])
              {
                reached[u] = true;
                front.push_back(u);
              }
        }
      for (std::size_t v = 0; v < reached.size(); ++v)
        if (!reached[v])
          throw InputError(name + ": the surface has several components; no chain of edges joins vertex 0 and vertex " + std::to_string(v) + ".");
    }
  } // namespace


  void
  check_closed_surface(const TriangleMesh &mesh, const std::string &name)
  {
    if (mesh.faces.empty())
      throw InputError(name + ": there are no faces.");
    check_vertices(mesh, name);
    const EdgeMap edges = check_edges(mesh, name);
    check_fans(mesh, edges, name);
    check_one_component(mesh, edges, name);

    const long euler = long(mesh.vertices.size()) - long(edges.size() / 2) + long(mesh.faces.size());
    if (euler != 2)
      throw InputError(name + ": vertices - edges + faces is " + std::to_string(euler) + ", not 2: the surface has handles, it is no deformed sphere.");

    double volume = 0;
    for (const auto &[a, b, c] : mesh.faces)
      volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.;
    if (!(volume > 0))
      throw InputError(name + ": the enclosed volume is " + std::to_string(volume) +
                       "; vertices of a face have to be listed counter-clockwise when seen from outside.");
  }
} // namespace tanktread
