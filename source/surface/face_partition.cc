// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the faces of a surface divided into parts of equal size.

#include <tanktread/surface/face_partition.h>

#include <metis.h>

#include <numeric>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    /** Part of each face. */
    std::vector<idx_t>
    metis_parts(const TriangleMesh &topology, const unsigned int n_parts)
    {
      std::vector<idx_t> starts, vertices;
      for (const auto &face : topology.faces)
        {
          starts.push_back(idx_t(vertices.size()));
          vertices.insert(vertices.end(), face.begin(), face.end());
        }
      starts.push_back(idx_t(vertices.size()));

      idx_t n_faces = idx_t(topology.faces.size()), n_vertices = 0, n_common = 2, parts = idx_t(n_parts), cut;
      for (const idx_t vertex : vertices)
        n_vertices = std::max(n_vertices, vertex + 1);
      std::vector<idx_t> part_of_face(n_faces), part_of_vertex(n_vertices);
      if (METIS_PartMeshDual(&n_faces,
                             &n_vertices,
                             starts.data(),
                             vertices.data(),
                             nullptr,
                             nullptr,
                             &n_common,
                             &parts,
                             nullptr,
                             nullptr,
                             &cut,
                             part_of_face.data(),
                             part_of_vertex.data()) != METIS_OK)
        throw std::runtime_error("METIS cannot divide the faces of the shell into " + std::to_string(n_parts) + " parts.");
      return part_of_face;
    }
  } // namespace


  std::vector<std::vector<unsigned int>>
  partition_faces(const TriangleMesh &topology, const unsigned int n_parts)
  {
    if (n_parts == 0)
      throw std::logic_error("partition_faces() got no parts.");
    const std::size_t  n_faces = topology.faces.size();
    std::vector<idx_t> part(n_faces, 0);
    if (n_parts >= n_faces)
      std::iota(part.begin(), part.end(), 0);
    else if (n_parts > 1)
      part = metis_parts(topology, n_parts);

    std::vector<std::vector<unsigned int>> result(n_parts);
    for (std::size_t face = 0; face < n_faces; ++face)
      result[part[face]].push_back(face);
    return result;
  }
} // namespace tanktread
