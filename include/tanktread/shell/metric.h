// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the metric of the middle surface, deformed and undeformed, and what a membrane law makes of it.

#ifndef tanktread_shell_metric_h
#define tanktread_shell_metric_h

#include <Eigen/Core>

namespace tanktread
{
  /** Covariant components a_{alpha beta} = a_alpha . a_beta at a point. */
  struct Metric
  {
    double a11, a12, a22;

    double
    determinant() const
    {
      return a11 * a22 - a12 * a12;
    }
  };

  /** The undeformed metric as the laws need it: contravariant components and determinant of the covariant ones. */
  struct ReferenceMetric
  {
    ReferenceMetric() = default;

    explicit ReferenceMetric(const Metric &metric)
      : determinant(metric.determinant())
      , inverse_11(metric.a22 / determinant)
      , inverse_12(-metric.a12 / determinant)
      , inverse_22(metric.a11 / determinant)
    {}

    double determinant, inverse_11, inverse_12, inverse_22;
  };

  /** Strain energy w per undeformed area with its first and second derivatives by the three numbers (a11, a12, a22). */
  struct MembraneDensity
  {
    double          energy;
    Eigen::Vector3d gradient;
    Eigen::Matrix3d hessian;
  };
} // namespace tanktread

#endif
