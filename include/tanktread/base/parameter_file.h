// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: reads parameter files, with errors that name file and line.

#ifndef tanktread_base_parameter_file_h
#define tanktread_base_parameter_file_h

#include <map>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Remembers where each parameter got its value, so that checks made after reading can say it. */
  class ParameterSource
  {
  public:
    /** "scene.prm:7", "--set", or "default" for `path` = "Section/Parameter". */
    std::string
    where(const std::string &path) const;

    /** True when a file or a --set option gave `path` a value. */
    bool
    is_set(const std::string &path) const;

    /** `message` with the place of the first set parameter that it mentions in front: "scene.prm:7: Scene/Viscosity ratio is 2; ...". */
    std::string
    locate(const std::string &message) const;

    /** Notes that `path` got its value at `place`. */
    void
    note(const std::string &path, const std::string &place);

  private:
    std::map<std::string, std::string> places;
  };

  /**
   * Reads the parameter file `file_name` into `prm`, which has all parameters declared, then applies `overrides`, each "Section/Parameter=value".
   *
   * The format is deal.II's: lines `subsection NAME`, `set NAME = VALUE`, `end`, comments from # to the end of the line, and a backslash at the end of a line
   * that continues it. A parameter may be set once in a file.
   *
   * @throws InputError with one line for each error of file and overrides: where ("FILE:LINE" or "--set"), what was found, what is allowed, and the nearest
   * known name for an unknown one.
   */
  ParameterSource
  read_parameter_file(dealii::ParameterHandler &prm, const std::string &file_name, const std::vector<std::string> &overrides = {});

  /** Throws InputError where the file cannot be read. */
  std::string
  text_of_parameter_file(const std::string &file_name);

  /** Same for the text of a file; `file_name` is used in messages only. */
  ParameterSource
  read_parameter_text(dealii::ParameterHandler &prm, const std::string &text, const std::string &file_name, const std::vector<std::string> &overrides = {});
} // namespace tanktread

#endif
