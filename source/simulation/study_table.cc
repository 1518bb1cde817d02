// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: error bars of the numbers of a run, split by cause.

#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/study_table.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace tanktread
{
  namespace
  {
    std::string
    formatted(const char *const format, const double value)
    {
      char text[40];
      std::snprintf(text, sizeof(text), format, value);
      return text;
    }

    /** `summary`'s number of this name. */
    std::optional<double>
    number(const std::map<std::string, double> &summary, const std::string &name)
    {
      const auto found = summary.find(name);
      return found == summary.end() ? std::nullopt : std::optional<double>(found->second);
    }

    /** The name with one of its parts, which it has, replaced. */
    std::string
    with(std::string name, const std::string &part, const std::string &other)
    {
      return name.replace(name.find(part), part.size(), other);
    }

    bool
    contains(const std::string &name, const std::string &part)
    {
      return name.find(part) != std::string::npos;
    }

    /** What the end of the run is worth, from its own history: the bar of a limit, for a last value also the distance from the limit; nothing for other numbers. */
    std::optional<ErrorEstimate>
    estimate_of_the_stop(const std::string &quantity, const std::map<std::string, double> &summary)
    {
      if (!contains(quantity, "_last") && !contains(quantity, "_limit"))
        return std::nullopt;
      const std::string           name  = contains(quantity, "_last") ? with(quantity, "_last", "_limit") : quantity;
      const std::optional<double> limit = number(summary, name), error = number(summary, with(name, "_limit", "_limit_error"));
      if (!limit || !error)
        return std::nullopt;
      return ErrorEstimate{std::nan(""), false, *limit, std::abs(summary.at(quantity) - *limit) + *error};
    }

    /** Of the finer (false: coarser) of two values that are `difference` apart. */
    ErrorEstimate
    estimate_of_difference(const StudySeries &series, const double value, const double difference, const double order)
    {
      return series.is_finer ? error_of_the_coarsest({value - difference, value}, series.ratio(), order)
                             : error_estimate({value, value - difference}, series.ratio(), order);
    }

    /** From the numbers of the summaries alone; for a limit that companions lack from the last values. */
    std::optional<ErrorEstimate>
    estimate_of_numbers(const StudySeries &series, const std::string &quantity, const Summaries &summaries, const CurveDifferences &curves, const double order)
    {
      std::vector<double> values;
      for (const std::size_t run : series.runs)
        {
          if (!summaries[run])
            return std::nullopt;
          if (const std::optional<double> value = number(*summaries[run], quantity))
            values.push_back(*value);
        }
      if (values.size() < series.runs.size())
        {
          const std::optional<double> difference = difference_of_limit(quantity, curves);
          return difference ? std::optional<ErrorEstimate>(estimate_of_difference(series, summaries[0]->at(quantity), *difference, order)) : std::nullopt;
        }
      if (!series.is_finer)
        return error_estimate(values, series.ratio(), order);
      std::reverse(values.begin(), values.end());
      return error_of_the_coarsest(values, series.ratio(), order);
    }

    std::optional<ErrorEstimate>
    estimate(const StudySeries &series, const std::string &quantity, const Summaries &summaries, const CurveDifferences &curves, const double order)
    {
      if (series.causes[0] == Cause::stop)
        return estimate_of_the_stop(quantity, *summaries[0]);
      std::optional<ErrorEstimate> result = estimate_of_numbers(series, quantity, summaries, curves, order);
      if (result && !result->is_observed)
        if (const std::optional<double> least = least_difference(quantity, *summaries[0], curves))
          result->error = std::max(result->error, estimate_of_difference(series, 0., *least, order).error);
      return result;
    }

    /** Bars of whole curves, "D_curve" and so on: what any value of it at a given time may be wrong by. The stop has no part in them. */
    std::vector<StudyRow>
    rows_of_curves(const StudyPlan &plan, const std::vector<CurveDifferences> &curves, const Parameters &parameters)
    {
      std::map<std::string, StudyRow> rows;
      for (std::size_t s = 0; s < curves.size(); ++s)
        for (const auto &[name, curve] : curves[s])
          {
            const std::string quantity = quantity_of_curve(name);
            StudyRow         &row =
              rows.try_emplace(quantity, StudyRow{quantity, curve.size, std::vector<std::optional<ErrorEstimate>>(plan.series.size())}).first->second;
            row.estimates[s]               = estimate_of_difference(plan.series[s], 0., difference_of_curve(curve), plan.series[s].expected_order(parameters));
            row.estimates[s]->extrapolated = std::nan("");
          }
      std::vector<StudyRow> result;
      for (auto &[quantity, row] : rows)
        {
          for (std::size_t s = 0; s < plan.series.size(); ++s)
            if (plan.series[s].causes[0] == Cause::stop)
              row.estimates[s] = ErrorEstimate{std::nan(""), false, std::nan(""), 0.};
          result.push_back(std::move(row));
        }
      return result;
    }
  } // namespace


  std::optional<double>
  end_of_run(const std::string &folder)
  {
    std::ifstream file(folder + "/summary.csv");
    std::string   line;
    while (std::getline(file, line))
      if (line.compare(0, 3, "end") == 0)
        return std::strtod(line.substr(line.find(',') + 1).c_str(), nullptr);
    return std::nullopt;
  }


  std::optional<std::map<std::string, double>>
  finished_summary(const std::string &folder)
  {
    std::ifstream file(folder + "/summary.csv");
    std::string   line, outcome;
    if (!file)
      return std::nullopt;
    std::map<std::string, double> result;
    while (std::getline(file, line))
      {
        const std::size_t comma = line.find(',');
        if (comma == std::string::npos)
          continue;
        const std::string name = line.substr(0, comma), text = line.substr(comma + 1);
        char             *end   = nullptr;
        const double      value = std::strtod(text.c_str(), &end);
        if (name == "outcome")
          outcome = text;
        else if (name.compare(0, 6, "worst_") != 0 && name.compare(0, 4, "from") != 0 && name.compare(0, 3, "end") != 0 && end != text.c_str() &&
                 *end == '\0' && std::isfinite(value))
          result[name] = value;
      }
    if (outcome != "done" && outcome != "steady")
      return std::nullopt;
    return result;
  }


  double
  StudyRow::error() const
  {
    double result = 0.;
    for (const auto &estimate : estimates)
      result += estimate ? estimate->error : 0.;
    return result;
  }


  bool
  StudyRow::is_complete() const
  {
    return std::all_of(estimates.begin(), estimates.end(), [](const auto &estimate) { return estimate.has_value(); });
  }


  std::string
  StudyTable::as_csv() const
  {
    std::ostringstream text;
    text << "quantity,cause,value,error,order,order is observed,extrapolated\n" << std::setprecision(10);
    for (const StudyRow &row : rows)
      {
        text << row.quantity << ",all," << row.value << ',' << (row.is_complete() ? row.error() : std::nan("")) << ",nan,0,nan\n";
        for (std::size_t s = 0; s < causes.size(); ++s)
          {
            const auto       &estimate = row.estimates[s];
            const std::string cause    = causes[s].find(',') == std::string::npos ? causes[s] : '"' + causes[s] + '"';
            text << row.quantity << ',' << cause << ',' << row.value << ',';
            if (estimate)
              text << estimate->error << ',' << estimate->order << ',' << estimate->is_observed << ',' << estimate->extrapolated << '\n';
            else
              text << "nan,nan,0,nan\n";
          }
      }
    return text.str();
  }


  std::string
  StudyTable::as_text() const
  {
    std::ostringstream text;
    text << std::left << std::setw(26) << "quantity" << std::right << std::setw(13) << "value" << std::setw(12) << "error bar";
    for (const std::string &cause : causes)
      text << std::setw(std::max<int>(14, cause.size() + 2)) << cause;
    text << '\n';
    for (const StudyRow &row : rows)
      {
        text << std::left << std::setw(26) << row.quantity << std::right << std::setw(13) << formatted("%.7g", row.value) << std::setw(12)
             << (row.is_complete() ? formatted("%.1e", row.error()) : "-");
        for (std::size_t s = 0; s < causes.size(); ++s)
          {
            const auto &estimate = row.estimates[s];
            std::string entry    = "-";
            if (estimate)
              entry = formatted("%.1e", estimate->error) + (estimate->is_observed ? formatted(" (%.1f)", estimate->order) : "");
            text << std::setw(std::max<int>(14, causes[s].size() + 2)) << entry;
          }
        text << '\n';
      }
    return text.str();
  }


  StudyTable
  study_table(const StudyPlan &plan, const Summaries &summaries, const Parameters &parameters, const std::vector<CurveDifferences> &curves)
  {
    StudyTable table;
    for (const StudySeries &series : plan.series)
      table.causes.push_back(series.name());
    for (const auto &[quantity, value] : *summaries[0])
      {
        if (contains(quantity, "_limit_error"))
          continue;
        StudyRow row{quantity, value, {}};
        for (std::size_t s = 0; s < plan.series.size(); ++s)
          row.estimates.push_back(
            estimate(plan.series[s], quantity, summaries, s < curves.size() ? curves[s] : CurveDifferences(), plan.series[s].expected_order(parameters)));
        table.rows.push_back(std::move(row));
      }
    for (StudyRow &row : rows_of_curves(plan, curves, parameters))
      table.rows.push_back(std::move(row));
    std::sort(table.rows.begin(), table.rows.end(), [](const StudyRow &a, const StudyRow &b) { return a.quantity < b.quantity; });
    return table;
  }
} // namespace tanktread
