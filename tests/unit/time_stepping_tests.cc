// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the time schemes.

#include <gtest/gtest.h>
#include <tanktread/simulation/step_history.h>

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace tanktread;

namespace
{
  ControlPoints
  one_point(const double value)
  {
    return ControlPoints::Constant(1, 3, value);
  }
} // namespace


TEST(TimeSchemes, BackwardDifferentiationIsExactForPolynomialsAtAnyRatioOfSteps)
{
  const std::vector<double> times = {0.9, 0.7, 0.61, 0.3};
  for (const unsigned int degree : {1, 2, 3})
    {
      const MultistepFormula formula = backward_differentiation({times.begin(), times.begin() + degree + 1});
      ASSERT_EQ(formula.weights.size(), degree);
      for (unsigned int power = 0; power <= degree; ++power)
        {
          double x = power == 0 ? 0. : formula.tau * power * std::pow(times[0], power - 1.);
          for (unsigned int i = 0; i < degree; ++i)
            x += formula.weights[i] * std::pow(times[i + 1], power);
          EXPECT_NEAR(x, std::pow(times[0], power), 1e-14) << power << " of " << degree;
        }
    }
  // The textbook's figures for equal steps.
  EXPECT_NEAR(backward_differentiation({0.2, 0.1}).tau, 0.1, 1e-15);
  EXPECT_NEAR(backward_differentiation({0.2, 0.1, 0.}).tau, 0.1 * 2. / 3., 1e-15);
  const MultistepFormula bdf3 = backward_differentiation({3., 2., 1., 0.});
  EXPECT_NEAR(bdf3.tau, 6. / 11., 1e-15);
  EXPECT_NEAR(bdf3.weights[0], 18. / 11., 1e-14);
  EXPECT_NEAR(bdf3.weights[1], -9. / 11., 1e-14);
  EXPECT_NEAR(bdf3.weights[2], 2. / 11., 1e-14);
}


TEST(TimeSchemes, SdirkIntegratesPolynomialsAndDampsWhatIsStiff)
{
  for (const unsigned int q : {2, 3})
    {
      const SdirkScheme &scheme = sdirk(q);
      const std::size_t  n      = scheme.ends.size();
      // x' = t^power from 0 to 1, by the last stage.
      for (unsigned int power = 0; power < q; ++power)
        {
          double x = scheme.gamma * std::pow(scheme.ends[n - 1], power);
          for (std::size_t j = 0; j + 1 < n; ++j)
            x += scheme.weights[n - 1][j] * scheme.gamma * std::pow(scheme.ends[j], power);
          EXPECT_NEAR(x, 1. / (power + 1.), 1e-14) << "order " << q << ", power " << power;
        }
      const auto after_step = [&](const double z) { // of x' = k x from 1, z = k dt
        std::vector<double> x;
        for (std::size_t i = 0; i < n; ++i)
          {
            double hat = 1.;
            for (std::size_t j = 0; j < i; ++j)
              hat += scheme.weights[i][j] * scheme.gamma * z * x[j];
            x.push_back(hat / (1. - scheme.gamma * z));
          }
        return x.back();
      };
      EXPECT_LT(std::abs(after_step(-1e6)), 1e-5);
      for (const double z : {-0.02, 0.02})
        EXPECT_NEAR((std::exp(z) - after_step(z)) / std::pow(z, q + 1.), scheme.error_constant, 0.06 * std::abs(scheme.error_constant)) << q;
    }
  EXPECT_THROW(sdirk(1), std::logic_error);
}


namespace
{
  /** One step of x' = -x from the levels of a history; the implicit equations are solved by hand. */
  double
  decayed(const StepHistory &history, const double dt)
  {
    std::vector<ShellFields> displacements;
    double                   x = 0.;
    for (unsigned int i = 0; i < history.n_stages(); ++i)
      {
        const ShellSteps step = history.stage(i, dt, displacements);
        x                     = step.xhat[0](0, 0) / (1. + step.tau);
        displacements.push_back({one_point(-step.tau * x)});
      }
    return x;
  }

  TimeParameters
  with(const TimeScheme scheme)
  {
    TimeParameters result;
    result.scheme    = scheme;
    result.tolerance = 1e-3;
    return result;
  }

  const std::vector<TimeScheme> all_schemes = {TimeScheme::backward_euler, TimeScheme::bdf2, TimeScheme::bdf3, TimeScheme::sdirk2, TimeScheme::sdirk3};
} // namespace


TEST(StepHistory, OrdersOnADecayingMotionFromItsFirstStep)
{
  for (const TimeScheme scheme : all_schemes)
    {
      const auto error = [&](const unsigned int n) {
        StepHistory history(with(scheme));
        history.add(0., {one_point(1.)});
        for (unsigned int i = 1; i <= n; ++i)
          history.add(i / double(n), {one_point(decayed(history, 1. / n))});
        return std::abs(history.at(1.)[0](0, 0) - std::exp(-1.));
      };
      const auto error_of_first_step = [&](const double dt) {
        StepHistory history(with(scheme));
        history.add(0., {one_point(1.)});
        return std::abs(decayed(history, dt) - std::exp(-dt));
      };
      EXPECT_NEAR(std::log2(error(40) / error(80)), order(scheme), 0.1);
      EXPECT_NEAR(std::log2(error_of_first_step(0.05) / error_of_first_step(0.025)), order(scheme) + 1., 0.1);
    }
}


TEST(StepHistory, NumbersOfStages)
{
  for (const TimeScheme scheme : all_schemes)
    {
      StepHistory history(with(scheme));
      for (unsigned int i = 0; i < 4; ++i)
        {
          history.add(0.1 * i, {one_point(1.)});
          const bool is_one = is_multistep(scheme) && i + 1 >= order(scheme);
          EXPECT_EQ(history.n_stages(), is_one ? 1 : order(scheme));
          EXPECT_EQ(history.stage_end(history.n_stages() - 1), 1.);
        }
    }
}


TEST(StepHistory, OtherFieldsHaveTheSameScheme)
{
  // A field that follows the positions, u = 2 x + 3, has the explicit parts 2 xhat + 3 in all stages.
  const auto u = [](const double x) { return 2. * x + 3.; };
  for (const TimeScheme scheme : all_schemes)
    for (const unsigned int n_levels : {1, 4})
      {
        StepHistory         history(with(scheme));
        std::vector<double> levels;
        for (unsigned int i = 0; i < n_levels; ++i)
          {
            levels.insert(levels.begin(), 1. - 0.3 * i * i);
            history.add(0.1 * i + 0.01 * i * i, {one_point(levels[0])});
          }
        std::vector<ShellFields> displacements;
        std::vector<double>      stages;
        for (unsigned int i = 0; i < history.n_stages(); ++i)
          {
            const ShellSteps   step    = history.stage(i, 0.2, displacements);
            const StageWeights weights = history.stage_weights(i, 0.2);
            double             uhat    = 0.;
            for (std::size_t k = 0; k < weights.levels.size(); ++k)
              uhat += weights.levels[k] * u(levels[k]);
            for (std::size_t j = 0; j < weights.stages.size(); ++j)
              uhat += weights.stages[j] * u(stages[j]);
            EXPECT_NEAR(uhat, u(step.xhat[0](0, 0)), 1e-13);
            displacements.push_back({one_point(0.7 * i - 0.4)});
            stages.push_back(step.xhat[0](0, 0) + displacements.back()[0](0, 0));
          }
      }
}


TEST(StepHistory, LocalErrorIsWhatTheExactMotionLeavesInTheScheme)
{
  // For a polynomial of degree q + 1 the leading term is all there is.
  const auto power = [](const double t, const unsigned int p) -> ShellFields { return {one_point(1. + 2. * t - 3. * std::pow(t, p))}; };
  for (const TimeScheme scheme : {TimeScheme::backward_euler, TimeScheme::bdf2, TimeScheme::bdf3})
    {
      const unsigned int p = order(scheme) + 1;
      StepHistory        history(with(scheme));
      for (const double t : {0.1, 0.25, 0.3, 0.42})
        history.add(t, power(t, p));
      for (const double length : {0.04, 0.1})
        {
          const double        now  = 0.42 + length;
          const ShellSteps    step = history.stage(0, length, {});
          const ControlPoints left = power(now, p)[0] - step.xhat[0] - step.tau * one_point(2. - 3. * p * std::pow(now, p - 1.));
          EXPECT_NEAR(history.local_error(length, power(now, p)), left.norm(), 1e-12);
        }
    }
  // SDIRK on a slow exponential.
  for (const TimeScheme scheme : {TimeScheme::sdirk2, TimeScheme::sdirk3})
    {
      StepHistory  history(with(scheme));
      const double dt = 0.01;
      for (unsigned int i = 0; i < 4; ++i)
        history.add(i * dt, {one_point(std::exp(-(i * dt)))});
      const double next = std::exp(-4. * dt), error = decayed(history, dt) - next;
      EXPECT_NEAR(history.local_error(dt, {one_point(next)}), std::abs(error) * std::sqrt(3.), 0.1 * std::abs(error) * std::sqrt(3.));
    }
}


TEST(StepHistory, LengthsMeetTheTolerance)
{
  StepHistory euler(with(TimeScheme::backward_euler)), bdf3(with(TimeScheme::bdf3));
  EXPECT_NEAR(euler.length_factor(4e-3), 0.45, 1e-12);
  EXPECT_NEAR(bdf3.length_factor(16e-3), 0.45, 1e-12);
  EXPECT_EQ(euler.length_factor(0.), 1.5);
  euler.add(0., {one_point(0.)});
  EXPECT_EQ(euler.local_error(0.1, {one_point(0.1)}), 0.); // nothing to tell it from
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
  StepHistory together(with(TimeScheme::bdf2)), one(with(TimeScheme::bdf2));
  for (const double t : {0.1, 0.25, 0.3})
    {
      together.add(t, x(t));
      one.add(t, alone(t));
    }
  EXPECT_NEAR(together.local_error(0.1, x(0.4)), one.local_error(0.1, alone(0.4)) / std::sqrt(3.), 1e-14);
  const ShellSteps step = together.stage(0, 0.1, {});
  ASSERT_EQ(step.xhat.size(), 2u);
  EXPECT_EQ(step.tau, one.stage(0, 0.1, {}).tau);
  EXPECT_EQ(step.xhat[1].row(0), one.stage(0, 0.1, {}).xhat[0].row(0));
}
