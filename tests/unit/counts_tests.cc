// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of numbers of things that have to fit into 32 bits.

#include <gtest/gtest.h>

#include <tanktread/base/counts.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/number_of_cells.h>

#include <deal.II/base/types.h>

#include <limits>
#include <string>

using namespace tanktread;

namespace
{
  constexpr std::size_t two_to_31 = std::size_t(1) << 31, two_to_32 = std::size_t(1) << 32;

  template <typename Function>
  std::string
  said_by(const Function &f)
  {
    try
      {
        f();
      }
    catch (const std::exception &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace

TEST(Counts, FitIntoMessages)
{
  EXPECT_EQ(mpi_count(0, "points"), 0);
  EXPECT_EQ(mpi_count(two_to_31 - 1, "points"), std::numeric_limits<int>::max());
  EXPECT_THROW(mpi_count(two_to_31, "points"), NumericalError);
  EXPECT_THROW(mpi_count(two_to_32 + 1, "points"), NumericalError); // would be one
  EXPECT_NE(said_by([] { mpi_count(two_to_31, "points"); }).find("2147483648 points; allowed: at most 2147483647"), std::string::npos);
}

TEST(Counts, FitIntoIndices)
{
  EXPECT_EQ(index_count(two_to_32 - 2, "points"), 4294967294u);
  EXPECT_THROW(index_count(two_to_32 - 1, "points"), NumericalError); // that is for "none"
  EXPECT_THROW(index_count(two_to_32 + 1, "points"), NumericalError);
}

// Their nodes are at most 27 each: no degree of freedom beyond what deal.II can count. Meshes of that size have about eight a cell and are refused for those.
TEST(Counts, CellsHaveNodesThatCanBeCounted)
{
  if (sizeof(dealii::types::global_dof_index) != 4)
    GTEST_SKIP() << "deal.II counts with 64 bits here";
  const std::uint64_t most = (two_to_32 - 1) / 27;
  EXPECT_EQ(said_by([&] { check_number_of_cells(most); }), "");
  EXPECT_THROW(check_number_of_cells(most + 1), InputError);
  EXPECT_THROW(check_number_of_cells(two_to_32 + 1), InputError);
  EXPECT_NE(said_by([&] { check_number_of_cells(most + 1); }).find("The fluid mesh has 159072863 cells; allowed: at most 159072862"), std::string::npos);
}
