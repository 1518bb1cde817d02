// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the steps of a run leave over in the balance of energy.

#include <tanktread/simulation/energy_balance.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tanktread
{
  namespace
  {
    /** Integral from times[i] to times[i + 1] of the polynomial through the values at `n` <= 4 times from `first` on. */
    double
    integral(const std::vector<double> &times, const std::vector<double> &values, const std::size_t first, const std::size_t i, const std::size_t n = 4)
    {
      const double    middle = 0.5 * (times[i] + times[i + 1]), half = 0.5 * (times[i + 1] - times[i]);
      Eigen::MatrixXd powers(n, n);
      Eigen::VectorXd at(n);
      for (std::size_t k = 0; k < n; ++k)
        {
          const double s = (times[first + k] - middle) / half;
          for (std::size_t j = 0; j < n; ++j)
            powers(k, j) = std::pow(s, j);
          at[k] = values[first + k];
        }
      const Eigen::VectorXd coefficients = powers.partialPivLu().solve(at);
      return half * (2. * coefficients[0] + (n > 2 ? 2. / 3. * coefficients[2] : 0.));
    }
  } // namespace


  double
  energy_defect(const std::vector<double> &times, const std::vector<double> &energies, const std::vector<double> &powers)
  {
    if (times.size() < 4)
      return std::numeric_limits<double>::quiet_NaN();
    double defect = 0., work = 0.;
    for (std::size_t i = 0; i + 1 < times.size(); ++i)
      {
        const std::size_t first = std::min(i == 0 ? 0 : i - 1, times.size() - 4);
        defect += std::abs(energies[i + 1] - energies[i] + integral(times, powers, first, i));
        work += 0.5 * (times[i + 1] - times[i]) * (std::abs(powers[i]) + std::abs(powers[i + 1]));
      }
    return defect / work;
  }


  double
  energy_residual(const std::vector<double> &times, const std::vector<double> &energies, const std::vector<double> &powers)
  {
    const std::size_t n = times.size();
    if (n < 2)
      return 0.;
    const std::size_t used = std::min<std::size_t>(n, 4);
    return energies[n - 1] - energies[n - 2] + integral(times, powers, n - used, n - 2, used);
  }
} // namespace tanktread
