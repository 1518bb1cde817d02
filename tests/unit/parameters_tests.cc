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
  const File       file("");
  const Parameters parameters = read_parameters(file.path.string());
  EXPECT_EQ(parameters.scene.flow, Flow::shear);
  EXPECT_EQ(parameters.scene.shear_number, 0.05);
  EXPECT_EQ(parameters.scene.reduced_bending_modulus, 0.);
  EXPECT_EQ(parameters.scene.box_side, std::vector<double>{10.});
  ASSERT_EQ(parameters.kinds[0].placement.places().size(), 1u);
  EXPECT_TRUE(parameters.kinds[0].placement.places()[0].centre.isZero(0.));
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
  EXPECT_EQ(parameters.scene.box_side, std::vector<double>{8.});
  EXPECT_EQ(parameters.scene.end_time, 3.);
  EXPECT_EQ(parameters.scene.scale_modulus, ScaleModulus::shear);
  EXPECT_EQ(parameters.kinds[0].shape.shape, Shape::oblate);
  EXPECT_EQ(parameters.kinds[0].shape.inclined_axis, InclinedAxis::symmetry);
  EXPECT_EQ(parameters.kinds[0].shell.thickness, 0.05);
  EXPECT_EQ(parameters.shell_mesh.level, 2u);
  EXPECT_EQ(parameters.shell_mesh.quadrature, 12u);
  EXPECT_EQ(parameters.fluid_mesh.finest_cell, 0.25);
  EXPECT_EQ(parameters.output.directory, "here");
  EXPECT_EQ(parameters.output.history_interval, 0.5);
  EXPECT_EQ(parameters.output.field_interval, 0.);
}

TEST(Parameters, FlowsAndBoxesReachTheirMembers)
{
  const File file("");
  const auto scene = [&](const std::vector<std::string> &overrides) { return read_parameters(file.path.string(), overrides).scene; };
  const std::vector<std::pair<std::string, UndisturbedFlow>> flows = {{"shear", simple_shear()},
                                                                      {"planar extension", planar_extension()},
                                                                      {"uniaxial extension", uniaxial_extension()},
                                                                      {"plane Poiseuille", plane_poiseuille(6.)}};
  const dealii::Point<3>                                     x(0.3, 0.5, 0.7);
  for (const auto &[name, flow] : flows)
    {
      const SceneParameters parameters =
        scene({"Scene/Flow=" + name, "Scene/Box side=10,8,12", "Scene/Box faces=prescribed,prescribed,prescribed", "Scene/Frame velocity=0.1,0,-0.2"});
      const UndisturbedFlow read = parameters.undisturbed_flow().amplitude;
      EXPECT_EQ(word(parameters.flow), name);
      EXPECT_LT((read.velocity(x) - flow.velocity(x) + dealii::Tensor<1, 3>({0.1, 0., -0.2})).norm(), 1e-15) << name;
      EXPECT_EQ(read.gradient(x), flow.gradient(x)) << name;
      EXPECT_EQ(parameters.box().side, (std::array<double, 3>{{10., 8., 12.}}));
      EXPECT_FALSE(parameters.box().is_periodic(0));
    }
  EXPECT_EQ(scene({"Scene/Flow=plane Poiseuille", "Scene/Channel half width=3"}).undisturbed_flow().amplitude.velocity(dealii::Point<3>(0., 0., 3.)).norm(),
            0.);

  const SceneParameters linear = scene({"Scene/Flow=linear", "Scene/Velocity gradient=0,0,2,0,0,-1,0,0,0", "Scene/Oscillation frequency=3"});
  const FlowInTime      flow   = linear.undisturbed_flow();
  EXPECT_EQ(flow.amplitude.linear[0][2], 2.);
  EXPECT_EQ(flow.amplitude.linear[1][2], -1.);
  EXPECT_EQ(flow.frequency, 3.);
  EXPECT_TRUE(linear.box().is_periodic(0) && linear.box().is_periodic(1) && !linear.box().is_periodic(2));
  EXPECT_TRUE(scene({"Scene/Flow=quiescent", "Scene/Reduced bending modulus=1"}).undisturbed_flow().amplitude.is_zero());
}

TEST(Parameters, CentresReachTheirMembers)
{
  const File file("subsection Capsule\n  set Centres = 1, 2, -3; 40.5,0,0 ;\\\n 1, -2, 3\nend\n");
  const auto places = read_parameters(file.path.string()).kinds[0].placement.places();
  ASSERT_EQ(places.size(), 3u);
  EXPECT_EQ(places[0].centre, Eigen::RowVector3d(1., 2., -3.));
  EXPECT_EQ(places[1].centre, Eigen::RowVector3d(40.5, 0., 0.));
  EXPECT_EQ(places[2].centre, Eigen::RowVector3d(1., -2., 3.));
}

TEST(Parameters, WrongValuesAreRefused)
{
  expect_error("Scene/Shear number G=0", "allowed: a number > 0");
  expect_error("Scene/Reduced bending modulus=-1", "allowed: a number >= 0");
  expect_error("Scene/Viscosity ratio=0.001", "allowed: a number from 0.01 to 100");
  expect_error("Scene/Viscosity ratio=200", "allowed: a number from 0.01 to 100");
  expect_error("Scene/Reynolds number=-1", "allowed: a number >= 0");
  expect_error("Scene/Flow=poiseuille", "allowed: one of shear, planar extension, uniaxial extension, linear, plane Poiseuille, quiescent");
  expect_error("Scene/Flow=quiescent", "Scene/Reduced bending modulus is 0");
  expect_error("Scene/Box side=1", "allowed: 1 to 3 entries separated by commas, each a number >= 3");
  expect_error("Scene/Box side=10,2,10", "each a number >= 3");
  expect_error("Scene/Box side=10,10", "has 2 numbers; allowed: one, or three");
  expect_error("Scene/Box side=10,10,10,10", "allowed: 1 to 3 entries");
  expect_error("Scene/Box faces=periodic,periodic", "allowed: 3 entries separated by commas, each one of periodic, prescribed");
  expect_error("Scene/Box faces=periodic,wall,prescribed", "each one of periodic, prescribed");
  expect_error("Scene/Velocity gradient=1,0,0", "allowed: 9 entries separated by commas, each a number");
  expect_error("Scene/Frame velocity=1", "allowed: 3 entries separated by commas, each a number");
  expect_error("Scene/Oscillation frequency=-1", "allowed: a number >= 0");
  expect_error("Scene/Channel half width=-1", "allowed: a number >= 0");
  expect_error("Capsule/Centres=0,0", "allowed: entries separated by semicolons, each 3 entries separated by commas, each a number");
  expect_error("Scene/End time=-1", "allowed: a number >= 0");
  expect_error("Scene/Scale modulus=bulk", "allowed: one of Young, shear");
  expect_error("Capsule/Thickness=-0.1", "allowed: a number >= 0");
  expect_error("Capsule/Inclined axis=short", "allowed: one of long, symmetry");
  expect_error("Shell mesh/Level=7", "allowed: a whole number from 0 to 6");
  expect_error("Shell mesh/Quadrature=2", "allowed: one of 1, 3, 6, 7, 12");
  expect_error("Output/Checkpoint interval=-1", "allowed: a number >= 0");
  expect_error("Output/Directory=/dev/null/output", "is not a folder");
}

TEST(Parameters, ControlPointsLeaveTheMaterialOnlyWhereItsPlaceIsFree)
{
  const File file("");
  const auto stays_even = [&](std::vector<std::string> overrides, const std::string &choice) {
    overrides.push_back("Shell mesh/Even control mesh=" + choice);
    overrides.push_back("Scene/Reduced bending modulus=0.1");
    return read_parameters(file.path.string(), overrides).control_mesh_stays_even();
  };
  const std::string none = "Capsule/Membrane law=none", moments = "Capsule/Bending form=moment-only", initial = "Capsule/Reference curvature=initial";
  EXPECT_TRUE(stays_even({none, moments}, "automatic"));
  EXPECT_TRUE(stays_even({none, moments, "Capsule/Reference curvature=value", "Capsule/Reference curvature value=-1"}, "automatic"));
  EXPECT_FALSE(stays_even({none, moments}, "never"));
  EXPECT_FALSE(stays_even({none}, "automatic"));
  EXPECT_TRUE(stays_even({none}, "always"));
  EXPECT_FALSE(stays_even({moments}, "automatic"));
  EXPECT_FALSE(stays_even({none, moments, initial}, "automatic"));
  EXPECT_FALSE(stays_even({moments, "Capsule/Thickness=0.1"}, "automatic"));
  expect_error("Shell mesh/Even control mesh=sometimes", "allowed: one of automatic, always, never");
  expect_error("Shell mesh/Even control mesh=always", "allowed where the shell has a membrane, so that the place of the material matters: automatic or never.");
  EXPECT_NE(error_of({"Shell mesh/Even control mesh=always", none, initial}).find("allowed where Capsule/Reference curvature is initial"), std::string::npos);
}

TEST(Parameters, MeaninglessPairsAreRefused)
{
  EXPECT_NE(error_of({"Capsule/Membrane law=Skalak", "Capsule/Thickness=0.1"}).find("Capsule/Thickness"), std::string::npos);
  EXPECT_NE(error_of({"Capsule/Shape=ellipsoid", "Capsule/Axes=3, 2, 1", "Capsule/Inclined axis=symmetry"}).find("Capsule/Inclined axis"), std::string::npos);
  EXPECT_NE(
    error_of({"Scene/Reynolds number=1", "Solver/Coupling=explicit"}).find("Solver/Coupling is explicit; allowed with Scene/Reynolds number > 0: implicit"),
    std::string::npos);
}

TEST(Parameters, FlowsThatTheirBoxCannotHaveAreRefused)
{
  expect_error("Scene/Box faces=periodic,periodic,periodic",
               "has 'periodic' across z, but the flow (Scene/Flow = shear) changes along z; allowed there: prescribed");
  expect_error("Scene/Flow=planar extension", "has 'periodic' across x, but the flow (Scene/Flow = planar extension) changes along x");
  const std::string lines      = "subsection Scene\nset Flow = linear\nset Velocity gradient = 0,0,0, 0,1,0, 0,0,";
  const std::string divergence = error_of({}, lines + "-0.5\nend\n"), along_y = error_of({}, lines + "-1\nend\n");
  EXPECT_NE(divergence.find("x.prm:3: Scene/Velocity gradient has the divergence 0.5 (du_x/dx + du_y/dy + du_z/dz); allowed: 0"), std::string::npos)
    << divergence;
  EXPECT_NE(along_y.find("x.prm:2: Scene/Box faces has 'periodic' across y, but the flow (Scene/Flow = linear) changes along y"), std::string::npos) << along_y;
  EXPECT_EQ(error_of({"Scene/Box faces=periodic,prescribed,prescribed"}, lines + "-1\nend\n"), "");

  const std::string open =
    error_of({}, "subsection Scene\nset Flow = quiescent\nset Reduced bending modulus = 1\nset Box faces = periodic, periodic, periodic\nend\n");
  EXPECT_NE(open.find("x.prm:4: Scene/Box faces has 'periodic' across all axes; allowed: 'prescribed' across one at least"), std::string::npos) << open;

  EXPECT_NE(error_of({"Scene/Oscillation frequency=1", "Scene/Frame velocity=1,0,0"}).find("allowed with Scene/Oscillation frequency = 1: 0, 0, 0"),
            std::string::npos);
  EXPECT_NE(error_of({"Scene/Oscillation frequency=1", "Scene/Viscosity ratio=2"}).find("allowed with Scene/Viscosity ratio = 2 in this version: 0"),
            std::string::npos);
}

TEST(Parameters, CapsulesWhereTheyCannotBeAreRefused)
{
  const auto error_at = [](const std::string &centres, const std::vector<std::string> &overrides = {}) {
    return error_of(overrides, "subsection Capsule\nset Shape = sphere\nset Centres = " + centres + "\nend\n");
  };
  const auto expect = [](const std::string &message, const std::string &part) { EXPECT_NE(message.find(part), std::string::npos) << message; };
  expect(error_at("0,0,0; 3,0,0; -1.9,0.5,0"), "x.prm:3: Capsule/Centres: capsules 1 and 3 overlap by 0.03");
  expect(error_at("0,0,0; 3,0,0; -1.9,0.5,0"), "allowed: capsules that do not touch, periodic images included.");
  expect(error_at("4,0,0; -4.1,0,0"), "x.prm:3: Capsule/Centres: capsules 1 and 2 overlap by 0.09");
  expect(error_at("104,0,0; -4.1,50,0"), "capsules 1 and 2 overlap by 0.09");
  expect(error_at("0,0,0; 0,0,0"), "capsules 1 and 2 overlap by 0 a");
  expect(error_at("0,0,4.5"), "x.prm:3: Capsule/Centres: a capsule reaches 0.499");
  expect(error_at("0,0,4.5"), "beyond a face of the box with prescribed velocity; allowed: inside.");
  EXPECT_EQ(error_at("0,0,0; 2.5,0,0", {"Scene/Viscosity ratio=2", "Scene/Boundary=unbounded"}), "");
  EXPECT_EQ(error_at("0,0,0; 2.1,0,0; 50,4.9,0; 0,2.2,3.9"), "");

  // Too near to its own image for the enriched interface, or through it.
  const std::vector<std::string> narrow = {"Scene/Box side=3", "Fluid mesh/Coarsest cell=1", "Fluid mesh/Finest cell=0.3"};
  expect(error_of(narrow), "--set \"Scene/Box side=3\": Scene/Box side is 3 along x; allowed: more than 3.21");
  expect(error_of(narrow), "the capsule's extent and four finest cells to its periodic image.");
  EXPECT_EQ(error_of({narrow[0], narrow[1], narrow[2], "Solver/Interface=plain"}), "");
}

TEST(Parameters, WhatOnlyTheShapeTellsIsRefused)
{
  const std::string thick = error_of({}, "subsection Capsule\nset Shape = oblate\nset Aspect ratio = 0.5\nset Thickness = 0.7\nend\n");
  EXPECT_NE(thick.find("x.prm:4: Capsule/Thickness: got 0.7"), std::string::npos) << thick;
  EXPECT_NE(thick.find("less than twice the smallest radius of curvature of the initial shape, which is 0.3"), std::string::npos) << thick;
  const std::string large =
    error_of({"Solver/Interface=plain"}, "subsection Capsule\nset Shape = ellipsoid\nset Axes = 6, 1, 1\nend\nsubsection Scene\nset Box side = 5\nend\n");
  EXPECT_NE(large.find("x.prm:6: Scene/Box side is 5 along x; allowed: more than 6."), std::string::npos) << large;
  EXPECT_NE(large.find("the capsule's extent."), std::string::npos) << large;
}

TEST(Parameters, ShapeFromFileNeedsAFile)
{
  EXPECT_NE(error_of({"Capsule/Shape=file"}).find("Capsule/Mesh file"), std::string::npos);
}

TEST(Parameters, ErrorsOfAllSectionsComeTogetherWithTheirLines)
{
  const std::string message =
    error_of({}, "subsection Scene\nset Flow = quiescent\nset Reduced bending modulus = 0\nend\nsubsection Output\nset Directory = /dev/null/output\nend\n");
  EXPECT_NE(message.find("x.prm:3: Scene/Reduced bending modulus is 0"), std::string::npos) << message;
  EXPECT_NE(message.find("x.prm:6: Output/Directory is"), std::string::npos) << message;
}

TEST(Parameters, MeshFileIsTakenRelativeToTheParameterFile)
{
  const File file("subsection Capsule\nset Shape = file\nset Mesh file = meshes/../tetrahedron.off\nend\n");
  std::ofstream(file.folder / "tetrahedron.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const Parameters  parameters = read_parameters(file.path.string());
  const std::string mesh       = (file.folder / "tetrahedron.off").string();
  EXPECT_EQ(parameters.kinds[0].shape.file, mesh);
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
