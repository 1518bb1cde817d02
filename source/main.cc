// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the program.

#include <tanktread/base/command_line.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/mpi_start.h>
#include <tanktread/base/stop_request.h>
#include <tanktread/base/version.h>
#include <tanktread/simulation/shared_parameters.h>
#include <tanktread/simulation/simulation.h>
#include <tanktread/simulation/study.h>

#include <deal.II/base/mpi.h>

#include <iostream>

namespace
{
  /** What is printed instead of computing anything; empty for a run. */
  std::string
  answer(const tanktread::CommandLine &command_line)
  {
    using Action = tanktread::CommandLine::Action;
    switch (command_line.action)
      {
        case Action::help:
          return tanktread::help_text();
        case Action::version:
          return tanktread::program_version() + "\n" + tanktread::library_versions() + "\n";
        case Action::print_prm:
        case Action::print_markdown:
          return tanktread::default_parameters(command_line.action == Action::print_markdown);
        case Action::validate:
          tanktread::read_shared_parameters(command_line.file, command_line.overrides, MPI_COMM_WORLD);
          return "valid\n";
        case Action::run:
          break;
      }
    return "";
  }

  constexpr int stopped = 3; // exit code of a run that has ended early, as it was asked to

  int
  work(const std::vector<std::string> &words)
  {
    const tanktread::CommandLine command_line = tanktread::parse_command_line(words);
    const std::string            text         = answer(command_line);
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << text << std::flush;
    if (command_line.action == tanktread::CommandLine::Action::run)
      {
        const tanktread::Parameters parameters = tanktread::read_shared_parameters(command_line.file, command_line.overrides, MPI_COMM_WORLD);
        if (command_line.resume && parameters.study.is_wanted())
          throw tanktread::InputError("--resume is for single runs; allowed with Study/Vary: nothing");
        if (parameters.study.is_wanted())
          tanktread::Study(parameters, command_line.overrides, MPI_COMM_WORLD).run();
        else
          {
            tanktread::note_requests();
            if (tanktread::Simulation(parameters, MPI_COMM_WORLD).run(command_line.resume) == "stopped")
              return stopped;
          }
      }
    return 0;
  }
} // namespace

int
main(int argc, char *argv[])
{
  try
    {
      // Exceptions are turned into exit codes while MPI is still initialised: the ranks have to agree on how to end. One thread a rank.
      const std::vector<std::string> words(argv + 1, argv + argc);
      argc    = 1; // PETSc would take our options for its own: deal.II initialises it even if it is not used.
      argv[1] = nullptr;
      tanktread::expect_ranks_on_one_machine();
      const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
      int                                            result = 0;
      const int                                      failed = tanktread::exit_code_of(MPI_COMM_WORLD, [&] { result = work(words); });
      return failed != 0 ? failed : result;
    }
  catch (const std::exception &error)
    {
      std::cerr << "tanktread: " << error.what() << std::endl;
    }
  return 2;
}
