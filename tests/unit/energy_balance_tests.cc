// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the balance of energy over a run.

#include <gtest/gtest.h>
#include <tanktread/simulation/energy_balance.h>

#include <cmath>
#include <limits>

using namespace tanktread;

namespace
{
  struct Series
  {
    std::vector<double> times, energies, powers;

    double
    defect() const
    {
      return energy_defect(times, energies, powers);
    }
  };

  /** E = 3 - t + t^4 / 4 and its P, at uneven times. */
  Series
  quartic()
  {
    Series s;
    for (const double t : {0., 0.1, 0.4, 0.45, 0.9, 1.1, 2.})
      {
        s.times.push_back(t);
        s.energies.push_back(3. - t + 0.25 * std::pow(t, 4));
        s.powers.push_back(1. - std::pow(t, 3));
      }
    return s;
  }
} // namespace


TEST(EnergyDefect, IsZeroWherePowersAreCubics)
{
  EXPECT_LT(quartic().defect(), 1e-13);
}


TEST(EnergyDefect, IsWhatIsMissingOverTheWork)
{
  Series     s    = quartic();
  double     work = 0.;
  const auto n    = s.times.size();
  for (std::size_t i = 0; i + 1 < n; ++i)
    work += 0.5 * (s.times[i + 1] - s.times[i]) * (std::abs(s.powers[i]) + std::abs(s.powers[i + 1]));
  s.energies[2] += 0.01; // missing in one step and too much in the next
  EXPECT_NEAR(s.defect(), 0.02 / work, 1e-13);
}


TEST(EnergyDefect, FallsWithTheFourthPowerOfTheDistanceOfLevels)
{
  const auto defect = [](const unsigned int n) {
    Series s;
    for (unsigned int i = 0; i <= n; ++i)
      {
        const double t = i / double(n);
        s.times.push_back(t);
        s.energies.push_back(std::exp(-3. * t));
        s.powers.push_back(3. * std::exp(-3. * t));
      }
    return s.defect();
  };
  EXPECT_NEAR(std::log2(defect(40) / defect(80)), 4., 0.2);
}


TEST(EnergyDefect, NeedsFourLevelsAndNumbers)
{
  Series s = quartic();
  s.times.resize(3);
  EXPECT_TRUE(std::isnan(s.defect()));
  s             = quartic();
  s.energies[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(s.defect()));
}


TEST(EnergyResidual, OfTheLastStepIsZeroWherePowersAreCubics)
{
  const Series s = quartic();
  for (std::size_t n = 4; n <= s.times.size(); ++n)
    {
      const auto first = [n](const std::vector<double> &values) { return std::vector<double>(values.begin(), values.begin() + n); };
      EXPECT_NEAR(energy_residual(first(s.times), first(s.energies), first(s.powers)), 0., 1e-13);
    }
}


TEST(EnergyResidual, IsWhatIsMissingInThatStep)
{
  Series s = quartic();
  s.energies.back() += 0.01;
  EXPECT_NEAR(energy_residual(s.times, s.energies, s.powers), 0.01, 1e-13);
  s.energies[s.energies.size() - 2] += 0.01;
  EXPECT_NEAR(energy_residual(s.times, s.energies, s.powers), 0., 1e-13);
}


TEST(EnergyResidual, FirstStepsUseWhatLevelsThereAre)
{
  EXPECT_EQ(energy_residual({}, {}, {}), 0.);
  EXPECT_EQ(energy_residual({0.}, {1.}, {2.}), 0.);
  EXPECT_NEAR(energy_residual({0., 0.5}, {1., 0.3}, {1., 2.}), -0.7 + 0.75, 1e-15);                    // the trapezoidal rule
  EXPECT_NEAR(energy_residual({0., 0.2, 1.}, {1., 0., 0.}, {0., 0.04, 1.}), (1. - 0.008) / 3., 1e-14); // the parabola t^2
}
