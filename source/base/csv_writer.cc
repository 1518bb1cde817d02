// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tables of numbers as comma-separated text.

#include <tanktread/base/csv_writer.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_file.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace tanktread
{
  namespace
  {
    std::string
    line_of(const std::vector<std::string> &names)
    {
      std::string line;
      for (std::size_t i = 0; i < names.size(); ++i)
        line += (i == 0 ? "" : ",") + names[i];
      return line;
    }
  } // namespace


  CsvWriter::CsvWriter(const std::string &file_name, const std::vector<std::string> &names, const bool active)
    : active(active)
    , file_name(file_name)
    , n_columns(names.size())
  {
    if (!active)
      return;
    errno = 0;
    file.open(file_name);
    write_line(line_of(names));
  }

  CsvWriter::CsvWriter(const std::string &file_name, const std::vector<std::string> &names, const std::streamoff size)
    : active(true)
    , file_name(file_name)
    , n_columns(names.size())
    , size(size)
  {
    std::ifstream before(file_name);
    std::string   line;
    std::getline(before, line);
    before.close();
    std::error_code error;
    if (line != line_of(names) || std::filesystem::file_size(file_name, error) < std::uintmax_t(size) || error)
      throw InputError("\"" + file_name + "\" is not what the run had written: it cannot be continued");
    cut_and_open(file, file_name, size);
  }


  void
  CsvWriter::row(const std::vector<double> &values)
  {
    if (values.size() != n_columns)
      throw std::logic_error(file_name + ": a row of " + std::to_string(values.size()) + " values for " + std::to_string(n_columns) + " columns");
    if (!active)
      return;
    std::string line;
    char        text[40];
    for (std::size_t i = 0; i < values.size(); ++i)
      {
        std::snprintf(text, sizeof(text), i == 0 ? "%.10g" : ",%.10g", values[i]);
        line += text;
      }
    write_line(line);
  }

  void
  CsvWriter::write_line(const std::string &text)
  {
    errno = 0;
    if (file << text << std::endl)
      {
        size += text.size() + 1;
        return;
      }
    const int       error = errno;
    std::error_code ignored;
    file.close();
    std::filesystem::resize_file(file_name, size, ignored);
    throw OutputError(cannot_write(file_name, error));
  }
} // namespace tanktread
