// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: files and texts that the tests of output share.

#ifndef tanktread_tests_temporary_folder_h
#define tanktread_tests_temporary_folder_h

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tanktread
{
  namespace fs = std::filesystem;

  /** A folder of its own for each test, removed with all its contents at the end. */
  struct TemporaryFolder
  {
    fs::path path;

    TemporaryFolder()
      : path(fs::temp_directory_path() / ("tanktread_base_tests_" + std::to_string(getpid())))
    {
      fs::remove_all(path);
      fs::create_directories(path);
    }

    ~TemporaryFolder()
    {
      fs::remove_all(path);
    }
  };

  inline void
  write(const fs::path &file, const std::string &text)
  {
    std::ofstream(file) << text;
  }

  inline std::string
  contents(const fs::path &file)
  {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  inline unsigned int
  count(const std::string &text, const std::string &word)
  {
    unsigned int n = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      ++n;
    return n;
  }
} // namespace tanktread

#endif
