// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the surface's VTU files and their time series, and of the phase angles.

#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/phase_angles.h>
#include <tanktread/simulation/surface_vtu.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/subdivision_surface.h>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

using namespace tanktread;

namespace
{
  struct Output : testing::Test
  {
    void
    SetUp() override
    {
      folder = std::filesystem::temp_directory_path() / ("tanktread_output_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
      std::filesystem::remove_all(folder);
      std::filesystem::create_directories(folder);
    }

    void
    TearDown() override
    {
      std::filesystem::remove_all(folder);
    }

    std::string
    path(const std::string &name) const
    {
      return (folder / name).string();
    }

    std::string
    content(const std::string &name) const
    {
      std::ifstream in(folder / name, std::ios::binary);
      return {std::istreambuf_iterator<char>(in), {}};
    }

    std::filesystem::path folder;
  };

  /** An octahedron: small enough to be checked number by number. */
  ControlPoints
  octahedron()
  {
    ControlPoints x(6, 3);
    x << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
    return x;
  }

  const std::vector<std::array<int, 3>> octahedron_faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

  std::string
  decode(const std::string &text)
  {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string       bytes;
    unsigned int      bits = 0, n_bits = 0;
    for (const char c : text)
      {
        const std::size_t digit = digits.find(c);
        if (digit == std::string::npos)
          break;
        bits = bits << 6 | static_cast<unsigned int>(digit);
        n_bits += 6;
        if (n_bits >= 8)
          bytes += static_cast<char>(bits >> (n_bits -= 8) & 255u);
      }
    return bytes;
  }

  /** The numbers of the DataArray `name`; checks type, number of components and the byte count in front of the data. */
  template <typename Number>
  std::vector<Number>
  array(const std::string &file, const std::string &name, const std::string &type, const int n_components)
  {
    const std::string tag =
      "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(n_components) + "\" format=\"binary\">";
    const std::size_t start = file.find(tag);
    if (start == std::string::npos)
      throw std::runtime_error("no array " + tag);
    const std::string text  = file.substr(start + tag.size(), file.find('<', start + tag.size()) - start - tag.size());
    const std::string bytes = decode(text);
    std::uint64_t     n_bytes;
    std::memcpy(&n_bytes, bytes.data(), sizeof(n_bytes));
    EXPECT_EQ(n_bytes + sizeof(n_bytes), bytes.size());
    EXPECT_EQ(text.size() % 4, 0u);
    std::vector<Number> values(n_bytes / sizeof(Number));
    std::memcpy(values.data(), bytes.data() + sizeof(n_bytes), n_bytes);
    return values;
  }
} // namespace

TEST_F(Output, VtuHoldsPointsCellsAndFieldsBitForBit)
{
  const ControlPoints   x      = octahedron() / 3.0;
  const Eigen::MatrixXd scalar = Eigen::VectorXd::LinSpaced(6, -1e-300, 0.1), vector = x.array().sin().matrix();
  write_surface_vtu(path("s.vtu"), x, octahedron_faces, {{"curvature", scalar}, {"velocity", vector}});
  const std::string file = content("s.vtu");

  EXPECT_NE(file.find("<Piece NumberOfPoints=\"6\" NumberOfCells=\"8\">"), std::string::npos);
  const auto points = array<double>(file, "Points", "Float64", 3), curvature = array<double>(file, "curvature", "Float64", 1),
             velocity = array<double>(file, "velocity", "Float64", 3);
  ASSERT_EQ(points.size(), 18u);
  ASSERT_EQ(velocity.size(), 18u);
  ASSERT_EQ(curvature.size(), 6u);
  for (int i = 0; i < 6; ++i)
    {
      EXPECT_EQ(curvature[i], scalar(i, 0));
      for (int c = 0; c < 3; ++c)
        {
          EXPECT_EQ(points[3 * i + c], x(i, c));
          EXPECT_EQ(velocity[3 * i + c], vector(i, c));
        }
    }
  const auto connectivity = array<std::int32_t>(file, "connectivity", "Int32", 1), offsets = array<std::int32_t>(file, "offsets", "Int32", 1);
  const auto types = array<std::uint8_t>(file, "types", "UInt8", 1);
  ASSERT_EQ(connectivity.size(), 24u);
  EXPECT_EQ(types, std::vector<std::uint8_t>(8, 5));
  for (int f = 0; f < 8; ++f)
    {
      EXPECT_EQ(offsets[f], 3 * (f + 1));
      for (int v = 0; v < 3; ++v)
        EXPECT_EQ(connectivity[3 * f + v], octahedron_faces[f][v]);
    }
}

TEST_F(Output, VtuMarksNormalsToShadeBy)
{
  const ControlPoints x = octahedron();
  write_surface_vtu(path("with.vtu"), x, octahedron_faces, {{"velocity", x}, {"normals", x}});
  write_surface_vtu(path("without.vtu"), x, octahedron_faces, {{"velocity", x}});
  EXPECT_NE(content("with.vtu").find("<PointData Normals=\"normals\">"), std::string::npos);
  EXPECT_NE(content("without.vtu").find("<PointData>"), std::string::npos);
}

TEST_F(Output, VtuRefusesWhatDoesNotFit)
{
  const ControlPoints x = octahedron();
  EXPECT_THROW(write_surface_vtu(path("s.vtu"), x, octahedron_faces, {{"short", Eigen::MatrixXd::Zero(5, 1)}}), std::invalid_argument);
  EXPECT_THROW(write_surface_vtu(path("s.vtu"), x, octahedron_faces, {{"wide", Eigen::MatrixXd::Zero(6, 2)}}), std::invalid_argument);
  EXPECT_THROW(write_surface_vtu(path("s.vtu"), x, {{0, 1, 6}}, {}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path("s.vtu")));
  EXPECT_THROW(write_surface_vtu(path("no_such_folder/s.vtu"), x, octahedron_faces, {}), OutputError);
}

TEST_F(Output, PvdIsCompleteAfterEachEntry)
{
  PvdFile pvd(path("capsule.pvd"));
  EXPECT_FALSE(std::filesystem::exists(path("capsule.pvd")));
  const double third = 1.0 / 3.0;
  pvd.add(0, "capsule_0000.vtu");
  const std::string first = content("capsule.pvd");
  pvd.add(third, "capsule_0001.vtu");
  const std::string second = content("capsule.pvd");

  for (const std::string &file : {first, second})
    EXPECT_EQ(file.substr(file.size() - std::string("</Collection>\n</VTKFile>\n").size()), "</Collection>\n</VTKFile>\n") << file;
  EXPECT_NE(first.find("<DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"capsule_0000.vtu\"/>"), std::string::npos);
  EXPECT_EQ(first.find("capsule_0001"), std::string::npos);
  EXPECT_NE(second.find("capsule_0000.vtu"), std::string::npos);
  const std::size_t entry = second.find("<DataSet timestep=\"0.33");
  ASSERT_NE(entry, std::string::npos);
  EXPECT_NEAR(std::stod(second.substr(entry + 19)), third, 5e-13); // deal.II writes 12 digits
  for (const auto &left_over : std::filesystem::directory_iterator(folder))
    EXPECT_EQ(left_over.path().filename(), "capsule.pvd");
  EXPECT_THROW(PvdFile(path("no_such_folder/c.pvd")).add(0, "c.vtu"), OutputError);
}


TEST(PhaseAngles, FollowsTheMaterialAndTheShapeRoundAndRound)
{
  // An ellipsoid whose shape tumbles by 0.11 pi a step while its material turns by -0.4 pi: both beyond a full turn.
  CapsuleShapeParameters parameters;
  parameters.shape               = Shape::ellipsoid;
  parameters.axes                = {{2., 1.5, 1.}};
  const FittedShape     shape    = make_capsule(parameters, 2);
  const SparseMatrix    limit    = vertex_limit_stencils(shape.topology);
  const Eigen::MatrixXd inverse  = Eigen::MatrixXd(limit).inverse(); // control points from limit positions
  const Eigen::Vector3d axes     = std::cbrt(1. / 3.) * Eigen::Vector3d(2., 1.5, 1.);
  const ControlPoints   start_at = limit * shape.control_points;

  // Material points of the unit sphere turn by alpha - theta, are mapped to the ellipsoid, and that turns by theta.
  const auto control_points = [&](const double theta, const double alpha) -> ControlPoints {
    ControlPoints x(start_at.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      {
        const double sx = start_at(i, 0) / axes[0], sz = start_at(i, 2) / axes[2], phase = M_PI * (alpha - theta);
        const double u = axes[0] * (std::cos(phase) * sx - std::sin(phase) * sz), w = axes[2] * (std::sin(phase) * sx + std::cos(phase) * sz);
        x.row(i) << std::cos(M_PI * theta) * u - std::sin(M_PI * theta) * w, start_at(i, 1), std::sin(M_PI * theta) * u + std::cos(M_PI * theta) * w;
      }
    return inverse * x;
  };
  InertiaEllipsoid ellipsoid{};
  ellipsoid.centroid.setZero();
  PhaseAngles  phase(shape.topology, control_points(0., 0.), ellipsoid, 0.);
  const double start = phase.alpha();
  EXPECT_NEAR(phase.delta(), 0., 1e-15);
  for (int step = 1; step <= 12; ++step)
    {
      phase.update(control_points(0.11 * step, -0.4 * step), ellipsoid, std::remainder(0.11 * step, 1.));
      EXPECT_NEAR(phase.delta() - (phase.alpha() - start), -0.11 * step, 1e-12);
      // On an ellipse the polar angle runs ahead of and behind the material's phase, by less than a quarter turn.
      EXPECT_NEAR(phase.alpha() - start, -0.4 * step, 0.25);
    }

  // Round at first: the phase counts from the first time that the section has a direction.
  PhaseAngles round(shape.topology, control_points(0., 0.), ellipsoid, std::nan(""));
  EXPECT_TRUE(std::isnan(round.delta()));
  round.update(control_points(0., -0.1), ellipsoid, 0.2);
  EXPECT_EQ(round.delta(), 0.);
}
