// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow without capsules, a polynomial of degree two.

#include <tanktread/fluid/undisturbed_flow.h>

#include <cmath>

namespace tanktread
{
  dealii::Tensor<1, 3>
  UndisturbedFlow::velocity(const dealii::Point<3> &x) const
  {
    const dealii::Tensor<1, 3> y(x);
    return constant + linear * y + 0.5 * ((quadratic * y) * y);
  }


  dealii::Tensor<2, 3>
  UndisturbedFlow::gradient(const dealii::Point<3> &x) const
  {
    return linear + quadratic * dealii::Tensor<1, 3>(x);
  }


  dealii::Tensor<1, 3>
  UndisturbedFlow::laplacian() const
  {
    dealii::Tensor<1, 3> result;
    for (unsigned int c = 0; c < 3; ++c)
      result[c] = trace(quadratic[c]);
    return result;
  }


  bool
  UndisturbedFlow::varies_along(const unsigned int d) const
  {
    for (unsigned int c = 0; c < 3; ++c)
      {
        if (linear[c][d] != 0.)
          return true;
        for (unsigned int e = 0; e < 3; ++e)
          if (quadratic[c][d][e] != 0.)
            return true;
      }
    return false;
  }


  bool
  UndisturbedFlow::is_zero() const
  {
    return constant.norm_square() == 0. && linear.norm_square() == 0. && is_linear();
  }


  bool
  UndisturbedFlow::is_linear() const
  {
    return quadratic.norm_square() == 0.;
  }


  UndisturbedFlow
  operator*(const double factor, const UndisturbedFlow &flow)
  {
    return {factor * flow.constant, factor * flow.linear, factor * flow.quadratic};
  }


  UndisturbedFlow
  linear_flow(const dealii::Tensor<2, 3> &gradient)
  {
    UndisturbedFlow result;
    result.linear = gradient;
    return result;
  }


  UndisturbedFlow
  simple_shear(const double rate)
  {
    UndisturbedFlow result;
    result.linear[0][2] = rate;
    return result;
  }


  UndisturbedFlow
  planar_extension(const double rate)
  {
    UndisturbedFlow result;
    result.linear[0][0] = rate;
    result.linear[2][2] = -rate;
    return result;
  }


  UndisturbedFlow
  uniaxial_extension(const double rate)
  {
    UndisturbedFlow result;
    result.linear[0][0] = rate;
    result.linear[1][1] = result.linear[2][2] = -0.5 * rate;
    return result;
  }


  UndisturbedFlow
  plane_poiseuille(const double half_width, const double rate)
  {
    UndisturbedFlow result;
    result.constant[0]        = 0.5 * rate * half_width;
    result.quadratic[0][2][2] = -rate / half_width;
    return result;
  }


  UndisturbedFlow
  FlowInTime::at(const double time) const
  {
    return frequency == 0. ? amplitude : std::cos(frequency * time) * amplitude;
  }
} // namespace tanktread
