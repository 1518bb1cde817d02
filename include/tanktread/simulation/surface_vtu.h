// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the shell's surface as VTU files, and a time series of them as a PVD file.

#ifndef tanktread_simulation_surface_vtu_h
#define tanktread_simulation_surface_vtu_h

#include <tanktread/surface/types.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /**
   * Writes a triangulated surface with point data as a VTU file (UnstructuredGrid, double precision, inline base64), as ParaView, VTK and meshio read it.
   * The file appears under its name only when it is complete.
   *
   * @param positions    NP x 3, unit a: points on the limit surface (not the control points, which do not lie on it).
   * @param faces        vertex indices in 0 ... NP - 1, outward oriented.
   * @param point_fields name and values, NP x 1 (scalar) or NP x 3 (vector). Names are written as they are: no <, & or quotes. A vector
   * field "normals" is marked as the one to shade the surface by.
   * @throws std::invalid_argument for fields of another shape or indices out of range, OutputError if the file cannot be written.
   */
  void
  write_surface_vtu(const std::string                                          &file,
                    const ControlPoints                                        &positions,
                    const std::vector<std::array<int, 3>>                      &faces,
                    const std::vector<std::pair<std::string, Eigen::MatrixXd>> &point_fields);

  /** The record of surfaces that lie in several files of write_surface_vtu(), as a PVTU file. @param pieces relative to its folder. @param point_fields name and number of components of each. Throws OutputError. */
  void
  write_surface_pvtu(const std::string &file, const std::vector<std::string> &pieces, const std::vector<std::pair<std::string, unsigned int>> &point_fields);

  /**
   * A ParaView data file: the list of the times of a run (12 digits) and of the VTU or PVTU files that belong to them. The file on disk is replaced at each new
   * entry, so a run that is killed leaves a readable series.
   */
  class PvdFile
  {
  public:
    /** Nothing is written before the first entry. */
    explicit PvdFile(std::string file);

    /** Appends an entry and rewrites the file. `data_file` is relative to the folder of the PVD file. Throws OutputError if it cannot be written. */
    void
    add(double time, const std::string &data_file);

    /** Times and data files. */
    const std::vector<std::pair<double, std::string>> &
    entries() const
    {
      return all_entries;
    }
    /** Those of a run that goes on; written with the next entry. */
    void
    set_entries(std::vector<std::pair<double, std::string>> entries)
    {
      all_entries = std::move(entries);
    }

  private:
    std::string                                 file;
    std::vector<std::pair<double, std::string>> all_entries;
  };
} // namespace tanktread

#endif
