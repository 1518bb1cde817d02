// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how far the curves of two runs are apart, and how much of that is a delay.

#ifndef tanktread_simulation_curve_difference_h
#define tanktread_simulation_curve_difference_h

#include <Eigen/Core>

#include <map>
#include <string>
#include <vector>

namespace tanktread
{
  /** See curve_difference(). */
  struct CurveDifference
  {
    double size;    // largest magnitude of the curve itself
    double largest; // difference at equal times
    double at_end;  // difference at the last time, without its sign
    double rest;    // root mean square of the difference without a delay that grows at an even rate
    double time;    // delay that would make a difference as large as the rest
  };

  /**
   * Compares x(t) and y(t) = x(t) - d(t) at equal times. A clock that goes slightly wrong makes d = (c_0 + c_1 t) x'; the rest is what remains of d after the least
   * squares fit of that, and `time` is rest / root mean square of x'. A difference of extremes or of periods may vanish by chance, the rest of a whole curve hardly does.
   *
   * @param times equally apart, at least three. @param slope x'.
   */
  CurveDifference
  curve_difference(const Eigen::VectorXd &times, const Eigen::VectorXd &x, const Eigen::VectorXd &slope, const Eigen::VectorXd &d);

  /** What history.csv has of shape and rheology: one row a step of the real and the imaginary part of D exp(2 i theta), which is smooth also where a section is round for a moment, L, B, W, intrinsic_viscosity, N1, N2. */
  struct HistoryCurves
  {
    std::vector<double> times;
    Eigen::MatrixXd     values;
  };

  /** Of a file history.csv; without rows if there is none, or if it lacks a column. A row that is not complete ends it. */
  HistoryCurves
  history_curves(const std::string &file);

  /**
   * Differences of two runs over the time that both have, by the names D, theta, L, B, W, intrinsic_viscosity, N1, N2; what is not finite throughout is left out, and nothing
   * is there with fewer than four rows. Theta is in units of pi and weighted with D over its largest value, since a round section has no direction.
   */
  std::map<std::string, CurveDifference>
  curve_differences(const HistoryCurves &run, const HistoryCurves &companion);
} // namespace tanktread

#endif
