// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tables of numbers as comma-separated text.

#ifndef tanktread_base_csv_writer_h
#define tanktread_base_csv_writer_h

#include <fstream>
#include <string>
#include <vector>

namespace tanktread
{
  /** A file with one line of column names and one line a row (%.10g); each row is on disk when row() returns. */
  class CsvWriter
  {
  public:
    /**
     * Starts `file_name` with the line of `names`. An inactive writer (on all ranks but the first) touches no file.
     * @throws OutputError when the file cannot be written.
     */
    CsvWriter(const std::string &file_name, const std::vector<std::string> &names, bool active = true);

    /**
     * Goes on with `file_name`, cut off after its first `size` bytes. @throws OutputError when that cannot be done, InputError where the file has other columns or is shorter.
     */
    CsvWriter(const std::string &file_name, const std::vector<std::string> &names, std::streamoff size);

    /** Bytes of the whole rows. */
    std::streamoff
    written() const
    {
      return size;
    }

    /**
     * Writes one row; `values` has one entry for each name.
     * @throws std::logic_error for another number of values, OutputError when writing fails (a full disk); the file then ends with the last whole row.
     */
    void
    row(const std::vector<double> &values);

  private:
    void
    write_line(const std::string &text);

    const bool        active;
    const std::string file_name;
    const std::size_t n_columns;
    std::ofstream     file;
    std::streamoff    size = 0; // of the whole rows
  };
} // namespace tanktread

#endif
