// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: errors that end a run on one rank or on all.

#ifndef tanktread_base_mpi_errors_h
#define tanktread_base_mpi_errors_h

#include <mpi.h>

#include <functional>

namespace tanktread
{
  /**
   * Runs `work` on the first rank only. What it throws there is thrown on all ranks, with the same message and, for InputError, NumericalError and OutputError,
   * the same type. Collective.
   */
  void
  on_first_rank(MPI_Comm communicator, const std::function<void()> &work);

  /**
   * Runs `work`, which must not communicate, on all ranks. When it throws on some of them, what it throws on the first of these is thrown on all, as
   * on_first_rank() does. Collective.
   */
  void
  on_all_ranks(MPI_Comm communicator, const std::function<void()> &work);

  /**
   * Runs `work` on all ranks and returns the exit code: 0 when it comes back, 1 for InputError, 2 for every other exception, whose message is written to
   * std::cerr. Usually all ranks fail alike: then the first one writes and all return. When the others have not failed within `patience` seconds they
   * may be waiting for this one, so it writes its message and aborts the program on all ranks with the exit code. Collective; to be called while MPI is
   * initialised.
   */
  int
  exit_code_of(MPI_Comm communicator, const std::function<void()> &work, double patience = 10.);
} // namespace tanktread

#endif
