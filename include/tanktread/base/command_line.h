// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the options of the program.

#ifndef tanktread_base_command_line_h
#define tanktread_base_command_line_h

#include <string>
#include <vector>

namespace tanktread
{
  /** What the command line asks for. */
  struct CommandLine
  {
    enum class Action
    {
      run,
      validate,
      print_prm,
      print_markdown,
      version,
      help
    };

    Action                   action = Action::run;
    std::string              file;      // parameter file; empty for the actions that need none
    std::vector<std::string> overrides; // texts of --set: "Section/Parameter=value"
    bool                     resume = false;
  };

  /**
   * Reads the words of the command line, program name left out.
   * @throws InputError for an unknown option (with the nearest known one), an option without its value, no parameter file or more than one.
   */
  CommandLine
  parse_command_line(const std::vector<std::string> &words);

  /** The text that --help prints. */
  std::string
  help_text();
} // namespace tanktread

#endif
