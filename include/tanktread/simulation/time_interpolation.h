// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: values of a run between its steps.

#ifndef tanktread_simulation_time_interpolation_h
#define tanktread_simulation_time_interpolation_h

#include <Eigen/Core>

#include <vector>

namespace tanktread
{
  /** Index of the last of `times`, which ascend, that is not after `time`; the first one before all of them. */
  Eigen::Index
  last_before(const std::vector<double> &times, double time);

  /** Values at `time`, by the cubics through the four samples around it; nearest to the ends through the first and the last four. @param values one row a time, at least four. */
  Eigen::RowVectorXd
  interpolated(const std::vector<double> &times, const Eigen::MatrixXd &values, double time);
} // namespace tanktread

#endif
