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
   * A place where ranks that have failed find out whether all of them have, so that they may go on together, or whether the others wait for them in some
   * collective call.
   */
  class Meeting
  {
  public:
    /** Collective. */
    explicit Meeting(MPI_Comm communicator);
    ~Meeting();
    Meeting(const Meeting &) = delete;
    Meeting &
    operator=(const Meeting &) = delete;

    /** True when all ranks call this function within `patience` seconds. */
    bool
    all_come(double patience = 10.) const;

  private:
    MPI_Comm     communicator_;   // of its own: the ranks that have not failed may be inside a collective call of the other one
    mutable bool missed_ = false; // then it must not be freed, which takes all ranks
  };

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
