// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the time schemes.

#include <gtest/gtest.h>
#include <tanktread/simulation/time_stepping.h>

#include <cmath>

using namespace tanktread;

namespace
{
  ControlPoints
  one_point(const double value)
  {
    return ControlPoints::Constant(1, 3, value);
  }
} // namespace


TEST(TimeStepping, BackwardEulerIsExactForLinearMotion)
{
  const ImplicitStep step = backward_euler_step(one_point(2.), 0.3);
  EXPECT_NEAR(step.xhat(0, 0) + step.tau * 5., 2. + 0.3 * 5., 1e-15);
}


TEST(TimeStepping, Bdf2IsExactForQuadraticMotionAtAnyRatioOfSteps)
{
  const auto x = [](const double t) { return 1. + 2. * t - 3. * t * t; };
  const auto v = [](const double t) { return 2. - 6. * t; };
  for (const double omega : {0.1, 0.5, 1., 1.5, 2.})
    {
      const double       previous = 0.2, dt = omega * previous, t = 0.7;
      const ImplicitStep step = bdf2_step(one_point(x(t)), one_point(x(t - previous)), dt, previous);
      EXPECT_NEAR(step.xhat(0, 1) + step.tau * v(t + dt), x(t + dt), 1e-14) << "ratio " << omega;
    }
}


TEST(TimeStepping, OrdersOnADecayingMotion)
{
  // x' = -x over one unit of time; the implicit equation is solved by hand.
  const auto error = [](const unsigned int n, const bool second_order) {
    const double  dt = 1. / n;
    ControlPoints x  = one_point(1.), previous;
    for (unsigned int i = 0; i < n; ++i)
      {
        const ImplicitStep step = second_order && i > 0 ? bdf2_step(x, previous, dt, dt) : backward_euler_step(x, dt);
        previous                = x;
        x                       = step.xhat / (1. + step.tau);
      }
    return std::abs(x(0, 0) - std::exp(-1.));
  };
  EXPECT_NEAR(std::log2(error(40, false) / error(80, false)), 1., 0.05);
  EXPECT_NEAR(std::log2(error(40, true) / error(80, true)), 2., 0.1);
}
