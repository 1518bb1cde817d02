// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the implicit time schemes as formulas.

#include <tanktread/simulation/time_schemes.h>

#include <cstddef>
#include <stdexcept>

namespace tanktread
{
  unsigned int
  order(const TimeScheme scheme)
  {
    switch (scheme)
      {
        case TimeScheme::backward_euler:
          return 1;
        case TimeScheme::bdf2:
        case TimeScheme::sdirk2:
          return 2;
        case TimeScheme::bdf3:
        case TimeScheme::sdirk3:
          return 3;
      }
    throw std::logic_error("order: no such scheme.");
  }


  bool
  is_multistep(const TimeScheme scheme)
  {
    return scheme != TimeScheme::sdirk2 && scheme != TimeScheme::sdirk3;
  }


  MultistepFormula
  backward_differentiation(const std::vector<double> &times)
  {
    // Derivatives of Lagrange's polynomials at times[0]: of the new level's own sum_j 1 / (t_0 - t_j), of the others as below.
    const double now = times[0];
    double       own = 0.;
    for (std::size_t j = 1; j < times.size(); ++j)
      own += 1. / (now - times[j]);
    MultistepFormula result{{}, 1. / own};
    for (std::size_t i = 1; i < times.size(); ++i)
      {
        double slope = 1. / (times[i] - now);
        for (std::size_t j = 1; j < times.size(); ++j)
          if (j != i)
            slope *= (now - times[j]) / (times[i] - times[j]);
        result.weights.push_back(-slope / own);
      }
    return result;
  }


  namespace
  {
    /** From the rows of Butcher's matrix below its diagonal. */
    SdirkScheme
    sdirk_scheme(const double gamma, const std::vector<std::vector<double>> &a, const double error_constant)
    {
      SdirkScheme result{gamma, a, {}, error_constant};
      for (std::vector<double> &row : result.weights)
        {
          double end = gamma;
          for (double &weight : row)
            {
              end += weight;
              weight /= gamma;
            }
          result.ends.push_back(end);
        }
      result.ends.back() = 1.;
      return result;
    }


    SdirkScheme
    sdirk2()
    {
      const double g = 0.29289321881345247560; // 1 - 1 / sqrt(2)
      return sdirk_scheme(g, {{}, {1. - g}}, 1. / 6. - 3. * g * g + 2. * g * g * g);
    }


    SdirkScheme
    sdirk3()
    {
      const double g      = 0.43586652150845899942; // root of g^3 - 3 g^2 + 3/2 g = 1/6
      const double first  = -(6. * g * g - 16. * g + 1.) / 4.;
      const double second = (6. * g * g - 20. * g + 5.) / 4.;
      const double half   = 0.5 * (1. - g);
      // The coefficient of z^4 in the stability function is the product of the row, the matrix cubed and a column of ones.
      const double cube = g * g * g + 3. * g * g * (first + second) + 3. * g * second * half;
      return sdirk_scheme(g, {{}, {half}, {first, second}}, 1. / 24. - (g * cube + first * g * g * g + second * (g * g * g + 3. * g * g * half)));
    }
  } // namespace


  const SdirkScheme &
  sdirk(const unsigned int order)
  {
    static const SdirkScheme second = sdirk2(), third = sdirk3();
    if (order != 2 && order != 3)
      throw std::logic_error("sdirk: order 2 or 3.");
    return order == 2 ? second : third;
  }
} // namespace tanktread
