// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: writing files so that failing is noticed.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace tanktread
{
  std::string
  cannot_write(const std::string &file, const int error)
  {
    return "cannot write \"" + file + "\"" + (error == 0 ? "" : std::string(": ") + std::strerror(error));
  }

  void
  cut_and_open(std::ofstream &stream, const std::string &file, const std::streamoff size)
  {
    std::error_code error;
    std::filesystem::resize_file(file, size, error);
    if (error)
      throw OutputError(cannot_write(file, error.value()));
    errno = 0;
    stream.open(file, std::ios::app);
    if (!stream)
      throw OutputError(cannot_write(file, errno));
  }

  void
  replace_file(const std::string &file, const std::string &content)
  {
    const std::string unfinished = file + ".part";
    errno                        = 0;
    std::ofstream out(unfinished, std::ios::binary);
    out << content;
    out.close();
    if (!out || std::rename(unfinished.c_str(), file.c_str()) != 0)
      {
        const int error = errno;
        std::remove(unfinished.c_str());
        throw OutputError(cannot_write(file, error));
      }
  }
} // namespace tanktread
