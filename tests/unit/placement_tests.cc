// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of where capsules start: lists, files, at random.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/gaps.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/random_places.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace tanktread;

namespace
{
  /** A file in the working directory that is gone afterwards. */
  struct File
  {
    File(const std::string &name, const std::string &text)
      : path(name)
    {
      std::ofstream(path) << text;
    }
    ~File()
    {
      std::filesystem::remove(path);
    }
    const std::filesystem::path path;
  };

  template <typename Call>
  std::string
  error_of(const Call &call)
  {
    try
      {
        call();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }

  bool
  has(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }

  FittedShape
  shape(const Shape kind, const unsigned int level = 2)
  {
    CapsuleShapeParameters parameters;
    parameters.shape        = kind;
    parameters.aspect_ratio = 0.4;
    return make_capsule(parameters, level);
  }

  const std::array<Faces, 3> between_walls = {{Faces::periodic, Faces::periodic, Faces::prescribed}};

  /** Smallest distance of two centres, nearest images along x and y. */
  double
  least_distance(const std::vector<Place> &places, const Box &box)
  {
    double result = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        {
          Eigen::RowVector3d apart = places[i].centre - places[j].centre;
          for (unsigned int d = 0; d < 3; ++d)
            if (box.is_periodic(d))
              apart[d] = std::remainder(apart[d], box.side[d]);
          result = std::min(result, apart.norm());
        }
    return result;
  }
} // namespace


TEST(Placement, ListsSayWhatPlacesAre)
{
  const Eigen::Matrix3d    turn   = (Eigen::AngleAxisd(2.5, Eigen::Vector3d(1., -2., 0.5).normalized())).toRotationMatrix();
  const std::vector<Place> places = {Eigen::RowVector3d(1. / 3., -2., 1e-7), Place({4., 5., 6.}, turn)};
  const auto [centres, rotations] = as_lists(places);
  const File               file("placement.prm",
                  "subsection Scene\nset Box side = 40\nend\nsubsection Capsule\nset Centres = " + centres + "\nset Rotations = " + rotations + "\nend\n");
  const std::vector<Place> found = read_parameters(file.path.string()).kinds[0].placement.places();
  ASSERT_EQ(found.size(), 2u);
  for (unsigned int c = 0; c < 2; ++c)
    {
      EXPECT_LT((found[c].centre - places[c].centre).norm(), 1e-14);
      EXPECT_LT((found[c].turn - places[c].turn).norm(), 1e-14);
    }
  EXPECT_EQ(as_lists({Place()}).second, "");
  ControlPoints x(1, 3);
  x << 1., 2., 3.;
  EXPECT_LT((placed(x, places[1]).row(0).transpose() - (turn * Eigen::Vector3d(1., 2., 3.) + Eigen::Vector3d(4., 5., 6.))).norm(), 1e-14);
}


TEST(Placement, FilesAreRead)
{
  const File good("places.txt", "# x y z rotation\n0 0 0\n\n3, 0.5, 0  0 0.5 0 # a quarter of a turn about y\n");
  const auto places = read_places(good.path.string());
  ASSERT_EQ(places.size(), 2u);
  EXPECT_TRUE(places[0].turn.isIdentity(0.));
  EXPECT_LT((places[1].turn * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_TRUE(has(error_of([] { read_places("missing.txt"); }), "'missing.txt' cannot be read"));
  const File bad("bad_places.txt", "0 0 0\n1 2\n"), word("word_places.txt", "0 0 zero\n"), empty("empty_places.txt", "# nothing\n");
  EXPECT_TRUE(has(error_of([&] { read_places(bad.path.string()); }), "line 2 of 'bad_places.txt' is '1 2'"));
  EXPECT_TRUE(has(error_of([&] { read_places(word.path.string()); }), "line 1 of 'word_places.txt'"));
  EXPECT_TRUE(has(error_of([&] { read_places(empty.path.string()); }), "no line with a place"));

  // From a parameter file, in whose folder they are; what was used is a list.
  const File       prm("from_file.prm", "subsection Capsule\nset Placement = file\nset Places file = places.txt\nend\n");
  const Parameters parameters = read_parameters(prm.path.string());
  EXPECT_EQ(parameters.kinds[0].placement.places().size(), 2u);
  EXPECT_TRUE(has(parameters.used, "= list")) << parameters.used;
}


TEST(Placement, WrongOnesAreRefused)
{
  const auto error = [](const std::string &lines) {
    const File file("wrong.prm", "subsection Capsule\n" + lines + "\nend\n");
    return error_of([&] { read_parameters(file.path.string()); });
  };
  EXPECT_TRUE(has(error("set Centres = 0,0,0; 3,0,0\nset Rotations = 0,0,1"), "wrong.prm:3: Capsule/Rotations: got 1 of them"))
    << error("set Centres = 0,0,0; 3,0,0\nset Rotations = 0,0,1");
  EXPECT_TRUE(has(error("set Placement = file"), "Capsule/Places file: the placement 'file' needs the name of a file."));
  EXPECT_TRUE(has(error("set Placement = random"), "Capsule/Number: got 0 with"));
  EXPECT_TRUE(has(error("set Placement = random\nset Number = 3\nset Volume fraction = 0.1"), "wrong.prm:3: Capsule/Number: got 3 with"));
  for (const char *const number : {"100", "300"}) // 42 % of the box, and more than it
    EXPECT_TRUE(has(error("set Placement = random\nset Least gap = 0.3\nset Number = " + std::string(number)),
                    "wrong.prm:4: Capsule/Number: " + std::string(number) + " capsules with gaps of 0.3 a find no room in the box"))
      << number;
}


TEST(Placement, RandomSpheresDoNotTouch)
{
  const Box             box({{8., 9., 10.}}, between_walls);
  const RandomPlacement wanted{7, 0.05, 0.2}; // 30 % of the volume
  const auto            places = random_places(wanted, {{shape(Shape::sphere), 52}}, box)[0];
  ASSERT_EQ(places.size(), 52u);
  EXPECT_GE(least_distance(places, box), 2.05 - 1e-3);
  double farthest = 0., square = 0.;
  for (const Place &place : places)
    {
      farthest = std::max(farthest, std::abs(place.centre[2]));
      square += place.centre[0] * place.centre[0] / places.size();
      EXPECT_TRUE(place.turn.isIdentity(0.));
    }
  EXPECT_LE(farthest, 3.8 + 1e-3);
  EXPECT_NEAR(square, 64. / 12., 64. / 12. * 4. * std::sqrt(0.8 / 52.)); // evenly spread along x; four standard deviations

  const auto again = random_places(wanted, {{shape(Shape::sphere), 52}}, box)[0], other = random_places({8, 0.05, 0.2}, {{shape(Shape::sphere), 52}}, box)[0];
  EXPECT_EQ(places[51].centre, again[51].centre);
  EXPECT_GT((places[51].centre - other[51].centre).norm(), 1e-3);
}


TEST(Placement, RandomDisksDoNotTouch)
{
  const Box         box({{9., 9., 9.}}, between_walls);
  const FittedShape disk   = shape(Shape::biconcave, 3);
  const auto        places = random_places({3, 0.1, 0.1}, {{shape(Shape::biconcave), 26, true}}, box)[0]; // 15 %
  ShellFields       x;
  double            upright = 0.;
  for (const Place &place : places)
    {
      x.push_back(placed(disk.control_points, place));
      upright += place.turn(2, 2) * place.turn(2, 2) / places.size();
    }
  const Capsule  capsule(disk, {triangle_quadrature(3), triangle_quadrature(12), Derivatives::second}, {}, {1., 0.}, {});
  const ShellGap gap = smallest_gap(shell_configurations(capsule, x), {{9., 9., std::numeric_limits<double>::infinity()}}, 1.);
  std::cout << "smallest gap " << gap.gap << ", cosines squared with z " << upright << std::endl;
  EXPECT_GT(gap.gap, 0.05);                                      // 0.1 from point to plane
  EXPECT_NEAR(upright, 1. / 3., 4. * std::sqrt(4. / 45. / 26.)); // four standard deviations
  EXPECT_GE(smallest_distance_from_faces(shell_configurations(capsule, x), {{100., 100., 4.5}}), 0.05);
}
