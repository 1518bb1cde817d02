// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: quadratic functions and Gauss points of the unit interval.

#ifndef tanktread_fluid_quadratic_element_h
#define tanktread_fluid_quadratic_element_h

#include <deal.II/base/quadrature_lib.h>

#include <array>

namespace tanktread
{
  /** At x, the quadratic functions that are one at 0, 1/2 or 1 and zero at the other two. */
  constexpr std::array<double, 3>
  quadratic_values(const double x)
  {
    return {{(1. - x) * (1. - 2. * x), 4. * x * (1. - x), x * (2. * x - 1.)}};
  }

  /** Their derivatives. */
  constexpr std::array<double, 3>
  quadratic_slopes(const double x)
  {
    return {{4. * x - 3., 4. - 8. * x, 4. * x - 1.}};
  }

  /** Their second derivatives. */
  constexpr std::array<double, 3> quadratic_curvatures = {{4., -8., 4.}};

  /** Gauss's rule with n points on the unit interval, exact for polynomials of degree 2n - 1. */
  template <unsigned int n>
  struct UnitGauss
  {
    UnitGauss()
    {
      const dealii::QGauss<1> rule(n);
      for (unsigned int q = 0; q < n; ++q)
        {
          abscissa[q] = rule.point(q)[0];
          weight[q]   = rule.weight(q);
        }
    }

    std::array<double, n> abscissa, weight;
  };
} // namespace tanktread

#endif
