// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: checkpoints as folders on disk, which are whole or known to be damaged.

#include <tanktread/base/checkpoint_folder.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <boost/crc.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace tanktread
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr const char *first_line    = "Tanktread checkpoint, format 1";
    constexpr const char *manifest_name = "manifest.txt";
    constexpr const char *prefix = "step_", *suffix = ".part";

    std::string
    name_of(const unsigned int step)
    {
      std::ostringstream text;
      text << prefix << std::setw(8) << std::setfill('0') << step;
      return text.str();
    }


    /** A name that name_of() has made. */
    bool
    is_name(const std::string &name)
    {
      const std::string number = name.substr(std::min(name.size(), std::string(prefix).size()));
      return name.rfind(prefix, 0) == 0 && number.size() >= 8 && number.find_first_not_of("0123456789") == std::string::npos;
    }


    /** Asks the system to bring a file, or the list of files of a folder, to the disk. */
    bool
    bring_to_disk(const std::string &path)
    {
      const int file = ::open(path.c_str(), O_RDONLY);
      if (file < 0)
        return false;
      const bool done  = ::fsync(file) == 0;
      const int  error = errno;
      ::close(file);
      errno = error;
      return done;
    }


    void
    write_file(const std::string &file, const std::string &bytes)
    {
      errno = 0;
      std::ofstream out(file, std::ios::binary);
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      out.close();
      if (out && bring_to_disk(file))
        return;
      const int error = errno;
      std::remove(file.c_str());
      throw OutputError(cannot_write(file, error));
    }


    std::string
    read_file(const std::string &file)
    {
      std::ifstream     in(file, std::ios::binary);
      std::stringstream bytes;
      bytes << in.rdbuf();
      if (!in)
        throw InputError("cannot read \"" + file + "\"");
      return bytes.str();
    }


    std::string
    sum_line(const std::string &text)
    {
      std::ostringstream line;
      line << "sum " << std::hex << std::setw(8) << std::setfill('0') << checksum(text) << '\n';
      return line.str();
    }
  } // namespace


  std::uint32_t
  checksum(const std::string &bytes)
  {
    boost::crc_32_type sum;
    sum.process_bytes(bytes.data(), bytes.size());
    return sum.checksum();
  }


  std::string
  manifest_text(const CheckpointManifest &manifest)
  {
    std::ostringstream text;
    text << first_line << '\n'
         << "program " << manifest.program << '\n'
         << "step " << manifest.step << '\n'
         << "time " << std::setprecision(17) << manifest.time << '\n'
         << "pieces " << manifest.pieces.size() << '\n';
    for (const CheckpointPiece &piece : manifest.pieces)
      text << piece.name << ' ' << piece.size << ' ' << piece.sum << '\n';
    return text.str() + sum_line(text.str());
  }


  CheckpointManifest
  read_manifest(const std::string &text)
  {
    const std::size_t end = text.size() < sum_line("").size() ? 0 : text.size() - sum_line("").size();
    if (text.substr(end) != sum_line(text.substr(0, end)))
      throw InputError("its manifest is damaged");
    std::istringstream in(text);
    std::string        line, word;
    std::getline(in, line);
    if (line != first_line)
      throw InputError("it begins with \"" + line + "\"; allowed: \"" + first_line + "\"");
    CheckpointManifest result;
    std::size_t        n_pieces = 0;
    in >> word >> std::ws;
    std::getline(in, result.program);
    in >> word >> result.step >> word >> result.time >> word >> n_pieces;
    for (std::size_t i = 0; i < n_pieces && in; ++i)
      {
        CheckpointPiece piece;
        in >> piece.name >> piece.size >> piece.sum;
        result.pieces.push_back(piece);
      }
    if (!in)
      throw InputError("its manifest cannot be understood");
    return result;
  }


  CheckpointFolder::CheckpointFolder(const std::string &run)
    : path_(run + "/checkpoints")
  {}


  std::string
  CheckpointFolder::unfinished(const unsigned int step) const
  {
    return path_ + "/" + name_of(step) + suffix;
  }


  void
  CheckpointFolder::begin(const unsigned int step) const
  {
    std::error_code error;
    fs::remove_all(unfinished(step), error);
    if (!error)
      fs::create_directories(unfinished(step), error);
    if (error)
      throw OutputError(cannot_write(unfinished(step), error.value()));
  }


  CheckpointPiece
  CheckpointFolder::add(const unsigned int step, const std::string &name, const std::string &bytes) const
  {
    write_file(unfinished(step) + "/" + name, bytes);
    return {name, bytes.size(), checksum(bytes)};
  }


  void
  CheckpointFolder::finish(const CheckpointManifest &manifest) const
  {
    const std::string from = unfinished(manifest.step), to = path_ + "/" + name_of(manifest.step);
    write_file(from + "/" + manifest_name, manifest_text(manifest));
    bring_to_disk(from);
    std::error_code error;
    fs::remove_all(to, error); // of the same step, written before a run was resumed at an earlier one
    if (!error)
      fs::rename(from, to, error);
    if (error)
      throw OutputError(cannot_write(to, error.value()));
    bring_to_disk(path_);
    const std::vector<std::string> all = names();
    std::error_code                ignored;
    for (std::size_t i = n_kept; i < all.size(); ++i)
      fs::remove_all(path_ + "/" + all[i], ignored);
  }


  void
  CheckpointFolder::abandon(const unsigned int step) const
  {
    std::error_code ignored;
    fs::remove_all(unfinished(step), ignored);
  }


  void
  CheckpointFolder::forget_after(const unsigned int step) const
  {
    std::error_code ignored;
    for (const std::string &name : names())
      if (std::stoul(name.substr(std::string(prefix).size())) > step)
        fs::remove_all(path_ + "/" + name, ignored);
  }


  std::vector<std::string>
  CheckpointFolder::names() const
  {
    std::vector<std::string> result;
    std::error_code          error;
    for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error))
      if (is_name(entry->path().filename().string()))
        result.push_back(entry->path().filename().string());
    std::sort(result.begin(), result.end(), [](const std::string &a, const std::string &b) { return a.size() != b.size() ? a.size() > b.size() : a > b; });
    return result;
  }


  CheckpointManifest
  CheckpointFolder::manifest(const std::string &name) const
  {
    return read_manifest(read_file(path_ + "/" + name + "/" + manifest_name));
  }


  std::string
  CheckpointFolder::read(const std::string &name, const CheckpointPiece &piece) const
  {
    std::string bytes = read_file(path_ + "/" + name + "/" + piece.name);
    if (bytes.size() != piece.size)
      throw InputError("its file " + piece.name + " has " + std::to_string(bytes.size()) + " bytes; written were " + std::to_string(piece.size));
    if (checksum(bytes) != piece.sum)
      throw InputError("its file " + piece.name + " is not what was written: the checksum differs");
    return bytes;
  }
} // namespace tanktread
