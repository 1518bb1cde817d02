// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: reading triangle meshes from OFF and OBJ files, and choosing the reader.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/read_vtk.h>
#include <tanktread/surface/triangle_mesh.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

namespace tanktread
{
  namespace
  {
    /** Lines of a text file without comments, remembering where it is. */
    class LineReader
    {
    public:
      explicit LineReader(const std::string &file)
        : file(file)
        , stream(file)
      {
        if (!stream)
          throw InputError("Mesh file '" + file + "' cannot be opened.");
      }

      /** Moves to the next line that is not empty; false at the end of the file. */
      bool
      next(std::istringstream &line)
      {
        std::string text;
        while (std::getline(stream, text))
          {
            ++number;
            text = text.substr(0, text.find('#'));
            if (text.find_first_not_of(" \t\r") != std::string::npos)
              {
                line.clear();
                line.str(text);
                return true;
              }
          }
        return false;
      }

      [[noreturn]] void
      fail(const std::string &message) const
      {
        throw InputError("Mesh file '" + file + "', line " + std::to_string(number) + ": " + message);
      }

    private:
      std::string   file;
      std::ifstream stream;
      unsigned int  number = 0;
    };

    Eigen::Vector3d
    read_vertex(const LineReader &reader, std::istringstream &line)
    {
      Eigen::Vector3d x;
      if (!(line >> x[0] >> x[1] >> x[2]))
        reader.fail("a vertex needs three coordinates.");
      return x;
    }

    TriangleMesh
    read_off(LineReader &reader)
    {
      std::istringstream line;
      std::string        word;
      if (!reader.next(line) || !(line >> word) || word != "OFF")
        reader.fail("an OFF file begins with the word OFF.");
      std::size_t n_vertices = 0, n_faces = 0;
      if (!(line >> n_vertices >> n_faces) && (!reader.next(line) || !(line >> n_vertices >> n_faces)))
        reader.fail("the numbers of vertices and faces are expected.");

      TriangleMesh mesh;
      for (std::size_t v = 0; v < n_vertices; ++v)
        {
          if (!reader.next(line))
            reader.fail("the file ends after " + std::to_string(v) + " of " + std::to_string(n_vertices) + " vertices.");
          mesh.vertices.push_back(read_vertex(reader, line));
        }
      for (std::size_t f = 0; f < n_faces; ++f)
        {
          if (!reader.next(line))
            reader.fail("the file ends after " + std::to_string(f) + " of " + std::to_string(n_faces) + " faces.");
          int                n = 0;
          std::array<int, 3> face;
          if (!(line >> n >> face[0] >> face[1] >> face[2]) || n != 3)
            reader.fail("a face has to be '3' and three vertex numbers; only triangles are read.");
          mesh.faces.push_back(face);
        }
      return mesh;
    }

    /** "7", "7/2", "7//3" or "7/2/3" -> 6; negative numbers count from the last vertex. */
    int
    obj_vertex_index(const LineReader &reader, const std::string &word, const std::size_t n_vertices)
    {
      int                index = 0;
      std::istringstream stream(word.substr(0, word.find('/')));
      if (!(stream >> index) || index == 0)
        reader.fail("'" + word + "' is no vertex number.");
      return index > 0 ? index - 1 : int(n_vertices) + index;
    }

    TriangleMesh
    read_obj(LineReader &reader)
    {
      TriangleMesh       mesh;
      std::istringstream line;
      while (reader.next(line))
        {
          std::string keyword;
          line >> keyword;
          if (keyword == "v")
            mesh.vertices.push_back(read_vertex(reader, line));
          else if (keyword == "f")
            {
              std::vector<int> indices;
              std::string      word;
              while (line >> word)
                indices.push_back(obj_vertex_index(reader, word, mesh.vertices.size()));
              if (indices.size() != 3)
                reader.fail("a face with " + std::to_string(indices.size()) + " vertices; only triangles are read.");
              mesh.faces.push_back({{indices[0], indices[1], indices[2]}});
            }
        }
      return mesh;
    }
  } // namespace


  TriangleMesh
  read_triangle_mesh(const std::string &file)
  {
    const std::size_t dot       = file.rfind('.');
    std::string       extension = dot == std::string::npos ? "" : file.substr(dot + 1);
    std::transform(extension.begin(), extension.end(), extension.begin(), [](const unsigned char c) { return std::tolower(c); });
    if (extension == "vtk")
      return read_legacy_vtk(file);
    if (extension != "off" && extension != "obj")
      throw InputError("Mesh file '" + file + "': the name has to end in .off, .obj or .vtk.");
    LineReader reader(file);
    return extension == "off" ? read_off(reader) : read_obj(reader);
  }
} // namespace tanktread
