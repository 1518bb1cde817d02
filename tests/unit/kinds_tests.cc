// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the kinds of capsules that a parameter file describes.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/gaps.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/random_places.h>
#include <tanktread/simulation/scene_description.h>
#include <tanktread/surface/surface_geometry.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

using namespace tanktread;

namespace
{
  const std::string two_kinds = "subsection Capsule\n"
                                "  set Membrane law = Skalak\n"
                                "  set Area dilatation number = 3\n"
                                "  set Centres = 2, 0, 0; -2, 0, 0\n"
                                "end\n"
                                "subsection Capsule 2\n"
                                "  set Centres = 0, 0, 2.5\n"
                                "  set Shape = oblate\n"
                                "  set Size = 0.5\n"
                                "  set Young modulus factor = 4\n"
                                "  set Bending modulus factor = 3\n"
                                "end\n"
                                "subsection Scene\n"
                                "  set Shear number G = 0.1\n"
                                "  set Reduced bending modulus = 0.02\n"
                                "end\n";

  Parameters
  read(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    std::ofstream("kinds.prm") << text;
    const auto result = read_parameters("kinds.prm", overrides);
    std::filesystem::remove("kinds.prm");
    return result;
  }


  std::string
  error_of(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    try
      {
        read(text, overrides);
      }
    catch (const InputError &error)
      {
        std::filesystem::remove("kinds.prm");
        return error.what();
      }
    return "";
  }


  void
  expect(const std::string &message, const std::string &part)
  {
    EXPECT_NE(message.find(part), std::string::npos) << "wanted: " << part << "\ngot: " << message;
  }


  double
  volume(const FittedShape &shape)
  {
    return enclosed_volume(SubdivisionSurface(shape.topology, triangle_quadrature(12), Derivatives::first), shape.control_points);
  }
} // namespace


TEST(Kinds, NameOnlyWhatDiffers)
{
  const Parameters parameters = read(two_kinds);
  ASSERT_EQ(parameters.kinds.size(), 2u);
  const KindParameters &first = parameters.kinds[0], &second = parameters.kinds[1];
  EXPECT_EQ(second.shell.law, MembraneLaw::skalak);
  EXPECT_EQ(second.shell.area_dilatation, 3.);
  EXPECT_EQ(first.shape.shape, Shape::sphere);
  EXPECT_EQ(second.shape.shape, Shape::oblate);
  EXPECT_EQ(first.placement.centres.size(), 2u);
  EXPECT_EQ(second.placement.centres.size(), 1u);
  EXPECT_EQ(parameters.n_capsules(), 3u);
  EXPECT_DOUBLE_EQ(parameters.moduli(first).surface_young_modulus, 10.);
  EXPECT_DOUBLE_EQ(parameters.moduli(second).surface_young_modulus, 40.);
  EXPECT_DOUBLE_EQ(parameters.moduli(second).bending_modulus, 3. * parameters.moduli(first).bending_modulus);
  // What a line of the program says about the first kind holds for the second as well; and the other way round not.
  EXPECT_EQ(read(two_kinds, {"Capsule/Prestress=0.1"}).kinds[1].shape.prestress, 0.1);
  EXPECT_EQ(read(two_kinds, {"Capsule 2/Prestress=0.1"}).kinds[0].shape.prestress, 0.);
}


TEST(Kinds, MakeAScene)
{
  const Parameters       parameters = read(two_kinds);
  const SceneDescription scene      = scene_description(parameters);
  ASSERT_EQ(scene.kinds.size(), 2u);
  EXPECT_EQ(scene.kind_of, (std::vector<unsigned int>{0, 0, 1}));
  ASSERT_EQ(scene.places.size(), 3u);
  EXPECT_EQ(scene.places[2].centre[2], 2.5);
  EXPECT_NEAR(volume(scene.kinds[0].shape), 4. * M_PI / 3., 1e-4);
  EXPECT_NEAR(volume(scene.kinds[1].shape), M_PI / 6., 1e-5);
  EXPECT_EQ(scene.kinds[1].moduli.surface_young_modulus, 40.);
  // A stress-free shape has the size of its own kind.
  const CapsuleKind kind = scene_description(read(two_kinds, {"Capsule 2/Stress-free shape=sphere"})).kinds[1];
  EXPECT_NEAR(volume({kind.shape.topology, *kind.stress_free}), M_PI / 6., 0.1 * M_PI / 6.);
}


TEST(Kinds, AreTheSameWhenReadAgain)
{
  const Parameters parameters = read(two_kinds), again = read(parameters.used), changed = with_settings(parameters, {"Shell mesh/Level=1"});
  EXPECT_EQ(again.used, parameters.used);
  EXPECT_EQ(changed.kinds[1].shape.size, 0.5);
  EXPECT_EQ(changed.shell_mesh.level, 1u);
  // Names with signs that mean something in parameter files.
  EXPECT_EQ(with_settings(read(two_kinds, {"Output/Directory=output/case#2"}), {"Shell mesh/Level=1"}).output.directory, "output/case#2");
}


TEST(Kinds, AreToldAmongTheDefaults)
{
  const std::string text = default_parameters(false);
  expect(text, "# subsection Capsule 2\n");
  expect(text, "#   set Young modulus factor = 1\n");
  EXPECT_EQ(read(text).kinds.size(), 1u);
  expect(default_parameters(true), "| Size | 1 |");
}


TEST(Kinds, WrongOnesAreRefused)
{
  expect(error_of("subsection Capsule 3\nset Centres = 3, 0, 0\nend\n"),
         "kinds.prm:1: section \"Capsule 3\" is about a further kind of capsule; allowed: \"Capsule\"");
  expect(error_of("subsection Capsule 3\nset Centres = 3, 0, 0\nend\n"), "\"Capsule 2\" is missing");
  expect(error_of("", {"Capsule 1/Thickness=0"}), "--set \"Capsule 1/Thickness=0\": section \"Capsule 1\" is about a further kind");
  expect(error_of("subsection Capsule 2\nset Shape = oblate\nend\n"), "Capsule 2/Centres: got none; allowed: that of one capsule of this kind at least.");
  expect(error_of("subsection Capsule 2\nset Centres = 1.5, 0, 0\nend\n"), "kinds.prm:2: Capsule 2/Centres: capsules 1 and 2 overlap by 0.");
  expect(error_of("subsection Capsule 2\nset Centres = 3, 0, 0\nset Prestress = -1\nend\n"), "kinds.prm:3: Capsule 2/Prestress: got -1");
  expect(error_of("subsection Capsule 2\nset Centres = 0, 0, 4.5\nend\n"), "kinds.prm:2: Capsule 2/Centres: a capsule reaches 0.49");
  expect(error_of("subsection Capsule\nset Thickness = 0.3\nend\nsubsection Capsule 2\nset Centres = 0, 0, 3\nset Size = 0.1\nend\n"),
         "kinds.prm:2: Capsule 2/Thickness");
  expect(error_of("", {"Capsule 2/Centres=" + std::string(200000, '1')}), "Capsule 2/Centres");
  expect(error_of("subsection Capsule\nset Placement = random\nset Number = 1\nend\nsubsection Capsule 2\nset Size = 0.01\nset Volume fraction = 0.1\nend\n"),
         "allowed: 1000000 at most");
  expect(error_of("subsection Capsule\nset Size = 2\nend\nsubsection Capsule 2\nend\n"),
         "unknown parameter \"Size\" in section \"Capsule\"; it belongs to section \"Capsule 2\"");
}


TEST(Kinds, OfDifferentSizesFindRoomAtRandom)
{
  const Parameters parameters = read("subsection Scene\nset Box side = 8\nend\n"
                                     "subsection Capsule\nset Placement = random\nset Number = 8\nset Least gap = 0.2\nend\n"
                                     "subsection Capsule 2\nset Size = 0.5\nset Volume fraction = 0.02\nend\n"
                                     "subsection Capsule 3\nset Placement = list\nset Centres = 0.1, 0.2, 0.3\nend\n",
                                     {"Shell mesh/Level=1"});
  ASSERT_EQ(parameters.kinds.size(), 3u);
  EXPECT_EQ(parameters.kinds[0].placement.centres.size(), 8u);
  EXPECT_EQ(parameters.kinds[1].placement.centres.size(), 20u); // 0.02 * 512 / (pi/6)
  const SceneDescription scene = scene_description(parameters);
  double                 least = std::numeric_limits<double>::infinity();
  for (unsigned int c = 0; c < scene.places.size(); ++c)
    {
      const double R = parameters.kinds[scene.kind_of[c]].shape.size;
      EXPECT_LE(std::abs(scene.places[c].centre[2]) + R, 4. - 0.2 + 1e-3);
      for (unsigned int d = 0; d < c; ++d)
        {
          Eigen::RowVector3d apart = scene.places[c].centre - scene.places[d].centre;
          for (unsigned int k = 0; k < 2; ++k)
            apart[k] = std::remainder(apart[k], 8.);
          least = std::min(least, apart.norm() - R - parameters.kinds[scene.kind_of[d]].shape.size);
        }
    }
  EXPECT_GE(least, 0.2 - 2e-3);
  EXPECT_EQ(scene.places[28].centre, Eigen::RowVector3d(0.1, 0.2, 0.3));
  expect(error_of("subsection Capsule\nset Placement = random\nset Number = 2\nend\nsubsection Capsule 2\nset Number = 2\nset Seed = 5\nend\n"),
         "kinds.prm:7: Capsule 2/Seed is not that of section Capsule");
}
