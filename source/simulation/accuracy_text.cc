// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the log says about the parameters chosen for a wanted error.

#include <tanktread/base/number_text.h>
#include <tanktread/simulation/accuracy.h>
#include <tanktread/simulation/parameters.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace tanktread
{
  namespace
  {
    constexpr double far_beyond_target = 10.; // what a file sets is warned of from there on

    /** Whether the parameter that decides on a cause of errors has not been chosen for the target. */
    bool
    is_set_by_the_file(const std::vector<Choice> &choices, const std::string &cause)
    {
      const std::string name = cause == "cells" ? "Finest cell" : cause == "control mesh" ? "Level" : cause == "steps" ? "Tolerance" : "";
      return !name.empty() && std::none_of(choices.begin(), choices.end(), [&](const Choice &choice) { return choice.name == name; });
    }
  } // namespace


  std::string
  accuracy_text(const Parameters &parameters)
  {
    std::ostringstream text;
    text << std::setprecision(2) << "Chosen for Accuracy/Target error = " << parameters.accuracy.target_error << ":\n";
    for (const Choice &choice : parameters.choices)
      text << "  " << choice.section << '/' << choice.name << " = " << choice.value << '\n';
    if (parameters.choices.empty())
      text << "  nothing, all is set\n";
    text << "Expected errors of D, relative to its largest value, about " << expected_deformation(parameters) << ":\n";
    double      sum = 0.;
    std::string warnings;
    for (const ErrorShare &share : expected_errors(parameters))
      {
        sum += share.error;
        if (share.error > far_beyond_target * parameters.accuracy.target_error && is_set_by_the_file(parameters.choices, share.cause))
          warnings += "WARNING: what the file sets is too coarse for Accuracy/Target error: " + share.cause + ", expected to add " + number_text(share.error) +
            " to the error of D. Leave it to the target.\n";
        text << "  " << std::left << std::setw(32) << share.cause << std::setw(9) << share.error << "half of it: " << share.cost_of_half << " times the time\n";
      }
    if (parameters.time.tolerance == 0.)
      text << "  " << std::setw(32) << "steps"
           << "not known: Time/Tolerance is 0\n";
    text << "  " << std::setw(32) << "sum, if none cancels another" << sum << '\n' << warnings;
    return text.str();
  }
} // namespace tanktread
