// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the curves of a run and its companion say about the bars of single numbers.

#ifndef tanktread_simulation_curve_bars_h
#define tanktread_simulation_curve_bars_h

#include <tanktread/simulation/curve_difference.h>

#include <map>
#include <optional>
#include <string>

namespace tanktread
{
  /** Of all capsules by the name of the curve, with several capsules also their number: "D", or "D_1", "D_2". */
  using CurveDifferences = std::map<std::string, CurveDifference>;

  /** Of the files history.csv, or history_1.csv, ..., in two folders. */
  CurveDifferences
  curve_differences_of(const std::string &folder, const std::string &companion_folder);

  /** "D_curve" for "D", "D_curve_2" for "D_2". */
  std::string
  quantity_of_curve(const std::string &name);

  /** What a curve counts for, at all times or at one: safety for a single companion, which tells no order. */
  double
  difference_of_curve(const CurveDifference &curve);

  /**
   * The difference that a number of the summary counts for at least, however near to each other those of run and companion are: theory.md, (52c'). Nothing for numbers that
   * come from no curve. @param quantity its name, "D_minimum" or, of several capsules, "D_minimum_2". @param summary of the run.
   */
  std::optional<double>
  least_difference(const std::string &quantity, const std::map<std::string, double> &summary, const CurveDifferences &curves);

  /** The difference of a limit which the companion has none of: that of the last values. */
  std::optional<double>
  difference_of_limit(const std::string &quantity, const CurveDifferences &curves);
} // namespace tanktread

#endif
