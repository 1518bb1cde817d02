// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Skalak's membrane.

#include <tanktread/shell/skalak.h>

namespace tanktread
{
  MembraneDensity
  skalak(const Metric &metric, const ReferenceMetric &reference, const double surface_shear_modulus, const double area_dilatation)
  {
    const double          quarter_modulus = surface_shear_modulus / 4.;
    const Eigen::Vector3d I_1_gradient(reference.inverse_11, 2. * reference.inverse_12, reference.inverse_22);
    const Eigen::Vector3d I_2_gradient = Eigen::Vector3d(metric.a22, -2. * metric.a12, metric.a11) / reference.determinant;
    const double          I_1          = I_1_gradient.dot(Eigen::Vector3d(metric.a11, metric.a12, metric.a22)) - 2.;
    const double          I_2          = metric.determinant() / reference.determinant - 1.;
    const double          by_I_1 = quarter_modulus * (2. * I_1 + 2.), by_I_2 = quarter_modulus * (-2. + 2. * area_dilatation * I_2);

    MembraneDensity w;
    w.energy   = quarter_modulus * (I_1 * I_1 + 2. * I_1 - 2. * I_2 + area_dilatation * I_2 * I_2);
    w.gradient = by_I_1 * I_1_gradient + by_I_2 * I_2_gradient;
    w.hessian =
      (2. * quarter_modulus) * I_1_gradient * I_1_gradient.transpose() + (2. * quarter_modulus * area_dilatation) * I_2_gradient * I_2_gradient.transpose();
    // second derivatives of I_2
    const double factor = by_I_2 / reference.determinant;
    w.hessian(0, 2) += factor;
    w.hessian(2, 0) += factor;
    w.hessian(1, 1) -= 2. * factor;
    return w;
  }
} // namespace tanktread
