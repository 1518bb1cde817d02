// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: parameters read by one rank for all of them.

#ifndef tanktread_simulation_shared_parameters_h
#define tanktread_simulation_shared_parameters_h

#include <tanktread/simulation/parameters.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace tanktread
{
  /**
   * read_parameters() by the first rank alone, which reads the files, looks for random places and checks the scene; what comes of it, meshes of files included, is sent to the others. Throws on all ranks
   * what is thrown on the first. Collective.
   */
  Parameters
  read_shared_parameters(const std::string &file, const std::vector<std::string> &overrides, MPI_Comm communicator);
} // namespace tanktread

#endif
