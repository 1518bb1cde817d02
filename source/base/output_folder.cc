// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the folder that a run writes to.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_folder.h>

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace tanktread
{
  namespace
  {
    namespace fs = std::filesystem;

    [[noreturn]] void
    refuse(const fs::path &folder, const std::string &reason)
    {
      throw InputError("Output/Directory is \"" + folder.string() + "\", which cannot be written: " + reason);
    }

    /** `folder` without trailing slashes and dots. */
    fs::path
    normal(const std::string &folder)
    {
      fs::path path = fs::path(folder).lexically_normal();
      return path.has_filename() ? path : path.parent_path();
    }

    /** What every run leaves: of one capsule or very many, or of the first of several. */
    bool
    is_history(const fs::path &file)
    {
      return file.filename() == "history.csv" || file.filename() == "history_1.csv";
    }

    bool
    holds_a_run(const fs::path &folder)
    {
      std::error_code error;
      return fs::exists(folder / "history.csv", error) || fs::exists(folder / "history_1.csv", error);
    }

    /** A run has no folders inside; what has a run further down is somebody's collection of runs. */
    bool
    holds_nothing_but_a_run(const fs::path &folder)
    {
      for (const auto &entry : fs::recursive_directory_iterator(folder))
        if (is_history(entry.path()) && entry.path().parent_path() != folder)
          return false;
      return holds_a_run(folder);
    }

    /** Moves `folder` to `folder`.previous. Something of that name which is more than a run is somebody's and stays. */
    fs::path
    move_aside(const fs::path &folder)
    {
      const fs::path  aside = folder.string() + ".previous";
      std::error_code error;
      if (fs::exists(aside, error) && !(fs::is_directory(aside, error) && holds_nothing_but_a_run(aside)))
        refuse(folder, "it holds a former run, which cannot be moved to \"" + aside.string() + "\" because that exists and is no run, or more than one");
      fs::remove_all(aside, error);
      if (!error)
        fs::rename(folder, aside, error);
      if (error)
        refuse(folder, "it holds a former run, which cannot be moved to \"" + aside.string() + "\" (" + error.message() + ")");
      return aside;
    }

    /** Makes and removes a folder inside of `existing`: permission bits say nothing to root and about file systems that are not real. */
    void
    check_writing(const fs::path &folder, const fs::path &existing)
    {
      std::string probe = (existing / ".tanktread_XXXXXX").string();
      if (mkdtemp(&probe[0]) == nullptr)
        refuse(folder, "\"" + existing.string() + "\": " + std::strerror(errno));
      rmdir(probe.c_str());
    }
  } // namespace

  void
  check_output_folder(const std::string &folder)
  {
    if (folder.empty())
      throw InputError("Output/Directory is empty; allowed: name of a folder");
    const fs::path  path     = normal(folder);
    fs::path        existing = fs::absolute(path);
    std::error_code error;
    while (!fs::exists(existing, error))
      {
        if (error && error != std::errc::not_a_directory)
          refuse(path, "\"" + existing.string() + "\" cannot be looked at (" + error.message() + ")");
        existing = existing.parent_path();
      }
    if (!fs::is_directory(existing))
      refuse(path, "\"" + existing.string() + "\" is not a folder");
    check_writing(path, existing);
  }

  std::string
  prepare_output_folder(const std::string &folder)
  {
    check_output_folder(folder);
    const fs::path    path  = normal(folder);
    const std::string aside = holds_a_run(path) ? move_aside(path).string() : "";
    std::error_code   error;
    fs::create_directories(path, error);
    if (error)
      refuse(path, error.message());
    check_writing(path, path);
    return aside;
  }
} // namespace tanktread
