// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tables of numbers as comma-separated text.

#include <tanktread/base/csv_writer.h>
#include <tanktread/base/exceptions.h>

#include <cstdio>

namespace tanktread
{
  CsvWriter::CsvWriter(const std::string &file_name, const std::vector<std::string> &names, const bool active)
    : active(active)
    , file_name(file_name)
    , n_columns(names.size())
  {
    if (!active)
      return;
    file.open(file_name);
    for (std::size_t i = 0; i < names.size(); ++i)
      file << (i == 0 ? "" : ",") << names[i];
    file << std::endl;
    if (!file)
      throw InputError("cannot write \"" + file_name + "\"");
  }

  void
  CsvWriter::row(const std::vector<double> &values)
  {
    if (values.size() != n_columns)
      throw std::logic_error(file_name + ": a row of " + std::to_string(values.size()) + " values for " + std::to_string(n_columns) + " columns");
    if (!active)
      return;
    char text[40];
    for (std::size_t i = 0; i < values.size(); ++i)
      {
        std::snprintf(text, sizeof(text), "%.10g", values[i]);
        file << (i == 0 ? "" : ",") << text;
      }
    file << std::endl;
    if (!file)
      throw std::runtime_error("cannot write \"" + file_name + "\" (is the disk full?)");
  }
} // namespace tanktread
