// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the time schemes.

#include <gtest/gtest.h>
#include <tanktread/simulation/step_history.h>

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


TEST(TimeStepping, Sdirk2IsExactForQuadraticMotionAndDampsWhatIsStiff)
{
  const auto   x = [](const double t) { return 1. + 2. * t - 3. * t * t; };
  const auto   v = [](const double t) { return 2. - 6. * t; };
  const double t = 0.7, dt = 0.3;

  const ImplicitStep  stage        = sdirk2_stage(one_point(x(t)), dt);
  const ControlPoints displacement = one_point(stage.tau * v(t + stage.tau));
  const ImplicitStep  step         = sdirk2_step(one_point(x(t)), displacement, dt);
  EXPECT_NEAR(step.xhat(0, 0) + step.tau * v(t + dt), x(t + dt), 1e-14);

  // x' = -k x with k dt = 1e6: what is left after the step.
  const double        k         = 1e6 / dt;
  const ControlPoints x_stage   = sdirk2_stage(one_point(1.), dt).xhat / (1. + k * stage.tau);
  const ImplicitStep  last      = sdirk2_step(one_point(1.), x_stage - one_point(1.), dt);
  const double        remaining = (last.xhat / (1. + k * last.tau))(0, 0);
  EXPECT_LT(std::abs(remaining), 1e-5);
}


TEST(TimeStepping, OrdersOnADecayingMotion)
{
  // x' = -x over one unit of time; the implicit equation is solved by hand.
  const auto error = [](const unsigned int n, const bool second_order) {
    const double  dt = 1. / n;
    ControlPoints x  = one_point(1.), previous;
    for (unsigned int i = 0; i < n; ++i)
      {
        ImplicitStep step = second_order && i > 0 ? bdf2_step(x, previous, dt, dt) : backward_euler_step(x, dt);
        if (second_order && i == 0)
          {
            const ImplicitStep stage = sdirk2_stage(x, dt);
            step                     = sdirk2_step(x, stage.xhat / (1. + stage.tau) - x, dt);
          }
        previous = x;
        x        = step.xhat / (1. + step.tau);
      }
    return std::abs(x(0, 0) - std::exp(-1.));
  };
  const auto error_of_first_step = [](const double dt) {
    StepHistory history{TimeParameters()};
    history.add(0., {one_point(1.)});
    EXPECT_TRUE(history.starts());
    const ShellSteps stage = history.first_stage(dt), step = history.second_stage(dt, {stage.xhat[0] / (1. + stage.tau) - one_point(1.)});
    return std::abs(step.xhat[0](0, 0) / (1. + step.tau) - std::exp(-dt));
  };
  EXPECT_NEAR(std::log2(error(40, false) / error(80, false)), 1., 0.05);
  EXPECT_NEAR(std::log2(error(40, true) / error(80, true)), 2., 0.1);
  EXPECT_NEAR(std::log2(error_of_first_step(0.05) / error_of_first_step(0.025)), 3., 0.1);
}


TEST(StepHistory, LocalErrorIsWhatTheExactMotionLeavesInTheScheme)
{
  // For a cubic motion the leading term is all there is (BDF2), for a quadratic one too (backward Euler).
  const auto x = [](const double t) -> ShellFields { return {one_point(1. + 2. * t - 3. * t * t + 4. * t * t * t)}; };
  const auto v = [](const double t) { return one_point(2. - 6. * t + 12. * t * t); };

  TimeParameters parameters;
  parameters.tolerance = 1e-3;
  StepHistory bdf2(parameters);
  for (const double t : {0.1, 0.25, 0.3})
    bdf2.add(t, x(t));
  for (const double length : {0.04, 0.1})
    {
      const ShellSteps    step = bdf2.step(length);
      const ControlPoints left = x(0.3 + length)[0] - step.xhat[0] - step.tau * v(0.3 + length);
      EXPECT_NEAR(bdf2.local_error(length, x(0.3 + length)), left.norm(), 1e-12);
    }

  const auto y      = [](const double t) -> ShellFields { return {one_point(1. - 3. * t * t)}; };
  parameters.scheme = TimeScheme::backward_euler;
  StepHistory euler(parameters);
  euler.add(0., y(0.));
  EXPECT_EQ(euler.local_error(0.1, y(0.1)), 0.);
  euler.add(0.1, y(0.1));
  EXPECT_NEAR(euler.local_error(0.2, y(0.3)), 3. * 0.2 * 0.2 * std::sqrt(3.), 1e-12);
  EXPECT_NEAR(euler.length_factor(4. * parameters.tolerance), 0.45, 1e-12);
  EXPECT_EQ(euler.length_factor(0.), 1.5);
}


TEST(StepHistory, ErrorsOfSeveralCapsulesAreAMeanOverAllControlPoints)
{
  // One of three control points moves: a third of the mean square.
  const auto x = [](const double t) -> ShellFields {
    ControlPoints second = ControlPoints::Constant(2, 3, 1. + t * t * t);
    second.row(1).setConstant(5.);
    return {one_point(7.), second};
  };
  const auto  alone = [](const double t) -> ShellFields { return {one_point(1. + t * t * t)}; };
  StepHistory together{TimeParameters()}, one{TimeParameters()};
  for (const double t : {0.1, 0.25, 0.3})
    {
      together.add(t, x(t));
      one.add(t, alone(t));
    }
  EXPECT_NEAR(together.local_error(0.1, x(0.4)), one.local_error(0.1, alone(0.4)) / std::sqrt(3.), 1e-14);
  const ShellSteps step = together.step(0.1);
  ASSERT_EQ(step.xhat.size(), 2u);
  EXPECT_EQ(step.tau, one.step(0.1).tau);
  EXPECT_EQ(step.xhat[1].row(0), one.step(0.1).xhat[0].row(0));
}
