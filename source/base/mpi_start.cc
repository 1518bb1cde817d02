// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what is settled before MPI starts.

#include <tanktread/base/mpi_start.h>

#include <cstdlib>
#include <string>

namespace tanktread
{
  void
  expect_ranks_on_one_machine()
  {
    const char *const all = std::getenv("OMPI_COMM_WORLD_SIZE"), *const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    const bool one_machine = (all == nullptr && here == nullptr) || (all != nullptr && here != nullptr && std::string(all) == here);
    // Started by another launcher (Slurm's, say), a process knows nothing of the others.
    const bool other_launcher =
      all == nullptr && (std::getenv("PMIX_RANK") != nullptr || std::getenv("PMI_RANK") != nullptr || std::getenv("SLURM_PROCID") != nullptr);
    if (one_machine && !other_launcher)
      setenv("OMPI_MCA_pml", "ob1", 0);
  }
} // namespace tanktread
