// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what is settled before MPI starts.

#ifndef tanktread_base_mpi_start_h
#define tanktread_base_mpi_start_h

namespace tanktread
{
  /**
   * To be called before MPI is initialised. Where all ranks are on this machine, as Open MPI's launcher tells its processes, asks Open MPI not to look for networks
   * (OMPI_MCA_pml = ob1): that takes a fifth of a second, which is more than some runs. What the user has set stays; other MPI libraries do not read it.
   */
  void
  expect_ranks_on_one_machine();
} // namespace tanktread

#endif
