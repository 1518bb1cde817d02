// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the faces of a surface divided into parts of equal size.

#ifndef tanktread_surface_face_partition_h
#define tanktread_surface_face_partition_h

#include <tanktread/surface/triangle_mesh.h>

#include <vector>

namespace tanktread
{
  /**
   * Divides the faces of `topology` into `n_parts` parts of about equal size and short boundaries: METIS on the graph of faces that share an edge. Entry r
   * lists the
   * faces of part r in ascending order; each face is in one part. Same input, same result. With as many parts as faces or more, face f is
   * part f. Throws std::logic_error for n_parts = 0.
   */
  std::vector<std::vector<unsigned int>>
  partition_faces(const TriangleMesh &topology, unsigned int n_parts);
} // namespace tanktread

#endif
