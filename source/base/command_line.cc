// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the options of the program.

#include <tanktread/base/command_line.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/nearest_name.h>

namespace tanktread
{
  namespace
  {
    using Action = CommandLine::Action;

    const std::vector<std::string> options = {"--set", "--validate", "--print-parameters", "--resume", "--version", "--help"};

    void
    check_file(const CommandLine &command_line)
    {
      const bool wants_file = command_line.action == Action::run || command_line.action == Action::validate;
      if (wants_file && command_line.file.empty())
        throw InputError("no parameter file given; usage: tanktread [options] FILE.prm (see tanktread --help)");
      if (!wants_file && !command_line.file.empty())
        throw InputError("\"" + command_line.file + "\" is one word too many; --print-parameters, --version and --help take no parameter file");
    }
  } // namespace

  CommandLine
  parse_command_line(const std::vector<std::string> &words)
  {
    CommandLine command_line;
    for (std::size_t i = 0; i < words.size(); ++i)
      {
        const std::string &word = words[i];
        const std::string  next = i + 1 < words.size() ? words[i + 1] : "";
        if (word == "--set")
          {
            if (next.empty() || next.rfind("--", 0) == 0)
              throw InputError("--set needs a value: --set \"Section/Parameter=value\"");
            command_line.overrides.push_back(next);
            ++i;
          }
        else if (word == "--validate")
          command_line.action = Action::validate;
        else if (word == "--print-parameters")
          {
            command_line.action = next == "markdown" ? Action::print_markdown : Action::print_prm;
            if (next == "prm" || next == "markdown")
              ++i;
          }
        else if (word == "--resume")
          command_line.resume = true;
        else if (word == "--version")
          command_line.action = Action::version;
        else if (word == "--help" || word == "-h")
          command_line.action = Action::help;
        else if (word.rfind("-", 0) == 0)
          throw InputError("unknown option \"" + word + "\"" + did_you_mean(word, options) + " (see tanktread --help)");
        else if (command_line.file.empty())
          command_line.file = word;
        else
          throw InputError("more than one parameter file: \"" + command_line.file + "\" and \"" + word + "\"; allowed: one");
      }
    check_file(command_line);
    if (command_line.resume && command_line.action != Action::run)
      throw InputError("--resume is for a run; it cannot be combined with another action");
    return command_line;
  }

  std::string
  help_text()
  {
    return "usage: tanktread [options] FILE.prm\n"
           "       mpirun -np N tanktread [options] FILE.prm\n"
           "\n"
           "Computes the motion of liquid capsules enclosed by thin elastic shells in viscous flow.\n"
           "\n"
           "  --set \"Section/Parameter=value\"    set a parameter; wins over the file; may be repeated\n"
           "  --resume                           go on from the newest good checkpoint in Output/Directory, if there is one\n"
           "  --validate                         check everything, compute nothing\n"
           "  --print-parameters [prm|markdown]  list all parameters with defaults and allowed values\n"
           "  --version                          versions of the program and of its libraries\n"
           "  --help                             this text\n"
           "\n"
           "A mesh file named in FILE.prm is looked for in the folder of FILE.prm; the folder for the output\n"
           "(Output/Directory) is made in the folder in which the program is started.\n"
           "SIGUSR1 asks a run for a checkpoint, SIGTERM or a file `stop` in its folder for one and the end.\n"
           "Exit codes: 0 done, 1 bad input, 2 the computation failed or could not be written, 3 stopped as\n"
           "asked for, after a checkpoint.\n";
  }
} // namespace tanktread
