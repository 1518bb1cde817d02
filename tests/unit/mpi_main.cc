// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: main() of the tests that run on several ranks. The first rank reports all tests, the others what fails there; every rank ends with the
// result of all.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <iostream>

namespace
{
  class FailurePrinter : public ::testing::EmptyTestEventListener
  {
    void
    OnTestPartResult(const ::testing::TestPartResult &result) override
    {
      if (result.failed())
        std::cerr << "Rank " << dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) << ", " << (result.file_name() ? result.file_name() : "") << ':'
                  << result.line_number() << ": " << result.message() << std::endl;
    }
  };
} // namespace


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ::testing::InitGoogleTest(&argc, argv);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    {
      auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
      delete listeners.Release(listeners.default_result_printer());
      listeners.Append(new FailurePrinter);
    }
  const int failed = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD);
}
