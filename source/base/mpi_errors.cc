// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: errors that end a run on one rank or on all.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>

#include <chrono>
#include <iostream>
#include <string>
#include <thread>

namespace tanktread
{
  namespace
  {
    enum class Kind
    {
      none,
      input,
      numerical,
      output,
      unexpected
    };

    struct Failure
    {
      Kind        kind = Kind::none;
      std::string message;
    };

    Failure
    failure_of(const std::function<void()> &work)
    {
      try
        {
          work();
        }
      catch (const InputError &error)
        {
          return {Kind::input, error.what()};
        }
      catch (const NumericalError &error)
        {
          return {Kind::numerical, error.what()};
        }
      catch (const OutputError &error)
        {
          return {Kind::output, error.what()};
        }
      catch (const std::exception &error)
        {
          return {Kind::unexpected, error.what()};
        }
      catch (...)
        {
          return {Kind::unexpected, "unknown exception"};
        }
      return {};
    }

    void
    print(const Failure &failure, const std::string &who)
    {
      const char *const kinds[] = {"", "bad input", "numerical failure", "output failure", "unexpected error"};
      std::cerr << "tanktread: " << kinds[static_cast<int>(failure.kind)] << who << "\n" << failure.message << std::endl;
    }

    /** Throws on all ranks what the failure of rank `root` says; nothing if that rank has not failed. */
    void
    throw_on_all_ranks(MPI_Comm communicator, const int root, Failure failure)
    {
      int numbers[2] = {static_cast<int>(failure.kind), static_cast<int>(failure.message.size())};
      MPI_Bcast(numbers, 2, MPI_INT, root, communicator);
      failure.message.resize(numbers[1]);
      MPI_Bcast(&failure.message[0], numbers[1], MPI_CHAR, root, communicator);
      switch (static_cast<Kind>(numbers[0]))
        {
          case Kind::none:
            return;
          case Kind::input:
            throw InputError(failure.message);
          case Kind::numerical:
            throw NumericalError(failure.message);
          case Kind::output:
            throw OutputError(failure.message);
          case Kind::unexpected:
            throw std::runtime_error(failure.message);
        }
    }
  } // namespace

  void
  on_first_rank(MPI_Comm communicator, const std::function<void()> &work)
  {
    int rank;
    MPI_Comm_rank(communicator, &rank);
    Failure failure;
    if (rank == 0)
      failure = failure_of(work);
    throw_on_all_ranks(communicator, 0, failure);
  }

  void
  on_all_ranks(MPI_Comm communicator, const std::function<void()> &work)
  {
    int rank, n_ranks;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_ranks);
    const Failure failure = failure_of(work);
    int           first   = failure.kind == Kind::none ? n_ranks : rank;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, communicator);
    if (first < n_ranks)
      throw_on_all_ranks(communicator, first, failure);
  }

  Meeting::Meeting(MPI_Comm communicator)
  {
    MPI_Comm_dup(communicator, &communicator_);
  }


  Meeting::~Meeting()
  {
    if (!missed_)
      MPI_Comm_free(&communicator_);
  }


  bool
  Meeting::all_come(const double patience) const
  {
    using namespace std::chrono;
    MPI_Request request;
    MPI_Ibarrier(communicator_, &request);
    const auto start = steady_clock::now();
    for (int arrived = 0; duration<double>(steady_clock::now() - start).count() < patience;)
      {
        MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
        if (arrived)
          return true;
        std::this_thread::sleep_for(milliseconds(1));
      }
    missed_ = true;
    return false;
  }

  int
  exit_code_of(MPI_Comm communicator, const std::function<void()> &work, const double patience)
  {
    const Meeting meeting(communicator);
    int           rank, n_ranks;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_ranks);

    const Failure failure   = failure_of(work);
    const int     exit_code = failure.kind == Kind::none ? 0 : failure.kind == Kind::input ? 1 : 2;
    if (exit_code != 0)
      {
        const bool together = n_ranks == 1 || meeting.all_come(patience);
        if (!together || rank == 0)
          print(failure, together ? "" : " on rank " + std::to_string(rank));
        if (!together)
          MPI_Abort(communicator, exit_code);
      }
    return exit_code;
  }
} // namespace tanktread
