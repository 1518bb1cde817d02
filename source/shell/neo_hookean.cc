// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the neo-Hookean membrane.

#include <tanktread/shell/neo_hookean.h>

namespace tanktread
{
  MembraneDensity
  neo_hookean(const Metric &metric, const ReferenceMetric &reference, const double surface_shear_modulus)
  {
    const double          half_modulus = surface_shear_modulus / 2., det = metric.determinant(), ratio = reference.determinant / det;
    const Eigen::Vector3d trace_gradient(reference.inverse_11, 2. * reference.inverse_12, reference.inverse_22);
    const Eigen::Vector3d det_gradient(metric.a22, -2. * metric.a12, metric.a11);

    MembraneDensity w;
    w.energy   = half_modulus * (trace_gradient.dot(Eigen::Vector3d(metric.a11, metric.a12, metric.a22)) + ratio - 3.);
    w.gradient = half_modulus * (trace_gradient - ratio / det * det_gradient);
    w.hessian  = (half_modulus * 2. * ratio / (det * det)) * det_gradient * det_gradient.transpose();
    // second derivatives of the determinant
    const double factor = -half_modulus * ratio / det;
    w.hessian(0, 2) += factor;
    w.hessian(2, 0) += factor;
    w.hessian(1, 1) -= 2. * factor;
    return w;
  }
} // namespace tanktread
