// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the limit that a relaxing motion is extrapolated to, and of its error bar.

#include <gtest/gtest.h>
#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/relaxation_limit.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <stdexcept>

using namespace tanktread;

namespace
{
  using Curve = std::function<Eigen::RowVectorXd(double)>;

  std::vector<double>
  equal_steps(const double end, const double step)
  {
    std::vector<double> times;
    for (int n = 0; n * step < end + 1e-9; ++n)
      times.push_back(n * step);
    return times;
  }

  Eigen::MatrixXd
  at(const std::vector<double> &times, const Curve &curve)
  {
    Eigen::MatrixXd values(times.size(), curve(0.).size());
    for (std::size_t n = 0; n < times.size(); ++n)
      values.row(n) = curve(times[n]);
    return values;
  }

  Eigen::RowVectorXd
  row(const std::vector<double> &values)
  {
    return Eigen::Map<const Eigen::RowVectorXd>(values.data(), values.size());
  }

  /** An overshoot that decays, and something that decays faster; the third column goes with them. */
  const Eigen::RowVector3d two_modes_limit(0.4, 0.1, 7.);
  Eigen::RowVectorXd
  two_modes(const double t)
  {
    const double slow = std::exp(-0.8 * t), fast = std::exp(-2.5 * t);
    return two_modes_limit +
      Eigen::RowVector3d(-0.3 * slow * std::cos(0.9 * t) - 0.1 * fast, 0.1 * slow * std::sin(0.9 * t) + 0.05 * fast, slow * std::cos(0.9 * t + 1.) - 2. * fast);
  }

  /** Columns t, D, theta / pi, L, B, W of a file of benchmarks/reference. */
  std::vector<MotionSample>
  reference(const std::string &name)
  {
    std::ifstream             file(std::string(REFERENCE_FOLDER) + '/' + name);
    std::vector<MotionSample> result;
    for (std::string line; std::getline(file, line);)
      {
        if (line.empty() || !(std::isdigit(line[0])))
          continue;
        std::stringstream   fields(line);
        std::vector<double> numbers;
        for (std::string field; std::getline(fields, field, ',');)
          numbers.push_back(std::stod(field));
        MotionSample sample{numbers[0], numbers[1], numbers[2], 0., 0.};
        sample.L = numbers[3];
        sample.B = numbers[4];
        sample.W = numbers[5];
        result.push_back(sample);
      }
    return result;
  }

  std::vector<MotionSample>
  until(const std::vector<MotionSample> &samples, const double end)
  {
    std::vector<MotionSample> result;
    for (const MotionSample &sample : samples)
      if (sample.time < end + 1e-9)
        result.push_back(sample);
    return result;
  }

  /** The last sample at which the largest bar has been below the tolerance three times in a row, or a number that is not one. */
  double
  time_known(const std::vector<MotionSample> &samples, const double tolerance)
  {
    unsigned int n_known = 0;
    for (const MotionSample &sample : samples)
      {
        n_known = motion_limits(until(samples, sample.time)).largest_error() < tolerance ? n_known + 1 : 0;
        if (n_known == 3)
          return sample.time;
      }
    return std::nan("");
  }
} // namespace

TEST(ReducedRankExtrapolation, IsExactForExponentials)
{
  const Curve curve = [](const double t) { return row({1. - 0.5 * std::exp(-t), 2. + 0.1 * std::exp(-t) - std::exp(-0.3 * t)}); };
  for (const unsigned int stride : {1u, 3u})
    {
      const Eigen::MatrixXd limit = reduced_rank_extrapolation(at(equal_steps(4., 0.25), curve), 2, 2, stride);
      EXPECT_EQ(limit.rows(), 17 - 2 * int(stride));
      for (Eigen::Index n = 0; n < limit.rows(); ++n)
        EXPECT_LT((limit.row(n) - row({1., 2.})).norm(), 1e-11);
    }
}

TEST(ReducedRankExtrapolation, IsExactForDampedOscillationsAndCarriesOtherColumnsAlong)
{
  const Eigen::MatrixXd limit = reduced_rank_extrapolation(at(equal_steps(4., 0.2), two_modes), 2, 3, 2);
  EXPECT_LT((limit.rowwise() - two_modes_limit).norm(), 1e-9);
}

TEST(ReducedRankExtrapolation, OfAConstantIsTheConstant)
{
  EXPECT_LT((reduced_rank_extrapolation(Eigen::MatrixXd::Constant(12, 2, 3.), 2, 3, 1).array() - 3.).matrix().norm(), 1e-14);
}

TEST(ReducedRankExtrapolation, RefusesTooFewSamples)
{
  EXPECT_THROW(reduced_rank_extrapolation(Eigen::MatrixXd::Zero(8, 2), 2, 3, 2), std::invalid_argument);
}

TEST(RelaxationLimits, ComeCloserThanTheInterpolationInTime)
{
  // At t = 6 the last values are 2e-3 away from the limit; cubics through steps of 0.1 are wrong by 1e-7 there.
  const std::vector<double>          times  = equal_steps(6., 0.1);
  const std::vector<RelaxationLimit> limits = relaxation_limits(times, at(times, two_modes), 2);
  for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(limits[c].value, two_modes_limit[c], 1e-5);
      EXPECT_LE(std::abs(limits[c].value - two_modes_limit[c]), limits[c].error);
      EXPECT_LT(limits[c].error, 2e-4 * (c == 2 ? 10. : 1.));
    }
}

TEST(RelaxationLimits, TakeUnequalSteps)
{
  std::vector<double> times = {0.};
  while (times.back() < 6.)
    times.push_back(times.back() + 0.06 + 0.02 * times.back() + (times.size() % 2) * 0.03);
  const std::vector<RelaxationLimit> limits = relaxation_limits(times, at(times, two_modes), 2);
  for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(limits[c].value, two_modes_limit[c], 1e-3);
      EXPECT_LE(std::abs(limits[c].value - two_modes_limit[c]), limits[c].error);
    }
}

TEST(RelaxationLimits, HaveBarsThatHoldWithNoise)
{
  std::mt19937                     generator(7);
  std::normal_distribution<double> noise(0., 1.);
  unsigned int                     n_bars = 0, n_held = 0, n_wide = 0;
  for (const double size : {1e-6, 1e-5, 1e-4, 1e-3})
    for (unsigned int sample = 0; sample < 10; ++sample)
      for (const double end : {4., 6., 9., 14.})
        {
          const std::vector<double> times  = equal_steps(end, 0.1);
          Eigen::MatrixXd           values = at(times, two_modes);
          for (Eigen::Index n = 0; n < values.rows(); ++n)
            for (Eigen::Index c = 0; c < 3; ++c)
              values(n, c) += size * noise(generator);
          const std::vector<RelaxationLimit> limits = relaxation_limits(times, values, 2);
          for (int c = 0; c < 3; ++c)
            if (!std::isnan(limits[c].value))
              {
                ++n_bars;
                n_held += std::abs(limits[c].value - two_modes_limit[c]) <= limits[c].error ? 1 : 0;
                n_wide += limits[c].error > std::max(50. * size, 30. * std::abs(two_modes(end)[c] - two_modes_limit[c])) ? 1 : 0;
              }
        }
  EXPECT_GT(n_bars, 400u);
  EXPECT_GE(n_held, 0.95 * n_bars) << n_bars;
  EXPECT_LE(n_wide, 0.05 * n_bars);
}

TEST(RelaxationLimits, SayNothingOfMotionsThatDoNotRelax)
{
  const std::vector<std::pair<std::string, Curve>> motions = {{"swinging",
                                                               [](const double t) {
    return row({0.2 + 0.05 * std::cos(1.3 * t), 0.15 + 0.03 * std::sin(1.3 * t)});
                                                               }},
                                                              {"swinging after a start",
                                                               [](const double t) {
    return row({0.2 - 0.2 * std::exp(-2. * t) + 0.05 * std::cos(1.3 * t), 0.15 + 0.1 * std::exp(-t) + 0.03 * std::sin(1.3 * t)});
                                                               }},
                                                   {"tumbling",
                                                    [](const double t) {
    return row({0.1 + 0.05 * std::cos(t), -0.16 * t});
                                                    }},
    {"growing",
     [](const double t) {
    return row({0.01 * std::exp(0.4 * t), 0.15});
     }},
    {"drifting",
     [](const double t) {
    return row({0.1 + 0.01 * t, 0.15});
     }},
    {"hardly begun", [](const double t) {
       return row({0.3 - 0.3 * std::exp(-0.01 * t), 0.15});
     }}};
  for (const auto &[name, curve] : motions)
    for (const double end : {12., 20., 40.})
      {
        const std::vector<double> times = equal_steps(end, 0.1);
        for (const RelaxationLimit &limit : relaxation_limits(times, at(times, curve), 2))
          EXPECT_TRUE(std::isnan(limit.value) && std::isnan(limit.error)) << name << " to " << end << ": " << limit.value << " +- " << limit.error;
      }
}

TEST(RelaxationLimits, LeaveOutWhatIsNotDefined)
{
  const std::vector<double> times  = equal_steps(6., 0.1);
  Eigen::MatrixXd           values = at(times, two_modes);
  const auto                whole  = relaxation_limits(times, values, 2);
  values(0, 1)                     = std::nan(""); // the start is forgotten
  const auto without_start         = relaxation_limits(times, values, 2);
  EXPECT_EQ(without_start[1].value, whole[1].value);
  values(50, 1)   = std::nan("");
  const auto rest = relaxation_limits(times, values, 2);
  EXPECT_TRUE(std::isnan(rest[1].value));
  EXPECT_NEAR(rest[0].value, two_modes_limit[0], rest[0].error);
  EXPECT_TRUE(std::isnan(relaxation_limits({0., 0.1}, values.topRows(2), 2)[0].value));
  EXPECT_EQ(relaxation_limits({}, values.topRows(0), 2).size(), 3u);
}

TEST(MotionLimits, OfReferencesHoldAndAreKnownEarly)
{
  for (const std::string name : {"sphere_G0.2_k0.04_variational.csv", "sphere_G0.2_k0.15_moment_only.csv", "sphere_G0.05_k0_lambda5.csv"})
    {
      const std::vector<MotionSample> samples = reference(name);
      ASSERT_GT(samples.size(), 40u) << name;
      const MotionSample &truth  = samples.back();
      unsigned int        n_bars = 0, n_held = 0;
      for (const MotionSample &sample : samples)
        {
          const MotionLimits limits = motion_limits(until(samples, sample.time));
          const auto         judge  = [&](const RelaxationLimit &limit, const double value) {
            if (std::isnan(limit.value))
              return;
            ++n_bars;
            n_held += std::abs(limit.value - value) <= limit.error + 2e-6 ? 1 : 0; // the series have their errors
          };
          judge(limits.D, truth.D);
          judge(limits.theta, truth.theta);
          judge(limits.L, truth.L);
          judge(limits.B, truth.B);
          judge(limits.W, truth.W);
        }
      EXPECT_GT(n_bars, 100u) << name;
      EXPECT_GE(n_held, 0.95 * n_bars) << name << ": " << n_held << " of " << n_bars;
      // The values themselves are that near for good at this time only:
      double near = truth.time;
      for (std::size_t n = samples.size(); n-- > 0 && std::abs(samples[n].D - truth.D) < 3e-3 * truth.D;)
        near = samples[n].time;
      EXPECT_LT(time_known(samples, 3e-3), near) << name;
    }
}

TEST(MotionLimits, OfSwingingAndTumblingReferencesAreNeverKnown)
{
  for (const std::string name :
       {"oblate_G0.05_k0.01_moment_only.csv", "oblate_G0.05_k0_lambda5.csv", "oblate_G0.008_k0.csv", "oblate_G0.005_k0.01_moment_only.csv"})
    EXPECT_TRUE(std::isnan(time_known(reference(name), 1e-2))) << name;
}
