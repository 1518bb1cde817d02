// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the command line of step_cost.

#ifndef tanktread_benchmarks_step_cost_options_h
#define tanktread_benchmarks_step_cost_options_h

#include <tanktread/base/exceptions.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace tanktread
{
  /** What step_cost is to measure. */
  struct StepCostOptions
  {
    std::vector<unsigned int> cells = {32, 64, 128};
    double                    dt    = 0.1;
    bool                      ml    = false;
    bool                      steps = false; // and nothing else, with the enriched interface
    double                    ratio = 1.;    // of the viscosities, for these
  };


  /** Numbers of at least 8 between commas; none if the text is something else. */
  inline std::vector<unsigned int>
  read_cells(const std::string &text)
  {
    std::vector<unsigned int> result;
    std::istringstream        stream(text);
    for (unsigned int number; stream >> number && number >= 8; stream.get())
      {
        result.push_back(number);
        if (stream.peek() != ',')
          return stream.eof() ? result : std::vector<unsigned int>();
      }
    return {};
  }


  /** Throws InputError, which says what is allowed. */
  inline StepCostOptions
  parse(const std::vector<std::string> &words)
  {
    StepCostOptions options;
    for (std::size_t i = 0; i < words.size(); ++i)
      {
        if (words[i] == "--ml" || words[i] == "--steps")
          {
            (words[i] == "--ml" ? options.ml : options.steps) = true;
            continue;
          }
        const std::string name = words[i], value = ++i < words.size() ? words[i] : "";
        if (name == "--cells")
          options.cells = read_cells(value);
        else if (name == "--dt")
          options.dt = std::atof(value.c_str());
        else if (name == "--viscosity-ratio")
          options.ratio = std::atof(value.c_str());
        else
          options.cells.clear();
        if (options.cells.empty() || !(options.dt > 0.) || !(options.ratio > 0.))
          throw InputError("step_cost: got '" + name + " " + value +
                           "'; allowed: --cells 32,64,128 (at least 8 each), --dt 0.1, --ml, --steps and --viscosity-ratio 1");
      }
    return options;
  }
} // namespace tanktread

#endif
