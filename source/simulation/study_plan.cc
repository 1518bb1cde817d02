// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the runs of a study and what is learned from which of them.

#include <tanktread/base/number_text.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/study_plan.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace tanktread
{
  namespace
  {
    constexpr double tolerance_ratio = 10., target_ratio = 4.;

    std::string
    number(const double value)
    {
      return number_text(value, 15);
    }

    double
    power(const double base, const unsigned int n)
    {
      return std::pow(base, int(n));
    }

    /** The run's number, which is appended if it is new. */
    std::size_t
    find_or_add(std::vector<StudyRun> &runs, const std::map<Cause, unsigned int> &coarser)
    {
      const auto found = std::find_if(runs.begin(), runs.end(), [&](const StudyRun &run) { return run.coarser == coarser; });
      if (found != runs.end())
        return found - runs.begin();
      runs.push_back({coarser});
      return runs.size() - 1;
    }

    StudySeries
    make_series(const std::vector<Cause> &causes, const unsigned int levels, const std::map<Cause, unsigned int> &finest, std::vector<StudyRun> &runs)
    {
      StudySeries result{causes, {find_or_add(runs, finest)}, false};
      for (unsigned int k = 1; k < levels; ++k)
        {
          std::map<Cause, unsigned int> coarser = finest;
          for (const Cause cause : causes)
            coarser[cause] = k;
          result.runs.push_back(find_or_add(runs, coarser));
        }
      return result;
    }

    bool
    is_of_control_mesh(const Choice &choice)
    {
      return choice.section == "Shell mesh" && choice.name == "Level";
    }

    std::string
    box_sides(const std::vector<double> &sides, const double divisor)
    {
      std::string result;
      for (const double side : sides)
        result += (result.empty() ? "" : ", ") + number(side / divisor);
      return result;
    }
  } // namespace


  std::string
  StudyRun::name() const
  {
    std::string result;
    for (const auto &[cause, n] : coarser)
      result += (result.empty() ? "" : "_") + word(cause) + "-" + std::to_string(n);
    std::replace(result.begin(), result.end(), ' ', '-');
    return result;
  }


  std::string
  StudySeries::name() const
  {
    std::string result;
    for (const Cause cause : causes)
      result += (result.empty() ? "" : ", ") + word(cause);
    return result;
  }


  double
  StudySeries::ratio() const
  {
    if (causes.size() > 1)
      return 2.;
    return causes[0] == Cause::tolerances ? tolerance_ratio : causes[0] == Cause::target ? target_ratio : 2.;
  }


  double
  StudySeries::expected_order(const Parameters &parameters) const
  {
    const bool is_enriched = parameters.solver.interface == Interface::enriched;
    double     lowest      = 6.;
    for (const Cause cause : causes)
      switch (cause)
        {
          case Cause::mesh:
          case Cause::cells:
            lowest = std::min(lowest, is_enriched ? 2. : 1.);
            break;
          case Cause::control_mesh:
            lowest = std::min(lowest, 2.);
            break;
          case Cause::step:
            lowest = std::min<double>(lowest, parameters.solver.coupling == TimeCoupling::implicit_newton ? order(parameters.time.scheme) : 1);
            break;
          case Cause::box: // (a/l)^3 between faces; in unbounded liquid what is left of the far field falls faster, as seen
            lowest = std::min(lowest, parameters.scene.boundary == Boundary::unbounded ? 5. : 3.);
            break;
          case Cause::tolerances:
          case Cause::target:
            lowest = std::min(lowest, 1.);
            break;
          case Cause::stop: // the run tells
            break;
        }
    return lowest;
  }


  StudyPlan
  study_plan(const StudyParameters &study, const bool larger_box)
  {
    std::vector<Cause> causes   = study.causes();
    const auto         stop     = std::remove(causes.begin(), causes.end(), Cause::stop);
    const bool         has_stop = stop != causes.end();
    causes.erase(stop, causes.end());
    StudyPlan plan;
    plan.runs.push_back({});
    const std::map<Cause, unsigned int> run, coarser_mesh = {{Cause::mesh, 1}};
    if (has_stop)
      plan.series.push_back({{Cause::stop}, {0}, false});
    if (causes.empty())
      return plan;
    if (study.together)
      plan.series.push_back(make_series(causes, study.levels, run, plan.runs));
    else
      for (const Cause cause : causes)
        {
          const bool has_mesh = std::find(causes.begin(), causes.end(), Cause::mesh) != causes.end();
          plan.series.push_back(make_series({cause}, study.levels, study.frugal && has_mesh && cause != Cause::mesh ? coarser_mesh : run, plan.runs));
          plan.series.back().is_finer = larger_box && cause == Cause::box;
        }
    return plan;
  }


  std::vector<std::string>
  changes(const Parameters &parameters, const StudyRun &run)
  {
    std::vector<std::string> result = {"Study/Vary="};
    if (!run.coarser.empty())
      {
        result.push_back("Output/Directory=" + parameters.output.directory + "/study/" + run.name());
        result.push_back("Output/Field interval=0");
      }
    for (const KindParameters &kind : parameters.kinds)
      if (kind.has_random_places) // another box would give others
        {
          const auto [centres, rotations] = as_lists(kind.placement.places());
          result.insert(result.end(), {kind.section + "/Placement=list", kind.section + "/Centres=" + centres, kind.section + "/Rotations=" + rotations});
        }
    for (const auto &[cause, n] : run.coarser)
      {
        if (cause == Cause::mesh || cause == Cause::cells)
          {
            result.push_back("Fluid mesh/Finest cell=" + number(parameters.fluid_mesh.finest_cell * power(2., n)));
            if (parameters.fluid_mesh.finest_in_gaps > 0.)
              result.push_back("Fluid mesh/Finest cell in gaps=" + number(parameters.fluid_mesh.finest_in_gaps * power(2., n)));
          }
        if (cause == Cause::mesh || cause == Cause::control_mesh)
          result.push_back("Shell mesh/Level=" + std::to_string(parameters.shell_mesh.level - n));
        if (cause == Cause::step)
          result.push_back(parameters.time.tolerance > 0.
                             ? "Time/Tolerance=" + number(parameters.time.tolerance * power(2., (order(parameters.time.scheme) + 1) * n))
                             : "Time/Step=" + number(parameters.time.step * power(2., n)));
        if (cause == Cause::box)
          result.push_back("Scene/Box side=" + box_sides(parameters.scene.box_side, power(parameters.scene.boundary == Boundary::unbounded ? 0.5 : 2., n)));
        if (cause == Cause::tolerances)
          result.push_back("Solver/Newton tolerance=" + number(parameters.solver.newton_tolerance * power(tolerance_ratio, n)));
        if (cause == Cause::target)
          {
            result.push_back("Accuracy/Target error=" + number(parameters.accuracy.target_error * power(target_ratio, n)));
            // A level of the control mesh changes its error twentyfold, which would hide, or cancel, what all else changes fourfold.
            if (std::any_of(parameters.choices.begin(), parameters.choices.end(), is_of_control_mesh))
              result.push_back("Shell mesh/Level=" + std::to_string(parameters.shell_mesh.level));
          }
      }
    return result;
  }
} // namespace tanktread
