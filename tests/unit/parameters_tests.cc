// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the parameters of a run.

#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/parameters.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

using namespace tanktread;
namespace fs = std::filesystem;

namespace
{
  /** A parameter file with the given lines, removed at the end. */
  struct File
  {
    fs::path folder, path;

    explicit File(const std::string &text)
      : folder(fs::temp_directory_path() / ("tanktread_parameters_tests_" + std::to_string(getpid())))
      , path(folder / "x.prm")
    {
      fs::create_directories(folder);
      std::ofstream(path) << text;
    }

    ~File()
    {
      fs::remove_all(folder);
    }
  };

  std::string
  error_of(const std::vector<std::string> &overrides, const std::string &text = "# nothing\n")
  {
    const File file(text);
    try
      {
        read_parameters(file.path.string(), overrides);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }

  void
  expect_error(const std::string &setting, const std::string &part)
  {
    const std::string message = error_of({setting});
    EXPECT_NE(message.find("--set \"" + setting + "\": "), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
} // namespace

TEST(Parameters, EmptyFileGivesDefaults)
{
  const File       file("# nothing\n");
  const Parameters parameters = read_parameters(file.path.string());
  EXPECT_EQ(parameters.scene.flow, Flow::shear);
  EXPECT_EQ(parameters.scene.shear_number, 0.05);
  EXPECT_EQ(parameters.scene.reduced_bending_modulus, 0.);
  EXPECT_EQ(parameters.scene.box_side, 10.);
  EXPECT_EQ(parameters.shell_mesh.level, 3u);
  EXPECT_EQ(parameters.shell_mesh.quadrature, 3u);
  EXPECT_EQ(parameters.output.directory, "output/x");
  EXPECT_EQ(parameters.file, file.path.string());
}

TEST(Parameters, ValuesReachTheirMembers)
{
  const File       file("# nothing\n");
  const Parameters parameters = read_parameters(file.path.string(),
                                                {"Scene/Flow=quiescent",
                                                 "Scene/Shear number G=0.5",
                                                 "Scene/Reduced bending modulus=0.25",
                                                 "Scene/Box side=8",
                                                 "Scene/End time=3",
                                                 "Scene/Scale modulus=shear",
                                                 "Capsule/Shape=oblate",
                                                 "Capsule/Inclined axis=symmetry",
                                                 "Capsule/Thickness=0.05",
                                                 "Shell mesh/Level=2",
                                                 "Shell mesh/Quadrature=12",
                                                 "Fluid mesh/Finest cell=0.25",
                                                 "Output/Directory=here",
                                                 "Output/History interval=0.5",
                                                 "Output/Field interval=0"});
  EXPECT_EQ(parameters.scene.flow, Flow::quiescent);
  EXPECT_EQ(parameters.scene.shear_number, 0.5);
  EXPECT_EQ(parameters.scene.reduced_bending_modulus, 0.25);
  EXPECT_EQ(parameters.scene.box_side, 8.);
  EXPECT_EQ(parameters.scene.end_time, 3.);
  EXPECT_EQ(parameters.scene.scale_modulus, ScaleModulus::shear);
  EXPECT_EQ(parameters.capsule.shape, Shape::oblate);
  EXPECT_EQ(parameters.capsule.inclined_axis, InclinedAxis::symmetry);
  EXPECT_EQ(parameters.shell.thickness, 0.05);
  EXPECT_EQ(parameters.shell_mesh.level, 2u);
  EXPECT_EQ(parameters.shell_mesh.quadrature, 12u);
  EXPECT_EQ(parameters.fluid_mesh.finest_cell, 0.25);
  EXPECT_EQ(parameters.output.directory, "here");
  EXPECT_EQ(parameters.output.history_interval, 0.5);
  EXPECT_EQ(parameters.output.field_interval, 0.);
}

TEST(Parameters, WrongValuesAreRefused)
{
  expect_error("Scene/Shear number G=0", "allowed: a number > 0");
  expect_error("Scene/Reduced bending modulus=-1", "allowed: a number >= 0");
  expect_error("Scene/Viscosity ratio=0.001", "allowed: a number from 0.01 to 100");
  expect_error("Scene/Viscosity ratio=200", "allowed: a number from 0.01 to 100");
  expect_error("Scene/Reynolds number=-1", "allowed: a number >= 0");
  expect_error("Scene/Flow=poiseuille", "allowed: one of shear, quiescent");
  expect_error("Scene/Flow=quiescent", "Scene/Reduced bending modulus is 0");
  expect_error("Scene/Box side=1", "allowed: a number >= 3");
  expect_error("Scene/End time=-1", "allowed: a number >= 0");
  expect_error("Scene/Scale modulus=bulk", "allowed: one of Young, shear");
  expect_error("Capsule/Thickness=-0.1", "allowed: a number >= 0");
  expect_error("Capsule/Inclined axis=short", "allowed: one of long, symmetry");
  expect_error("Shell mesh/Level=7", "allowed: a whole number from 0 to 6");
  expect_error("Shell mesh/Quadrature=2", "allowed: one of 1, 3, 6, 7, 12");
  expect_error("Output/Checkpoint interval=1", "not available in this version, allowed: 0");
  expect_error("Output/Directory=/dev/null/output", "is not a folder");
}

TEST(Parameters, MeaninglessPairsAreRefused)
{
  EXPECT_NE(error_of({"Capsule/Membrane law=Skalak", "Capsule/Thickness=0.1"}).find("Capsule/Thickness"), std::string::npos);
  EXPECT_NE(error_of({"Capsule/Shape=ellipsoid", "Capsule/Axes=3, 2, 1", "Capsule/Inclined axis=symmetry"}).find("Capsule/Inclined axis"), std::string::npos);
  EXPECT_NE(
    error_of({"Scene/Reynolds number=1", "Solver/Coupling=explicit"}).find("Solver/Coupling is explicit; allowed with Scene/Reynolds number > 0: implicit"),
    std::string::npos);
}

TEST(Parameters, ShapeFromFileNeedsAFile)
{
  EXPECT_NE(error_of({"Capsule/Shape=file"}).find("Capsule/Mesh file"), std::string::npos);
}

TEST(Parameters, ErrorsOfAllSectionsComeTogetherWithTheirLines)
{
  const std::string message =
    error_of({}, "subsection Scene\nset Flow = quiescent\nset Reduced bending modulus = 0\nend\nsubsection Output\nset Checkpoint interval = 3\nend\n");
  EXPECT_NE(message.find("x.prm:3: Scene/Reduced bending modulus is 0"), std::string::npos) << message;
  EXPECT_NE(message.find("x.prm:6: Output/Checkpoint interval is 3"), std::string::npos) << message;
}

TEST(Parameters, MeshFileIsTakenRelativeToTheParameterFile)
{
  const File file("subsection Capsule\nset Shape = file\nset Mesh file = meshes/../tetrahedron.off\nend\n");
  std::ofstream(file.folder / "tetrahedron.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const Parameters  parameters = read_parameters(file.path.string());
  const std::string mesh       = (file.folder / "tetrahedron.off").string();
  EXPECT_EQ(parameters.capsule.file, mesh);
  EXPECT_NE(parameters.used.find("set Mesh file = " + mesh + "\n"), std::string::npos) << parameters.used;

  fs::remove(mesh);
  try
    {
      read_parameters(file.path.string());
      ADD_FAILURE();
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("x.prm:3: Capsule/Mesh file"), std::string::npos) << error.what();
    }
}

TEST(Parameters, EchoReadsBackTheSame)
{
  const File       file("subsection Scene\nset End time = 2.5\nend\n");
  const Parameters first = read_parameters(file.path.string(), {"Capsule/Shape=biconcave"});
  const File       echo(first.used);
  EXPECT_EQ(read_parameters(echo.path.string()).used, first.used);
  EXPECT_NE(first.used.find("set End time = 2.5\n"), std::string::npos);
}

TEST(Parameters, PrintingNamesEverySectionOnce)
{
  const std::string text = default_parameters(true);
  std::size_t       at   = 0;
  for (const char *const section : {"## Scene\n", "## Capsule\n", "## Shell mesh\n", "## Fluid mesh\n", "## Time\n", "## Solver\n", "## Output\n"})
    {
      at = text.find(section, at);
      ASSERT_NE(at, std::string::npos) << section << text;
      EXPECT_EQ(text.find(section, at + 1), std::string::npos) << section;
    }
}

TEST(SceneParameters, ModuliFollowFromTheNumbers)
{
  SceneParameters scene;
  scene.shear_number            = 0.05;
  scene.reduced_bending_modulus = 0.01;
  EXPECT_DOUBLE_EQ(scene.surface_young_modulus(), 20.);
  EXPECT_DOUBLE_EQ(scene.bending_modulus(), 0.2);
  scene.flow = Flow::quiescent;
  EXPECT_DOUBLE_EQ(scene.surface_young_modulus(), 100.);
  EXPECT_DOUBLE_EQ(scene.bending_modulus(), 1.);

  // made with G_s = E h/3 the same numbers mean three times the Young's modulus
  scene.scale_modulus = ScaleModulus::shear;
  EXPECT_DOUBLE_EQ(scene.surface_young_modulus(), 300.);
  EXPECT_DOUBLE_EQ(scene.bending_modulus(), 1.);
  scene.flow = Flow::shear;
  EXPECT_DOUBLE_EQ(scene.surface_young_modulus(), 60.);
  EXPECT_DOUBLE_EQ(scene.bending_modulus(), 0.2);
}
