// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: reading triangle meshes from legacy VTK files.

#ifndef tanktread_surface_read_vtk_h
#define tanktread_surface_read_vtk_h

#include <tanktread/surface/triangle_mesh.h>

#include <string>

namespace tanktread
{
  /**
   * Reads a legacy VTK file (.vtk) in ASCII of any version: the POINTS and POLYGONS of a POLYDATA or the POINTS and CELLS of an UNSTRUCTURED_GRID. Data on
   * points
   * and cells are ignored. Throws InputError with file and line when the file cannot be opened, is binary, ends early, or has cells that are no triangles.
   */
  TriangleMesh
  read_legacy_vtk(const std::string &file);
} // namespace tanktread

#endif
