// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: undisturbed flows.

#include <gtest/gtest.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <cmath>
#include <string>
#include <vector>

using namespace tanktread;

namespace
{
  using Point  = dealii::Point<3>;
  using Vector = dealii::Tensor<1, 3>;

  constexpr double pi = dealii::numbers::PI;

  struct Named
  {
    std::string     name;
    UndisturbedFlow flow;
  };

  std::vector<Named>
  flows()
  {
    dealii::Tensor<2, 3> gradient;
    gradient[0][1] = 0.3;
    gradient[1][2] = -0.7;
    gradient[2][0] = 1.1;
    return {{"simple shear", simple_shear(1.3)},
            {"planar extension", planar_extension(1.3)},
            {"uniaxial extension", uniaxial_extension(1.3)},
            {"linear", linear_flow(gradient)},
            {"plane Poiseuille", plane_poiseuille(2.5, 1.3)}};
  }

  /** All numbers different from zero, the quadratic ones too; free of divergence. */
  UndisturbedFlow
  general_flow()
  {
    UndisturbedFlow flow;
    for (unsigned int c = 0; c < 3; ++c)
      {
        flow.constant[c] = 0.4 - 0.3 * c;
        for (unsigned int d = 0; d < 3; ++d)
          {
            flow.linear[c][d] = 0.2 + 0.1 * c - 0.17 * d;
            for (unsigned int e = 0; e < 3; ++e)
              flow.quadratic[c][d][e] = 0.05 + 0.11 * c + 0.07 * (d + e) - 0.03 * d * e;
          }
      }
    flow.linear[2][2] = -flow.linear[0][0] - flow.linear[1][1];
    for (unsigned int d = 0; d < 3; ++d) // d/dx_d of the divergence is sum_c quadratic_ccd; the component d is free to make up for it
      flow.quadratic[d][d][d] -= flow.quadratic[0][0][d] + flow.quadratic[1][1][d] + flow.quadratic[2][2][d];
    return flow;
  }

  const std::vector<Point> points = {{0.1, -0.2, 0.3}, {-2.5, 1.7, 2.1}, {0., 0., 0.}, {4., -3., -2.5}};

  double
  divergence(const UndisturbedFlow &flow, const Point &x)
  {
    return trace(flow.gradient(x));
  }

  Vector
  curl(const UndisturbedFlow &flow, const Point &x)
  {
    const dealii::Tensor<2, 3> g = flow.gradient(x);
    Vector                     result;
    for (unsigned int c = 0; c < 3; ++c)
      result[c] = g[(c + 2) % 3][(c + 1) % 3] - g[(c + 1) % 3][(c + 2) % 3];
    return result;
  }

  Vector
  vector(const double x, const double y, const double z)
  {
    return Point(x, y, z);
  }
} // namespace


TEST(UndisturbedFlow, GradientIsThatOfTheVelocity)
{
  std::vector<Named> all = flows();
  all.push_back({"general", general_flow()});
  for (const auto &[name, flow] : all)
    for (const Point &x : points)
      for (unsigned int d = 0; d < 3; ++d)
        {
          const Vector e = Point::unit_vector(d), difference = 0.5 * (flow.velocity(x + e) - flow.velocity(x - e)); // exact for degree two
          Vector       column;
          for (unsigned int c = 0; c < 3; ++c)
            column[c] = flow.gradient(x)[c][d];
          EXPECT_LT((difference - column).norm(), 1e-13) << name << ", along " << d;
        }
}


TEST(UndisturbedFlow, IsFreeOfDivergence)
{
  std::vector<Named> all = flows();
  all.push_back({"general", general_flow()});
  for (const auto &[name, flow] : all)
    for (const Point &x : points)
      EXPECT_NEAR(divergence(flow, x), 0., 1e-14) << name;
}


TEST(UndisturbedFlow, ExtensionsDoNotTurnAndShearTurnsHalf)
{
  for (const Point &x : points)
    {
      EXPECT_EQ(curl(planar_extension(1.3), x).norm(), 0.);
      EXPECT_EQ(curl(uniaxial_extension(1.3), x).norm(), 0.);
      EXPECT_EQ((curl(simple_shear(1.3), x) - vector(0., 1.3, 0.)).norm(), 0.);
      EXPECT_NEAR((curl(plane_poiseuille(2.5, 1.3), x) - vector(0., -1.3 * x[2] / 2.5, 0.)).norm(), 0., 1e-15);
    }
}


TEST(UndisturbedFlow, IsWhatItsNameSays)
{
  const Point x(0.7, -0.4, 1.5);
  EXPECT_EQ((simple_shear(2.).velocity(x) - vector(3., 0., 0.)).norm(), 0.);
  EXPECT_EQ((planar_extension(2.).velocity(x) - vector(1.4, 0., -3.)).norm(), 0.);
  EXPECT_EQ((uniaxial_extension(2.).velocity(x) - vector(1.4, 0.4, -1.5)).norm(), 0.);
  EXPECT_EQ((simple_shear().velocity(x) - vector(1.5, 0., 0.)).norm(), 0.);
}


TEST(UndisturbedFlow, PoiseuilleRestsAtTheWallsWithTheGivenShearRate)
{
  const UndisturbedFlow flow = plane_poiseuille(2.5, 1.3);
  for (const double side : {-1., 1.})
    {
      const Point wall(0.3, -4., side * 2.5);
      EXPECT_NEAR(flow.velocity(wall).norm(), 0., 1e-15);
      EXPECT_NEAR(flow.gradient(wall)[0][2], -side * 1.3, 1e-15);
    }
  const double centre = flow.velocity({1., 1., 0.})[0], mean = (flow.velocity({0., 0., -2.5})[0] + 4. * centre + flow.velocity({0., 0., 2.5})[0]) / 6.;
  EXPECT_NEAR(centre, 0.5 * 1.3 * 2.5, 1e-15);
  EXPECT_NEAR(mean, 2. / 3. * centre, 1e-15);
}


TEST(UndisturbedFlow, KnowsTheAxesThatItVariesAlong)
{
  const auto axes = [](const UndisturbedFlow &flow) { return std::vector<bool>{flow.varies_along(0), flow.varies_along(1), flow.varies_along(2)}; };
  using Axes      = std::vector<bool>;
  EXPECT_EQ(axes(simple_shear()), (Axes{false, false, true}));
  EXPECT_EQ(axes(planar_extension()), (Axes{true, false, true}));
  EXPECT_EQ(axes(uniaxial_extension()), (Axes{true, true, true}));
  EXPECT_EQ(axes(plane_poiseuille(2.)), (Axes{false, false, true}));
  UndisturbedFlow uniform, saddle; // (yz, 0, 0)
  uniform.constant[1]       = 1.;
  saddle.quadratic[0][1][2] = saddle.quadratic[0][2][1] = 1.;
  EXPECT_EQ(axes(uniform), (Axes{false, false, false}));
  EXPECT_EQ(axes(saddle), (Axes{false, true, true}));
}


TEST(UndisturbedFlow, KnowsItsDegree)
{
  UndisturbedFlow uniform;
  EXPECT_TRUE(uniform.is_zero() && uniform.is_linear());
  EXPECT_TRUE((0. * general_flow()).is_zero());
  uniform.constant[2] = 1.;
  EXPECT_TRUE(!uniform.is_zero() && uniform.is_linear());
  EXPECT_TRUE(!simple_shear().is_zero() && simple_shear().is_linear());
  UndisturbedFlow parabola;
  parabola.quadratic[1][0][0] = 1.;
  EXPECT_FALSE(parabola.is_zero() || parabola.is_linear());
}


TEST(FlowInTime, SwingsWithItsFrequency)
{
  const UndisturbedFlow amplitude = general_flow();
  const Point           x(0.3, -1.2, 0.8);
  const Vector          u = amplitude.velocity(x);
  EXPECT_EQ((FlowInTime{amplitude}.at(17.3).velocity(x) - u).norm(), 0.);
  const FlowInTime swing{amplitude, 2.5};
  EXPECT_NEAR((swing.at(0.).velocity(x) - u).norm(), 0., 1e-15);
  EXPECT_NEAR((swing.at(pi / 2.5).velocity(x) + u).norm(), 0., 1e-14);
  EXPECT_NEAR(swing.at(0.5 * pi / 2.5).velocity(x).norm(), 0., 1e-14);
  EXPECT_NEAR((swing.at(0.2).velocity(x) - std::cos(0.5) * u).norm(), 0., 1e-15);
  EXPECT_NEAR((swing.at(0.2).gradient(x) - std::cos(0.5) * amplitude.gradient(x)).norm(), 0., 1e-15);
}
