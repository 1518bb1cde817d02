// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the shell's surface as VTU files, and a time series of them as a PVD file.

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <tanktread/base/output_file.h>
#include <tanktread/simulation/surface_vtu.h>

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    /** One DataArray. VTK wants the number of bytes (header_type of the file) in front of them, both in one base64 text. */
    template <typename Number>
    void
    write_array(std::ostream &out, const std::string &type, const std::string &name, const std::size_t n_components, const Number *values, const std::size_t n)
    {
      const std::uint64_t        n_bytes = n * sizeof(Number);
      const auto                *head = reinterpret_cast<const unsigned char *>(&n_bytes), *body = reinterpret_cast<const unsigned char *>(values);
      std::vector<unsigned char> bytes(head, head + sizeof(n_bytes));
      bytes.insert(bytes.end(), body, body + n_bytes);
      out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << n_components << "\" format=\"binary\">"
          << dealii::Utilities::encode_base64(bytes) << "</DataArray>\n";
    }

    void
    check_arguments(const ControlPoints                                        &positions,
                    const std::vector<std::array<int, 3>>                      &faces,
                    const std::vector<std::pair<std::string, Eigen::MatrixXd>> &point_fields)
    {
      for (const auto &face : faces)
        for (const int vertex : face)
          if (vertex < 0 || vertex >= positions.rows())
            throw std::invalid_argument("write_surface_vtu: a face has vertex " + std::to_string(vertex) + ", there are " + std::to_string(positions.rows()) +
                                        " positions");
      for (const auto &[name, values] : point_fields)
        if (values.rows() != positions.rows() || (values.cols() != 1 && values.cols() != 3))
          throw std::invalid_argument("write_surface_vtu: field '" + name + "' is " + std::to_string(values.rows()) + " x " + std::to_string(values.cols()) +
                                      ", wanted " + std::to_string(positions.rows()) + " x 1 or x 3");
    }

    void
    write_cells(std::ostream &out, const std::vector<std::array<int, 3>> &faces)
    {
      constexpr std::uint8_t          vtk_triangle = 5;
      std::vector<std::int32_t>       connectivity, offsets;
      const std::vector<std::uint8_t> types(faces.size(), vtk_triangle);
      for (const auto &face : faces)
        {
          connectivity.insert(connectivity.end(), face.begin(), face.end());
          offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
        }
      out << "<Cells>\n";
      write_array(out, "Int32", "connectivity", 1, connectivity.data(), connectivity.size());
      write_array(out, "Int32", "offsets", 1, offsets.data(), offsets.size());
      write_array(out, "UInt8", "types", 1, types.data(), types.size());
      out << "</Cells>\n";
    }

    const char *
    byte_order()
    {
      const std::uint16_t one = 1;
      return *reinterpret_cast<const unsigned char *>(&one) == 1 ? "LittleEndian" : "BigEndian";
    }
  } // namespace


  void
  write_surface_vtu(const std::string                                          &file,
                    const ControlPoints                                        &positions,
                    const std::vector<std::array<int, 3>>                      &faces,
                    const std::vector<std::pair<std::string, Eigen::MatrixXd>> &point_fields)
  {
    check_arguments(positions, faces, point_fields);
    std::ostringstream out;
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" << byte_order() << "\" header_type=\"UInt64\">\n"
        << "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << positions.rows() << "\" NumberOfCells=\"" << faces.size() << "\">\n<Points>\n";
    write_array(out, "Float64", "Points", 3, positions.data(), positions.size());
    out << "</Points>\n";
    write_cells(out, faces);
    const bool has_normals =
      std::any_of(point_fields.begin(), point_fields.end(), [](const auto &field) { return field.first == "normals" && field.second.cols() == 3; });
    out << (has_normals ? "<PointData Normals=\"normals\">\n" : "<PointData>\n");
    for (const auto &[name, values] : point_fields)
      {
        const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_points = values;
        write_array(out, "Float64", name, by_points.cols(), by_points.data(), by_points.size());
      }
    out << "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    replace_file(file, out.str());
  }


  void
  write_surface_pvtu(const std::string &file, const std::vector<std::string> &pieces, const std::vector<std::pair<std::string, unsigned int>> &point_fields)
  {
    std::ostringstream out;
    out << "<?xml version=\"1.0\"?>\n"
        << "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"" << byte_order() << "\" header_type=\"UInt64\">\n"
        << "<PUnstructuredGrid GhostLevel=\"0\">\n"
        << "<PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>\n"
        << "<PPointData>\n";
    for (const auto &[name, n_components] : point_fields)
      out << "<PDataArray type=\"Float64\" Name=\"" << name << "\" NumberOfComponents=\"" << n_components << "\"/>\n";
    out << "</PPointData>\n";
    for (const std::string &piece : pieces)
      out << "<Piece Source=\"" << piece << "\"/>\n";
    out << "</PUnstructuredGrid>\n</VTKFile>\n";
    replace_file(file, out.str());
  }


  PvdFile::PvdFile(std::string file)
    : file(std::move(file))
  {}


  void
  PvdFile::add(const double time, const std::string &data_file)
  {
    all_entries.emplace_back(time, data_file);
    std::ostringstream out;
    dealii::DataOutBase::write_pvd_record(out, all_entries);
    replace_file(file, out.str());
  }
} // namespace tanktread
