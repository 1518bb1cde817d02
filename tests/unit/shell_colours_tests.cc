// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of classes of shells that are far from each other.

#include <gtest/gtest.h>
#include <tanktread/coupling/shell_colours.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace tanktread;

namespace
{
  using Boxes = std::vector<ShellBox>;

  /** Boxes of random places and sizes, some periods away along x and y. */
  Boxes
  random_boxes(const unsigned int n, const Box &box)
  {
    std::mt19937                     generator(17);
    std::uniform_real_distribution<> place(-0.5, 0.5), size(0.5, 3.);
    std::uniform_int_distribution<>  periods(-3, 3);
    Boxes                            result(n);
    for (ShellBox &shell : result)
      for (unsigned int d = 0; d < 3; ++d)
        {
          const double centre = box.side[d] * (place(generator) + (box.is_periodic(d) ? periods(generator) : 0)), half = 0.5 * size(generator);
          shell.lower[d] = centre - half;
          shell.upper[d] = centre + half;
        }
    return result;
  }


  /** Looks at many images one after the other. */
  bool
  are_near(const ShellBox &a, const ShellBox &b, const Box &box, const double margin)
  {
    for (unsigned int d = 0; d < 3; ++d)
      {
        bool near = false;
        for (int k = -8; k <= 8; ++k)
          if (k == 0 || box.is_periodic(d))
            near = near || (a.lower[d] + k * box.side[d] < b.upper[d] + margin && b.lower[d] < a.upper[d] + k * box.side[d] + margin);
        if (!near)
          return false;
      }
    return true;
  }


  unsigned int
  n_colours(const std::vector<unsigned int> &colours)
  {
    return *std::max_element(colours.begin(), colours.end()) + 1;
  }
} // namespace


TEST(ShellColours, AreTheLeastThatNoNearShellHas)
{
  for (const std::array<double, 3> &side :
       {std::array<double, 3>{{12., 12., 12.}}, std::array<double, 3>{{20., 5., 30.}}, std::array<double, 3>{{3., 40., 9.}}})
    for (const double margin : {0.3, 2.})
      {
        const Box                       box(side, Box().faces);
        const Boxes                     shells  = random_boxes(150, box);
        const std::vector<unsigned int> colours = shell_colours(shells, box, margin);
        for (unsigned int c = 0; c < shells.size(); ++c)
          {
            std::vector<char> taken(shells.size() + 1, 0);
            for (unsigned int other = 0; other < c; ++other)
              if (are_near(shells[c], shells[other], box, margin))
                taken[colours[other]] = 1;
            EXPECT_EQ(colours[c], std::find(taken.begin(), taken.end(), 0) - taken.begin());
          }
      }
}


TEST(ShellColours, TheirNumberDoesNotGrowWithTheShells)
{
  const auto lattice = [](const int n) {
    Boxes result;
    for (int i = 0; i < n * n * n; ++i)
      {
        const std::array<double, 3> centre = {{3.5 * (i % n), 3.5 * (i / n % n), 3.5 * (i / n / n)}};
        result.emplace_back();
        for (unsigned int d = 0; d < 3; ++d)
          {
            result.back().lower[d] = centre[d] - 1.75 * n;
            result.back().upper[d] = centre[d] - 1.75 * n + 2.;
          }
      }
    return n_colours(shell_colours(result, Box(3.5 * n), 1.));
  };
  EXPECT_EQ(lattice(2), 1u); // 1.5 between them
  EXPECT_EQ(lattice(12), 1u);
  Boxes row;
  for (int i = 0; i < 1000; ++i)
    row.push_back({{{3. * i, 0., 0.}}, {{3. * i + 2.5, 1., 1.}}});
  EXPECT_EQ(n_colours(shell_colours(row, Box({{3000., 10., 10.}}, Box().faces), 1.)), 2u);
}


TEST(ShellColours, PeriodsDoNotMatterAndFacesDo)
{
  const Box   box(10.);
  const Boxes shells = {{{{3., 0., 3.}}, {{4.9, 1., 4.9}}}, {{{-4.9, 0., -4.9}}, {{-3., 1., -3.}}}};
  EXPECT_EQ(n_colours(shell_colours(shells, box, 0.3)), 1u); // across the faces in z there is no liquid
  Boxes beside       = shells;
  beside[1].lower[2] = 3.;
  beside[1].upper[2] = 4.9;
  EXPECT_EQ(n_colours(shell_colours(beside, box, 0.3)), 2u);
  EXPECT_EQ(n_colours(shell_colours(beside, box, 0.1)), 1u);
  for (const double drift : {-70., 40.})
    {
      Boxes moved = beside;
      moved[0].lower[0] += drift;
      moved[0].upper[0] += drift;
      EXPECT_EQ(n_colours(shell_colours(moved, box, 0.3)), 2u);
      EXPECT_EQ(n_colours(shell_colours(moved, box, 0.1)), 1u);
    }
}


TEST(ShellColours, BoxesHoldThePoints)
{
  ControlPoints X(3, 3);
  X << 1., 2., 3., -1., 5., 0., 0., 0., 7.;
  const ShellBox box = shell_box(X), wide = joined(box, {{{0., -2., 1.}}, {{4., 0., 2.}}});
  EXPECT_EQ(box.lower, (std::array<double, 3>{{-1., 0., 0.}}));
  EXPECT_EQ(box.upper, (std::array<double, 3>{{1., 5., 7.}}));
  EXPECT_EQ(wide.lower, (std::array<double, 3>{{-1., -2., 0.}}));
  EXPECT_EQ(wide.upper, (std::array<double, 3>{{4., 5., 7.}}));
}
