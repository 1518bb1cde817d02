// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: writing files so that failing is noticed.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace tanktread
{
  std::string
  cannot_write(const std::string &file, const int error)
  {
    return "cannot write \"" + file + "\"" + (error == 0 ? "" : std::string(": ") + std::strerror(error));
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
