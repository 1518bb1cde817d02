// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the curves of a run and its companion say about the bars of single numbers.

#include <tanktread/simulation/curve_bars.h>

#include <filesystem>
#include <tuple>

namespace tanktread
{
  namespace
  {
    // Chosen on half of the scenes that have a reference solution and tried on the others: accuracy.md, "The dial".
    constexpr double safety_of_curves = 1.5, safety_of_rest = 2.;

    /** "D_2" without and with "_2", or "D" and "". */
    std::pair<std::string, std::string>
    without_capsule(const std::string &name)
    {
      const std::size_t i         = name.find_last_not_of("0123456789");
      const bool        is_number = i != std::string::npos && i + 1 < name.size() && name[i] == '_';
      return {is_number ? name.substr(0, i) : name, is_number ? name.substr(i) : ""};
    }

    /** "D_minimum_2": curve D, kind minimum, capsule _2. */
    struct Name
    {
      explicit Name(const std::string &quantity)
      {
        std::string name;
        std::tie(name, capsule) = without_capsule(quantity);
        const std::size_t end   = name.rfind('_');
        if (end != std::string::npos)
          {
            curve = name.substr(0, end);
            kind  = name.substr(end + 1);
          }
      }

      std::string curve, kind, capsule;
    };

    const CurveDifference *
    find(const CurveDifferences &curves, const std::string &name)
    {
      const auto found = curves.find(name);
      return found == curves.end() ? nullptr : &found->second;
    }
  } // namespace


  CurveDifferences
  curve_differences_of(const std::string &folder, const std::string &companion_folder)
  {
    const std::string stem     = "/history";
    const auto        compared = [&](const std::string &end) {
      return curve_differences(history_curves(folder + stem + end), history_curves(companion_folder + stem + end));
    };
    if (std::filesystem::exists(folder + stem + ".csv"))
      return compared(".csv");
    CurveDifferences result;
    for (unsigned int c = 1; std::filesystem::exists(folder + stem + "_" + std::to_string(c) + ".csv"); ++c)
      for (const auto &[name, curve] : compared("_" + std::to_string(c) + ".csv"))
        result[name + "_" + std::to_string(c)] = curve;
    return result;
  }


  std::string
  quantity_of_curve(const std::string &name)
  {
    const auto [curve, capsule] = without_capsule(name);
    return curve + "_curve" + capsule;
  }


  double
  difference_of_curve(const CurveDifference &curve)
  {
    return safety_of_curves * curve.largest;
  }


  std::optional<double>
  least_difference(const std::string &quantity, const std::map<std::string, double> &summary, const CurveDifferences &curves)
  {
    const Name name(quantity);
    if (name.kind == "period" || name.kind == "frequency")
      {
        const CurveDifference *const D      = find(curves, "D" + name.capsule);
        const auto                   period = summary.find("D_period" + name.capsule);
        if (!D || period == summary.end())
          return std::nullopt;
        return safety_of_rest * D->time / period->second * summary.at(quantity);
      }
    const CurveDifference *const curve = find(curves, name.curve + name.capsule);
    if (!curve)
      return std::nullopt;
    if (name.kind == "last")
      return difference_of_curve(*curve);
    if (name.kind == "mean")
      return curve->rest;
    if (name.kind == "minimum" || name.kind == "maximum" || name.kind == "limit")
      return safety_of_rest * curve->rest;
    return std::nullopt;
  }


  std::optional<double>
  difference_of_limit(const std::string &quantity, const CurveDifferences &curves)
  {
    const Name                   name(quantity);
    const CurveDifference *const curve = name.kind == "limit" ? find(curves, name.curve + name.capsule) : nullptr;
    return curve ? std::optional<double>(curve->at_end) : std::nullopt;
  }
} // namespace tanktread
