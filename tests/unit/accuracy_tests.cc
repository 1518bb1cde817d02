// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the parameters chosen for a wanted error.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/parameters.h>

#include "temporary_folder.h"

#include <map>

using namespace tanktread;

namespace
{
  Parameters
  read(std::vector<std::string> settings, const std::string &text = "# nothing\n")
  {
    const TemporaryFolder folder;
    write(folder.path / "x.prm", text);
    return read_parameters((folder.path / "x.prm").string(), settings);
  }

  std::string
  target(const std::string &error)
  {
    return "Accuracy/Target error=" + error;
  }

  double
  error_of(const Parameters &parameters, const std::string &cause)
  {
    for (const ErrorShare &share : expected_errors(parameters))
      if (share.cause == cause)
        return share.error;
    return std::nan("");
  }

  const std::vector<std::string> disk  = {"Capsule/Shape=biconcave", "Scene/Viscosity ratio=4", "Scene/Reduced bending modulus=0.01"},
                                 stiff = {"Scene/Shear number G=0.005", "Scene/Reduced bending modulus=0.01"},
                                 soft  = {"Scene/Shear number G=0.2", "Scene/Reduced bending modulus=0.04"};
} // namespace


TEST(Accuracy, NothingIsChosenWithoutATarget)
{
  const Parameters parameters = read({});
  EXPECT_TRUE(parameters.choices.empty());
  EXPECT_EQ(parameters.fluid_mesh.finest_cell, FluidMeshParameters().finest_cell);
}


TEST(Accuracy, NoCauseHasMoreThanSixtyPerCentOfTheTarget)
{
  for (const std::vector<std::string> &scene : {disk, stiff, soft})
    for (const std::string error : {"2e-2", "1e-2", "3e-3", "1e-3", "1e-4"})
      {
        std::vector<std::string> settings = scene;
        settings.push_back(target(error));
        const Parameters parameters = read(settings);
        EXPECT_GE(expected_errors(parameters).size(), 5u);
        for (const ErrorShare &share : expected_errors(parameters))
          {
            EXPECT_LE(share.error, 0.6 * std::stod(error)) << share.cause << " for " << error;
            EXPECT_GT(share.cost_of_half, 1.);
          }
      }
}


TEST(Accuracy, CellsMeetTheirSizeInAnUnboundedBox)
{
  for (const std::string error : {"1e-2", "3e-3", "1e-3", "3e-4"})
    {
      std::vector<std::string> settings = soft;
      settings.push_back(target(error));
      const Parameters parameters = read(settings);
      ASSERT_EQ(parameters.scene.boundary, Boundary::unbounded);
      const double       side     = parameters.scene.box_side[0];
      const BoxDivision  division = divide(parameters.scene.box(), parameters.fluid_mesh.coarsest_cell);
      double             h        = side / (division.n_rung_0[0] << division.coarsest_level);
      const unsigned int coarsest = side / h + 0.5;
      while (h > parameters.fluid_mesh.finest_cell)
        h /= 2.;
      EXPECT_GE(coarsest, 3u);
      EXPECT_LE(coarsest, 5u);
      EXPECT_NEAR(h, parameters.fluid_mesh.finest_cell, 1e-3 * h); // the octree has just this size, not one a half as large
      EXPECT_GE(side, 5.5);
    }
}


TEST(Accuracy, CellsFitABoxThatIsGiven)
{
  for (const std::string box : {"10", "20", "40", "13.7"})
    for (const std::string error : {"1e-2", "3e-3", "1e-3"})
      {
        const Parameters  p        = read({target(error), "Scene/Box side=" + box});
        const BoxDivision division = divide(p.scene.box(), p.fluid_mesh.coarsest_cell);
        double            h        = p.scene.box_side[0] / (division.n_rung_0[0] << division.coarsest_level);
        while (h > p.fluid_mesh.finest_cell)
          h /= 2.;
        EXPECT_NEAR(h, p.fluid_mesh.finest_cell, 1e-3 * h) << box;
        const double allowed = std::cbrt(0.45 * std::stod(error) / 0.045);
        EXPECT_LE(h, 1.11 * allowed) << box;
        EXPECT_GE(h, 0.7 * allowed) << box;
      }
  EXPECT_EQ(read({target("1e-3"), "Scene/Boundary=unbounded"}).scene.box_side, read({target("1e-3")}).scene.box_side);
}


TEST(Accuracy, CellsOfLargeBoxesAreLarger)
{
  // Far away 2:1 balance lets cells grow: what there is of them does not grow with the volume of the box.
  for (const double side : {20., 40., 80., 160.})
    for (const std::string error : {"1e-2", "3e-3", "1e-3"})
      {
        const Parameters   p        = read({target(error), "Scene/Box side=" + std::to_string(side)});
        const BoxDivision  division = divide(p.scene.box(), p.fluid_mesh.coarsest_cell);
        const unsigned int n        = division.n_rung_0[0] << division.coarsest_level;
        EXPECT_GE(n, 4u) << side << ", " << error;
        EXPECT_LE(n, 12u) << side << ", " << error;
      }
  const Parameters flat = read({target("1e-2"), "Scene/Box side=80, 80, 10"}); // a channel: by its height
  EXPECT_LE(flat.fluid_mesh.coarsest_cell, 3.6);
}


TEST(Accuracy, GradesTheMeshWhereFarCellsCount)
{
  EXPECT_EQ(read({target("1e-3")}).fluid_mesh.grading, 0u);
  EXPECT_EQ(read({target("3e-4")}).fluid_mesh.grading, 3u);
  EXPECT_EQ(read({target("3e-4"), "Fluid mesh/Grading=1"}).fluid_mesh.grading, 1u);
  EXPECT_GT(error_of(read({target("3e-4"), "Fluid mesh/Grading=1"}), "cells away from the shell"),
            error_of(read({target("3e-4")}), "cells away from the shell"));
}


TEST(Accuracy, ASmallerTargetIsFinerInEverything)
{
  std::map<std::string, double> before;
  for (const std::string error : {"1e-2", "3e-3", "1e-3", "1e-4"})
    {
      std::vector<std::string> settings = soft;
      settings.push_back(target(error));
      const Parameters              p   = read(settings);
      std::map<std::string, double> now = {{"cell", p.fluid_mesh.finest_cell},
                                           {"points", -double(p.shell_mesh.level)},
                                           {"steps", p.time.tolerance},
                                           {"stop", p.time.limit_tolerance},
                                           {"Newton", p.solver.newton_tolerance},
                                           {"volume", p.solver.volume_tolerance}};
      for (const auto &[name, value] : before)
        EXPECT_LT(now[name], value + (name == "points" ? 0.5 : 0.)) << name; // two targets may share a control mesh
      before = now;
    }
}


TEST(Accuracy, WhatIsSetStays)
{
  const std::string file = "subsection Fluid mesh\n  set Finest cell = 0.3\nend\nsubsection Accuracy\n  set Target error = 1e-3\nend\n";
  Parameters        p    = read({"Shell mesh/Level=1", "Time/Step=0.05"}, file);
  EXPECT_EQ(p.fluid_mesh.finest_cell, 0.3);
  EXPECT_EQ(p.shell_mesh.level, 1u);
  EXPECT_EQ(p.time.step, 0.05);
  EXPECT_EQ(p.time.tolerance, 0.);
  EXPECT_EQ(p.scene.boundary, Boundary::unbounded);
  EXPECT_NEAR(std::remainder(std::log2(p.fluid_mesh.coarsest_cell / 0.3), 1.), 0., 1e-6); // the box fits the cells
  for (const Choice &choice : p.choices)
    EXPECT_TRUE(choice.name != "Finest cell" && choice.name != "Level" && choice.name != "Step" && choice.name != "Tolerance") << choice.name;
  EXPECT_GT(error_of(p, "cells"), 1e-3); // what is set by hand is judged like what is chosen
  EXPECT_GT(error_of(p, "control mesh"), 1e-3);
  p = read({target("1e-3"), "Scene/Box side=20"});
  EXPECT_EQ(p.scene.boundary, Boundary::faces);
  EXPECT_NEAR(error_of(p, "box (against unbounded liquid)"), 1e-3, 1e-12);
  p = read({target("1e-3"), "Scene/Reynolds number=1"});
  EXPECT_EQ(p.scene.boundary, Boundary::faces);
  p = read({target("1e-3"), "Capsule/Centres=0, 0, 1.5"});
  EXPECT_EQ(p.scene.boundary, Boundary::faces);
  EXPECT_EQ(p.time.limit_tolerance, 0.);
  p = read({target("1e-3"), "Solver/Coupling=explicit"});
  EXPECT_EQ(p.time.step, TimeParameters().step);
  EXPECT_TRUE(std::isnan(error_of(p, "steps")));
  p = read({target("1e-3"), "Time/Scheme=BDF2"});
  EXPECT_NEAR(p.time.tolerance, 0.25 * read({target("1e-3")}).time.tolerance, 1e-9);
  p = read({target("1e-2"), "Fluid mesh/Coarsest cell=0.4", "Scene/Box side=10"});
  EXPECT_LE(p.fluid_mesh.finest_cell, 0.4);
  EXPECT_NO_THROW(read({target("1e-3"), "Scene/Box side=20, 20, 6"}));
  EXPECT_THROW(read({target("1e-9")}), InputError);
  p = read({target("1e-3"), "Time/Steady tolerance=1e-3"});
  EXPECT_EQ(p.time.limit_tolerance, 0.);
}


TEST(Accuracy, WhatWasUsedCanBeReadAgain)
{
  std::vector<std::string> settings = disk;
  settings.push_back(target("3e-3"));
  const Parameters once = read(settings), again = read({}, once.used);
  EXPECT_TRUE(again.choices.empty());
  EXPECT_EQ(again.scene.box_side, once.scene.box_side);
  EXPECT_EQ(again.fluid_mesh.finest_cell, once.fluid_mesh.finest_cell);
  EXPECT_EQ(again.solver.newton_tolerance, once.solver.newton_tolerance);
}


TEST(Accuracy, FlatShapesHaveFinerControlMeshes)
{
  std::vector<std::string> settings = {target("3e-3"), "Capsule/Inclination=0.25", "Scene/Reduced bending modulus=0.01"};
  const unsigned int       round    = read(settings).shell_mesh.level;
  settings.push_back("Capsule/Shape=biconcave");
  EXPECT_EQ(read(settings).shell_mesh.level, round + 1);
  // Without bending a finer one would wrinkle.
  EXPECT_EQ(read({target("1e-4"), "Scene/Reduced bending modulus=0.01"}).shell_mesh.level, 3u);
  EXPECT_EQ(read({target("1e-4")}).shell_mesh.level, 2u);
}


TEST(Accuracy, TheLogSaysWhatIsChosenAndWhatIsExpected)
{
  const std::string text = accuracy_text(read({target("1e-3")}));
  for (const std::string part :
       {"Accuracy/Target error = 0.001", "Fluid mesh/Finest cell = ", "Scene/Boundary = unbounded", "control mesh", "half of it: ", "sum"})
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
  EXPECT_EQ(text.find("WARNING"), std::string::npos) << text;
  EXPECT_EQ(text.find("not known"), std::string::npos) << text;
}


TEST(Accuracy, WhatIsSetFarTooCoarseForTheTargetIsWarnedOf)
{
  const std::string text = accuracy_text(read({target("1e-2"), "Shell mesh/Level=0", "Time/Step=0.1"}));
  EXPECT_NE(text.find("WARNING: what the file sets is too coarse for Accuracy/Target error: control mesh, expected to add 0.2"), std::string::npos) << text;
  EXPECT_NE(text.find("not known: Time/Tolerance is 0"), std::string::npos) << text;
  EXPECT_EQ(accuracy_text(read({target("1e-2"), "Shell mesh/Level=1"})).find("WARNING"), std::string::npos);
}


TEST(Accuracy, AShapeThatIsWrongIsReportedAsSuch)
{
  EXPECT_THROW(read({target("1e-3"), "Scene/Box side=10, 20"}), InputError);
  EXPECT_THROW(read({target("1e-3"), "Scene/Box faces=periodic, periodic, periodic"}), InputError);
  try
    {
      read({target("1e-3"), "Capsule/Shape=file"});
      ADD_FAILURE();
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("Mesh file"), std::string::npos) << error.what();
    }
}


TEST(Accuracy, ExpectedDeformationIsThatOfSmallCapillaryNumbers)
{
  // D = (25/12) Ca / (1 + 33 khat), Ca = 3 G, and never more than 1.
  EXPECT_NEAR(expected_deformation(read({"Scene/Shear number G=0.004"})), 6.25 * 0.004, 0.03 * 6.25 * 0.004);
  EXPECT_LT(expected_deformation(read({"Scene/Shear number G=100"})), 1.);
  // That of the initial shape, however it is inclined.
  for (const std::string inclination : {"0", "0.25"})
    EXPECT_NEAR(expected_deformation(read({"Capsule/Shape=oblate", "Capsule/Aspect ratio=0.5", "Capsule/Inclination=" + inclination})), 1. / 3., 0.01);
  EXPECT_NEAR(expected_deformation(read({"Capsule/Shape=ellipsoid", "Capsule/Axes=3,2,1", "Scene/Flow=quiescent", "Scene/Reduced bending modulus=1"})),
              0.5,
              0.01);
}
