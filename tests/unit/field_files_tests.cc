// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the fluid's fields on disk.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/field_output.h>
#include <tanktread/fluid/fluid.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace tanktread;
namespace fs = std::filesystem;

namespace
{
  /** A coarse mesh with a flow at rest, and a folder that all ranks know. */
  struct FieldOutput : testing::Test
  {
    FieldOutput()
      : rank(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD))
      , n_ranks(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD))
      , folder(fs::temp_directory_path() / ("tanktread_field_output_" + std::to_string(n_ranks)))
      , fluid(MPI_COMM_WORLD, 10., parameters())
    {
      if (rank == 0)
        {
          fs::remove_all(folder);
          fs::create_directories(folder);
        }
      MPI_Barrier(MPI_COMM_WORLD);
      fluid.adapt({dealii::Point<3>(0.1, 0.2, 0.3)});
      fluid.space().reinit(fields);
    }

    ~FieldOutput()
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (rank == 0)
        fs::remove_all(folder);
    }

    static FluidMeshParameters
    parameters()
    {
      FluidMeshParameters result;
      result.finest_cell = 1.25;
      return result;
    }

    std::string
    write(const std::string &name)
    {
      return write_fluid_fields(folder.string(), name, 7, fluid.space(), fields, simple_shear(), [](const dealii::Point<3> &) { return 0.; });
    }

    std::string
    contents(const std::string &name) const
    {
      std::stringstream text;
      text << std::ifstream(folder / name).rdbuf();
      return text.str();
    }

    const unsigned int rank, n_ranks;
    const fs::path     folder;
    Fluid              fluid;
    FluidBlockVector   fields;
  };
} // namespace

TEST_F(FieldOutput, RecordNamesOnePieceARank)
{
  EXPECT_EQ(write("fluid"), "fluid_00007.pvtu");
  const std::string record = contents("fluid_00007.pvtu");
  for (unsigned int r = 0; r < n_ranks; ++r)
    {
      const std::string piece = "fluid_00007." + std::to_string(r) + ".vtu";
      EXPECT_NE(record.find("<Piece Source=\"" + piece + "\"/>"), std::string::npos) << record;
      const std::string text = contents(piece);
      EXPECT_NE(text.find("Name=\"velocity\" NumberOfComponents=\"3\""), std::string::npos);
      EXPECT_NE(text.find("Name=\"pressure\""), std::string::npos);
      EXPECT_NE(text.find("</VTKFile>"), std::string::npos);
    }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), n_ranks + 1);
}

TEST_F(FieldOutput, WhatOneRankCannotWriteIsSaidOnAll)
{
  // The place of the last rank's piece is taken by a folder.
  const std::string piece = "fluid_00007." + std::to_string(n_ranks - 1) + ".vtu";
  if (rank == 0)
    fs::create_directories(folder / piece / "inside");
  MPI_Barrier(MPI_COMM_WORLD);
  try
    {
      write("fluid");
      ADD_FAILURE() << "written";
    }
  catch (const OutputError &error)
    {
      EXPECT_EQ(error.what(), "cannot write \"" + (folder / piece).string() + "\": Is a directory");
    }
  EXPECT_FALSE(fs::exists(folder / "fluid_00007.pvtu"));
}
