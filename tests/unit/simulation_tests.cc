// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of whole runs that no table of numbers is needed for: meshes that follow, capsules many boxes away, steady ends.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/scene_description.h>
#include <tanktread/simulation/simulation.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>

using namespace tanktread;
namespace fs = std::filesystem;

namespace
{
  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** The folder of a run, the same on all ranks, removed at the end. */
  struct Folder
  {
    Folder()
      : path(fs::temp_directory_path() / ("tanktread_simulation_tests_" + std::to_string(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, int(getpid()), 0))))
    {
      if (is_root())
        {
          fs::create_directories(path);
          std::ofstream(path / "x.prm") << "";
        }
      MPI_Barrier(MPI_COMM_WORLD);
    }

    ~Folder()
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (is_root())
        fs::remove_all(path);
    }

    std::string
    content(const std::string &file) const
    {
      std::ifstream in(path / "output" / file);
      return {std::istreambuf_iterator<char>(in), {}};
    }

    const fs::path path;
  };

  using Columns = std::map<std::string, std::vector<double>>;

  /** What a run with these settings leaves in its folder: a small scene unless they say otherwise. */
  struct Outcome
  {
    explicit Outcome(const std::vector<std::string> &settings)
    {
      const Folder             folder;
      std::vector<std::string> all = {"Output/Directory=" + (folder.path / "output").string(),
                                      "Scene/Shear number G=0.2",
                                      "Scene/Box side=10",
                                      "Shell mesh/Level=1",
                                      "Fluid mesh/Finest cell=0.625",
                                      "Output/Field interval=0"};
      all.insert(all.end(), settings.begin(), settings.end());
      testing::internal::CaptureStdout();
      const Parameters parameters = read_parameters((folder.path / "x.prm").string(), all);
      try
        {
          Simulation(parameters, MPI_COMM_WORLD).run();
        }
      catch (const NumericalError &error)
        {
          failure = error.what();
        }
      testing::internal::GetCapturedStdout();
      MPI_Barrier(MPI_COMM_WORLD);
      log     = folder.content("log.txt");
      summary = folder.content("summary.csv");
      read(folder.content("history.csv"));
    }

    void
    read(const std::string &history)
    {
      std::istringstream       lines(history);
      std::string              line, word;
      std::vector<std::string> names;
      for (bool first = true; std::getline(lines, line);)
        {
          if (line.empty() || line[0] == '#')
            continue;
          std::istringstream words(line);
          for (std::size_t i = 0; std::getline(words, word, ','); ++i)
            if (first)
              names.push_back(word);
            else
              columns[names[i]].push_back(std::stod(word));
          first = false;
        }
    }

    std::string log, summary, failure;
    Columns     columns;
  };

  bool
  has(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace


TEST(Simulation, StepsBeyondTheMeshAreRepeatedOnOneAroundBothEnds)
{
  const std::vector<std::string> scene = {"Scene/Shear number G=0.5",
                                          "Scene/Box side=5",
                                          "Fluid mesh/Coarsest cell=1.25",
                                          "Fluid mesh/Finest cell=0.15625",
                                          "Scene/End time=1.5"};
  const auto                     with  = [&](const std::string &step, const std::string &band) {
    std::vector<std::string> settings = scene;
    settings.push_back("Time/Step=" + step);
    settings.push_back("Fluid mesh/Band width=" + band);
    return Outcome(settings);
  };
  const Outcome narrow = with("0.75", "1"), wide = with("0.75", "5"), shorter = with("0.375", "5");
  if (!is_root())
    return;
  EXPECT_TRUE(has(narrow.log, "Step of length 0.75 repeated on a mesh around its end too: the shells have left the finest cells.")) << narrow.log;
  EXPECT_FALSE(has(wide.log, "repeated")) << wide.log;
  ASSERT_EQ(narrow.columns.at("time").size(), 3u) << narrow.log;
  EXPECT_EQ(narrow.columns.at("time").back(), 1.5);
  // The mesh far from the shell makes little difference, steps of half the length make more.
  const double D = narrow.columns.at("D_xz").back(), of_wide = wide.columns.at("D_xz").back(), of_shorter = shorter.columns.at("D_xz").back();
  std::cout << "D = " << D << ", without changes of mesh " << of_wide << ", with half the steps " << of_shorter << std::endl;
  EXPECT_NEAR(D, of_wide, 1e-3);
  EXPECT_NEAR(D, of_shorter, 0.05);
  EXPECT_LT(std::abs(D - of_wide), 0.2 * std::abs(of_wide - of_shorter));
}


TEST(Simulation, BoxesAwayEverythingIsTheSame)
{
  // The same mesh, since the box is periodic, and the same numbers but for the rounding of positions, of which the history has ten digits.
  for (const char *const interface : {"plain", "enriched"})
    {
      const auto at = [&](const std::string &centre) {
        return Outcome({"Scene/End time=1",
                        "Time/Step=0.2",
                        "Fluid mesh/Finest cell=0.3125",
                        "Fluid mesh/Band width=1",
                        "Solver/Newton tolerance=1e-11",
                        "Solver/Volume tolerance=1e-12",
                        std::string("Solver/Interface=") + interface,
                        "Capsule/Centres=" + centre});
      };
      const Outcome here = at("0.25, 0.125, 0.5"), away = at("30.25, -19.875, 0.5");
      if (!is_root())
        continue;
      EXPECT_TRUE(here.failure.empty() && away.failure.empty());
      const std::vector<double> &cells = here.columns.at("cells");
      EXPECT_NE(*std::max_element(cells.begin(), cells.end()), *std::min_element(cells.begin(), cells.end())); // the mesh has followed
      double largest = 0.;
      for (const auto &[name, values] : here.columns)
        if (name != "wall_time" && name != "newton_iterations" && name != "linear_iterations")
          {
            // Newton's tolerance, a velocity, leaves more of forces and pressures open: a unit of the pressure jump drives 0.04 h through the shell.
            const bool is_force = name[0] == 'S' || name[0] == 'N' || name == "pressure_jump" || name == "intrinsic_viscosity" || name == "dissipation",
                       is_work  = name == "power" || name == "energy_residual";
            const double shift = name == "x" ? 30. : name == "y" ? -20. : 0., digits = shift != 0. ? 1.1e-8 : is_force ? 1e-7 : is_work ? 1e-8 : 1e-9;
            for (std::size_t i = 0; i < values.size(); ++i)
              if (std::isfinite(values[i]))
                {
                  const double difference = std::abs(away.columns.at(name).at(i) - values[i] - shift);
                  EXPECT_LE(difference, digits * std::max(1., std::abs(values[i]))) << name << " in row " << i;
                  largest = std::max(largest, difference);
                }
          }
      std::cout << interface << ": largest difference " << largest << std::endl;
    }
}


TEST(Simulation, ARunThatEndsSteadySaysSo)
{
  // A sphere at rest: its shape changes in none of the three steps that are asked for.
  const std::vector<std::string> scene    = {"Scene/Flow=quiescent",
                                             "Scene/Reduced bending modulus=0.1",
                                             "Capsule/Reference curvature=initial",
                                             "Time/Step=0.1",
                                             "Scene/End time=1"};
  std::vector<std::string>       settings = scene;
  settings.push_back("Time/Steady tolerance=1e-3");
  const Outcome steady(settings), done(scene);
  if (!is_root())
    return;
  EXPECT_EQ(steady.columns.at("time").size(), 4u);
  EXPECT_EQ(steady.summary.rfind("quantity,value\noutcome,steady\n", 0), 0u) << steady.summary;
  EXPECT_TRUE(has(steady.log, "Motion: steady")) << steady.log;
  EXPECT_TRUE(has(steady.log, "Steady: axes and inclination have changed slower than Time/Steady tolerance in three steps.")) << steady.log;
  EXPECT_EQ(done.columns.at("time").size(), 11u);
  EXPECT_EQ(done.summary.rfind("quantity,value\noutcome,done\n", 0), 0u) << done.summary;
}


TEST(Simulation, ARunThatFailsSaysSo)
{
  const Outcome failed({"Solver/Maximal linear iterations=1", "Scene/End time=1"});
  EXPECT_TRUE(has(failed.failure, "did not converge")) << failed.failure;
  if (!is_root())
    return;
  EXPECT_EQ(failed.summary.rfind("quantity,value\noutcome,failed\n", 0), 0u) << failed.summary;
  EXPECT_TRUE(has(failed.log, "FAILED at time 0.000000: ")) << failed.log;
}


TEST(Simulation, TheFluidHasTheBoxOfTheParameters)
{
  const Folder     folder;
  const Parameters parameters = read_parameters((folder.path / "x.prm").string(),
                                                {"Output/Directory=" + (folder.path / "output").string(),
                                                 "Scene/Flow=planar extension",
                                                 "Scene/Box side=20, 10, 5",
                                                 "Scene/Box faces=prescribed, periodic, prescribed",
                                                 "Shell mesh/Level=1",
                                                 "Fluid mesh/Coarsest cell=1.25",
                                                 "Fluid mesh/Finest cell=0.625"});
  Scene            scene(scene_description(parameters), MPI_COMM_WORLD);
  const Box       &box = scene.fluid().mesh().box();
  EXPECT_EQ(box.side, (std::array<double, 3>{{20., 10., 5.}}));
  EXPECT_EQ(box.faces, (std::array<Faces, 3>{{Faces::prescribed, Faces::periodic, Faces::prescribed}}));
}
