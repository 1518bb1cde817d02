// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: error bars of the numbers of a run, split by cause.

#ifndef tanktread_simulation_study_table_h
#define tanktread_simulation_study_table_h

#include <tanktread/simulation/curve_bars.h>
#include <tanktread/simulation/error_estimate.h>
#include <tanktread/simulation/study_plan.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tanktread
{
  /** The time at which the run of this folder has ended, by its summary; nothing without one. */
  std::optional<double>
  end_of_run(const std::string &folder);

  /** The finite numbers of a summary.csv by their names, nothing if the file is missing or its run has failed. Names of times, "from" and "end", and what begins with "worst_", the signs of bad resolution, are left out. */
  std::optional<std::map<std::string, double>>
  finished_summary(const std::string &folder);

  /** A number of the run itself with what each series says; none where a run of the series lacks the number. */
  struct StudyRow
  {
    std::string                               quantity;
    double                                    value;
    std::vector<std::optional<ErrorEstimate>> estimates;

    /** Sum of the bars that there are. */
    double
    error() const;
    bool
    is_complete() const;
  };

  struct StudyTable
  {
    std::vector<std::string> causes; // of the series
    std::vector<StudyRow>    rows;   // in alphabetical order of the quantities

    /** Lines "quantity,cause,value,error,order,order is observed,extrapolated", the cause `all` with the sum first. */
    std::string
    as_csv() const;
    /** For the eye. */
    std::string
    as_text() const;
  };

  /** Of each run of a plan; nothing where it has failed. */
  using Summaries = std::vector<std::optional<std::map<std::string, double>>>;

  /**
   * Rows for all numbers of the run's summary; where it relaxes, the limits (D_limit, ...) are what a stop moves least. Then for whole curves, D_curve and so on, the value being the largest magnitude.
   * @param summaries the first one is there. @param parameters of the run itself.
   * @param curves for each series how its first two runs differ, empty where one has failed, or none at all: the least that bars can be where no order was observed, theory.md, (52c').
   */
  StudyTable
  study_table(const StudyPlan &plan, const Summaries &summaries, const Parameters &parameters, const std::vector<CurveDifferences> &curves = {});
} // namespace tanktread

#endif
