// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: reading triangle meshes from legacy VTK files.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/read_vtk.h>

#include <fstream>
#include <sstream>

namespace tanktread
{
  namespace
  {
    /** Words of a text file, remembering the line. */
    class WordReader
    {
    public:
      explicit WordReader(const std::string &file)
        : file(file)
        , stream(file)
      {
        if (!stream)
          throw InputError("Mesh file '" + file + "' cannot be opened.");
      }

      /** Moves to the next line and returns it; false at the end of the file. */
      bool
      next_line(std::string &text)
      {
        if (!std::getline(stream, text))
          return false;
        ++number;
        line.clear();
        line.str(text);
        return true;
      }

      bool
      next(std::string &word)
      {
        std::string text;
        while (!(line >> word))
          if (!next_line(text))
            return false;
        return true;
      }

      void
      skip_line()
      {
        line.str("");
      }

      template <typename Number>
      Number
      get(const std::string &what)
      {
        std::string word, rest;
        Number      value;
        if (!next(word))
          fail("the file ends where " + what + " is expected.");
        std::istringstream text(word);
        if (!(text >> value) || (text >> rest))
          fail("'" + word + "' where " + what + " is expected.");
        return value;
      }

      /** A number of items that the file could hold. */
      std::size_t
      get_size(const std::string &what)
      {
        const long size = get<long>(what);
        if (size < 0 || size > 100000000)
          fail(std::to_string(size) + " where " + what + " is expected.");
        return size;
      }

      [[noreturn]] void
      fail(const std::string &message) const
      {
        throw InputError("Mesh file '" + file + "', line " + std::to_string(number) + ": " + message);
      }

    private:
      std::string        file;
      std::ifstream      stream;
      std::istringstream line;
      unsigned int       number = 0;
    };

    void
    read_head(WordReader &reader)
    {
      std::string text, word;
      if (!reader.next_line(text) || text.compare(0, 22, "# vtk DataFile Version") != 0)
        reader.fail("a legacy VTK file begins with '# vtk DataFile Version'.");
      reader.next_line(text); // title
      reader.skip_line();
      if (!reader.next(word) || word != "ASCII")
        reader.fail("only VTK files in ASCII are read.");
      if (!reader.next(word) || word != "DATASET" || !reader.next(word) || (word != "POLYDATA" && word != "UNSTRUCTURED_GRID"))
        reader.fail("DATASET POLYDATA or DATASET UNSTRUCTURED_GRID is expected.");
    }

    /** After POINTS. */
    void
    read_points(WordReader &reader, TriangleMesh &mesh)
    {
      const std::size_t n = reader.get_size("the number of points");
      reader.get<std::string>("the type of the points");
      for (std::size_t v = 0; v < n; ++v)
        {
          mesh.vertices.emplace_back();
          for (int c = 0; c < 3; ++c)
            mesh.vertices.back()[c] = reader.get<double>("a coordinate");
        }
    }

    void
    add_triangle(WordReader &reader, TriangleMesh &mesh)
    {
      std::array<int, 3> face;
      for (int &vertex : face)
        vertex = reader.get<int>("the number of a point");
      mesh.faces.push_back(face);
    }

    /**
     * After POLYGONS or CELLS. Up to version 4 each cell stands behind its number of points; later the offsets of all cells, one more than there are cells,
     * stand
     * before them.
     */
    void
    read_cells(WordReader &reader, TriangleMesh &mesh)
    {
      const std::size_t n = reader.get_size("the number of cells"), n_numbers = reader.get_size("the number of numbers");
      std::string       word;
      if (n == 0)
        return;
      if (!reader.next(word))
        reader.fail("the file ends where cells are expected.");
      if (word != "OFFSETS")
        for (std::size_t cell = 0; cell < n; ++cell)
          {
            if (cell > 0)
              word = reader.get<std::string>("a cell");
            if (word != "3")
              reader.fail("a cell with " + word + " points; only triangles are read.");
            add_triangle(reader, mesh);
          }
      else
        {
          reader.get<std::string>("the type of the offsets");
          for (std::size_t cell = 0; cell < n; ++cell)
            if (reader.get_size("an offset") != 3 * cell)
              reader.fail("a cell that is no triangle; only triangles are read.");
          if (reader.get<std::string>("CONNECTIVITY") != "CONNECTIVITY" || n_numbers != 3 * (n - 1))
            reader.fail("CONNECTIVITY with three numbers a cell is expected.");
          reader.get<std::string>("the type of the connectivity");
          for (std::size_t cell = 0; cell + 1 < n; ++cell)
            add_triangle(reader, mesh);
        }
    }

    /** After CELL_TYPES. */
    void
    check_cell_types(WordReader &reader)
    {
      const std::size_t n = reader.get_size("the number of cells");
      for (std::size_t cell = 0; cell < n; ++cell)
        if (reader.get_size("the type of a cell") != 5)
          reader.fail("a cell that is no triangle (type 5); only triangles are read.");
    }
  } // namespace


  TriangleMesh
  read_legacy_vtk(const std::string &file)
  {
    WordReader   reader(file);
    TriangleMesh mesh;
    std::string  word;
    read_head(reader);
    while (reader.next(word) && word != "POINT_DATA" && word != "CELL_DATA")
      if (word == "POINTS")
        read_points(reader, mesh);
      else if (word == "POLYGONS" || word == "CELLS")
        read_cells(reader, mesh);
      else if (word == "CELL_TYPES")
        check_cell_types(reader);
      else if (word == "VERTICES" || word == "LINES" || word == "TRIANGLE_STRIPS")
        reader.fail(word + ": only triangles are read.");
      else
        reader.skip_line(); // METADATA, FIELD and their lines
    if (mesh.vertices.empty() || mesh.faces.empty())
      reader.fail("the file ends without points or without triangles.");
    return mesh;
  }
} // namespace tanktread
