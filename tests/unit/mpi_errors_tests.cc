// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of errors on one rank and on all.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <thread>

using namespace tanktread;

namespace
{
  int
  this_rank()
  {
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
  }

  /** What exit_code_of writes to std::cerr on this rank, and its result. */
  std::pair<int, std::string>
  outcome(const std::function<void()> &work)
  {
    testing::internal::CaptureStderr();
    const int exit_code = exit_code_of(MPI_COMM_WORLD, work);
    return {exit_code, testing::internal::GetCapturedStderr()};
  }
} // namespace

TEST(MpiErrors, ExitCodesAndOneMessage)
{
  const bool first = this_rank() == 0;
  using Outcome    = std::pair<int, std::string>;
  EXPECT_EQ(outcome([] {}), Outcome(0, ""));
  EXPECT_EQ(outcome([] { throw InputError("what"); }), Outcome(1, first ? "tanktread: bad input\nwhat\n" : ""));
  EXPECT_EQ(outcome([] { throw NumericalError("what"); }), Outcome(2, first ? "tanktread: numerical failure\nwhat\n" : ""));
  EXPECT_EQ(outcome([] { throw OutputError("what"); }), Outcome(2, first ? "tanktread: output failure\nwhat\n" : ""));
  EXPECT_EQ(outcome([] { throw std::out_of_range("what"); }), Outcome(2, first ? "tanktread: unexpected error\nwhat\n" : ""));
  EXPECT_EQ(outcome([] { throw 1; }), Outcome(2, first ? "tanktread: unexpected error\nunknown exception\n" : ""));
}

TEST(MpiErrors, ErrorOfSomeRankIsThrownOnAll)
{
  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  EXPECT_NO_THROW(on_all_ranks(MPI_COMM_WORLD, [] {}));
  for (int failing = 0; failing < n_ranks; ++failing)
    try
      {
        on_all_ranks(MPI_COMM_WORLD, [&] {
          if (this_rank() >= failing)
            throw NumericalError("rank " + std::to_string(this_rank()));
        });
        ADD_FAILURE();
      }
    catch (const NumericalError &error)
      {
        EXPECT_EQ(error.what(), "rank " + std::to_string(failing));
      }
}

TEST(MpiErrors, ErrorOfTheFirstRankIsThrownOnAll)
{
  int calls = 0;
  on_first_rank(MPI_COMM_WORLD, [&calls] { ++calls; });
  EXPECT_EQ(calls, this_rank() == 0 ? 1 : 0);
  EXPECT_THROW(on_first_rank(MPI_COMM_WORLD, [] { throw InputError("what"); }), InputError);
  EXPECT_THROW(on_first_rank(MPI_COMM_WORLD, [] { throw NumericalError("what"); }), NumericalError);
  EXPECT_THROW(on_first_rank(MPI_COMM_WORLD, [] { throw OutputError("what"); }), OutputError);
  try
    {
      on_first_rank(MPI_COMM_WORLD, [] { throw std::out_of_range("a longer message"); });
      ADD_FAILURE();
    }
  catch (const std::runtime_error &error)
    {
      EXPECT_EQ(error.what(), std::string("a longer message"));
    }
}

TEST(Meeting, AllComeHoweverLate)
{
  const Meeting meeting(MPI_COMM_WORLD);
  for (unsigned int again = 0; again < 2; ++again)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(100 * this_rank()));
      EXPECT_TRUE(meeting.all_come());
    }
}

TEST(Meeting, OneDoesNotComeInTime)
{
  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks == 1)
    return;
  // The last rank is somewhere else; the others notice, and go on when it is back.
  const Meeting meeting(MPI_COMM_WORLD);
  if (this_rank() < n_ranks - 1)
    {
      const double start = MPI_Wtime();
      EXPECT_FALSE(meeting.all_come(0.1));
      EXPECT_GE(MPI_Wtime() - start, 0.1);
      EXPECT_LT(MPI_Wtime() - start, 5.);
    }
  MPI_Barrier(MPI_COMM_WORLD);
}

int
main(int argc, char *argv[])
{
  MPI_Init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  int result = 0;
  if (argc > 1 && std::string(argv[1]) == "--last-rank-fails")
    // The last rank fails while the others wait for it. Started by ctest, which expects exit code 2.
    result = exit_code_of(
      MPI_COMM_WORLD,
      [] {
      int n_ranks;
      MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
      if (this_rank() == n_ranks - 1)
        throw NumericalError("the last rank has failed");
      MPI_Barrier(MPI_COMM_WORLD);
      },
      0.5);
  else
    result = RUN_ALL_TESTS();
  MPI_Finalize();
  return result;
}
