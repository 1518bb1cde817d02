// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: when a run has to say that its meshes or steps do not resolve what it computes.

#include <tanktread/base/number_text.h>
#include <tanktread/simulation/resolution_warnings.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tanktread
{
  namespace
  {
    // Thresholds lie between the worst values of runs that are right and of runs that are not; doc/limits.md has both.

    constexpr double least_triangle                 = 0.4;  // right: 0.60 and more; a mesh that degenerates: 0.002 to 0.37
    constexpr double least_part_of_initial_triangle = 0.5;  // right: 0.8 and more, wrong: 0.54 and less, soon much less
    constexpr double least_radius                   = 0.75; // in finest cells. Right: 0.95 and more; not resolved: 0.05 to 0.60
    constexpr double largest_detail                 = 0.7;  // right: 0.08 to 0.55, noise of the control points from 0.74 on; membranes that wrinkle: 1.6 to 9
    constexpr double largest_share_without_jumps    = 0.02; // right, and wrong for other reasons: up to 0.006
    constexpr double largest_share_folded           = 0.03; // right: up to 0.010; two sheets in the same cells: 0.03 to 0.67
    constexpr double least_gap                      = 1.; // in finest cells. A pair that passes at 1.1 cells has its gap wrong by 2.9 %, at 2.1 cells by 0.8 %
    constexpr double largest_energy_defect          = 0.018; // D right to 1 %: up to 0.016; wrong by more: 0.019 and more, unstable explicit steps: 0.5
    constexpr double largest_step_error             = 0.09;  // in a. D right to 6 %: up to 0.066; wrong by 8 to 12 %: 0.115 to 0.38
    constexpr double largest_step_error_at_rest     = 0.02;  // right to 4 %: up to 0.015; wrong by 7 to 18 %: 0.026 to 0.031
    constexpr double largest_energy_rise            = 1e-6;  // one-step schemes: up to 6e-9; BDF3 that overshoots: 3e-5 and more
    constexpr double least_self_gap                 = 0.75;  // in finest cells. A disk that is right: 0.92; one that shares cells: 0.62

    // In finest cells, velocities of the film: with one viscosity wrong by 2.6 % at 0.1, less not measured; with lambda = 5 by 3.8 % at 0.5, 5.3 % at 0.32, 7 % at 0.1.
    constexpr double least_shared_gap = 0.1, least_shared_gap_of_two_viscosities = 0.35;

    constexpr unsigned int n_steps_of_start = 4, least_n_steps = 10;

    struct Entry
    {
      Concern     concern;
      const char *name; // in summary.csv
      bool        low_is_bad;
    };

    constexpr std::array<Entry, n_concerns> entries = {{{Concern::triangle, "worst_triangle", true},
                                                        {Concern::curvature, "worst_radius_of_curvature", true},
                                                        {Concern::wrinkles, "worst_detail_ratio", false},
                                                        {Concern::without_jumps, "worst_area_without_jumps", false},
                                                        {Concern::folds, "worst_area_folded", false},
                                                        {Concern::gap, "worst_gap", true},
                                                        {Concern::wall, "worst_wall_gap", true},
                                                        {Concern::energy, "worst_energy_defect", false},
                                                        {Concern::steps, "worst_step_error", false},
                                                        {Concern::rise, "worst_energy_rise", false},
                                                        {Concern::self_gap, "worst_self_gap", true},
                                                        {Concern::shared_cells, "worst_gap_of_shared_cells", true}}};

    bool
    is_worse(const Entry &entry, const double value, const double than)
    {
      return entry.low_is_bad ? value < than : value > than; // false if one is not a number
    }

    std::string
    number(const double value)
    {
      return number_text(value, 3);
    }

    std::string
    percent(const double value)
    {
      return number(100. * value) + " %";
    }

    std::string
    cells(const ResolutionContext &context)
    {
      return number(context.finest_cell) + " a";
    }

    std::string
    finer_cells(const double value)
    {
      return "Take Fluid mesh/Finest cell = " + number(value) + " or less, or a smaller Accuracy/Target error";
    }

    std::string
    triangle_text(const double q, const ResolutionContext &context)
    {
      return "the worst triangle of a shell's control mesh has the quality " + number(q) + " (equal sides: 1, at first " + number(context.initial_triangle) +
        "), below " + number(warning_threshold(Concern::triangle, context)) + ": the mesh degenerates, and what is computed on it is not to be trusted. " +
        (context.moments_alone
           ? "The moments alone leave it free to slide: take Capsule/Bending form = variational or a membrane; without one, Shell mesh/Even control mesh = automatic"
           : "Take a shell that resists more (bending, area dilatation), shorter steps or an earlier Scene/End time") +
        "; a finer control mesh (Shell mesh/Level) only postpones it.";
    }

    std::string
    curvature_text(const double radius, const ResolutionContext &context)
    {
      return "the shell's smallest radius of curvature is " + number(radius) + " a, less than " + number(least_radius) + " finest cells of the fluid (" +
        cells(context) + "): the flow about that fold is not resolved. " + finer_cells(radius / least_radius) +
        (context.bends ? "." : "; a shell without bending stiffness can fold without limit: a small Scene/Reduced bending modulus (0.005) gives folds a size.");
    }

    std::string
    wrinkles_text(const double ratio, const ResolutionContext &context)
    {
      return "the detail that the shell has on its control mesh of " + std::to_string(context.control_points) + " points is " + number(ratio) +
        " times that on the next coarser one, above " + number(largest_detail) + " (a shape that is resolved: 0.1 to 0.4): it " +
        (context.bends
           ? "is not resolved, or wriggles from point to point. Take " +
             std::string(context.is_explicit ? "Solver/Coupling = implicit or a shorter Time/Step." : "a finer control mesh (Shell mesh/Level).")
           : "wrinkles from point to point, and on a finer one it will wrinkle more. Take a small Scene/Reduced bending modulus (0.005), or a control mesh that cannot "
             "follow wrinkles (Shell mesh/Level = 2).");
    }

    std::string
    without_jumps_text(const double share, const ResolutionContext &context)
    {
      return percent(share) + " of a shell's area, more than " + percent(largest_share_without_jumps) +
        ", lie in cells of the fluid without kink and jump: it is thinner than half a cell there, or has left the finest cells. " +
        (context.is_explicit ? "Take a shorter Time/Step or a larger Fluid mesh/Band width, or " : "Take ") + "a smaller Fluid mesh/Finest cell than " +
        number(context.finest_cell) + ".";
    }

    std::string
    folds_text(const double share, const ResolutionContext &context)
    {
      return percent(share) + " of a shell's area, more than " + percent(largest_share_folded) + ", lie in cells of the fluid (" + cells(context) +
        ") in which the shell turns back or has an edge: the enriched interface knows one sheet a cell. " + finer_cells(0.5 * context.finest_cell) + ".";
    }

    std::string
    gap_text(const char *what, const double gap, const ResolutionContext &context)
    {
      return std::string(what) + " are " + number(gap) + " a apart, less than a finest cell of the fluid (" + cells(context) +
        "): the film of liquid between them is not resolved, its pressure is too small and they come too near. " + finer_cells(0.5 * gap) +
        ", or give that as Fluid mesh/Finest cell in gaps.";
    }

    std::string
    self_gap_text(const double gap, const ResolutionContext &context)
    {
      return "two sheets of a shell are " + number(gap) + " a apart, less than " + number(least_self_gap) + " finest cells of the fluid (" + cells(context) +
        "): the film of liquid between them is not resolved. " + finer_cells(gap / least_self_gap) + ".";
    }

    std::string
    shared_cells_text(const double gap, const ResolutionContext &context)
    {
      return "two shells are in the same cells of the fluid (" + cells(context) + "), " + number(gap) + " of a cell apart, less than " +
        number(warning_threshold(Concern::shared_cells, context)) + ": velocities of the film between them may be wrong by " +
        (context.two_viscosities ? "5 % with another viscosity inside" : "3 %") + ". " + finer_cells(gap * context.finest_cell) +
        ", or give that as Fluid mesh/Finest cell in gaps.";
    }

    std::string
    energy_text(const double defect, const ResolutionContext &context)
    {
      return "the steps have left over " + percent(defect) + " of the energy that has passed in its balance, more than " + percent(largest_energy_defect) +
        ". Take " +
        (context.is_explicit ? "Solver/Coupling = implicit, or a shorter Time/Step."
                             : "a smaller Time/Tolerance or Time/Step, Time/Scheme = BDF3, or for a stiff shell a smaller Solver/Newton tolerance.");
    }

    /** Other steps than those of Time/Step, or none if the file has left them to a tolerance. */
    std::string
    shorter_steps(const double times, const ResolutionContext &context)
    {
      if (!context.steps_are_fixed)
        return "a smaller Time/Tolerance";
      return "Time/Tolerance > 0, Time/Step = " + number(times * context.step) + " or less";
    }

    std::string
    steps_text(const double error, const ResolutionContext &context)
    {
      return "the local errors of the steps of the last unit of time add up to " + number(error) + " a (root mean square over the control points), more than " +
        number(warning_threshold(Concern::steps, context)) + " a: the steps are too long for what the shells do. Take " +
        shorter_steps(std::pow(warning_threshold(Concern::steps, context) / error, 1. / context.order), context) +
        (context.order == 1 ? ", or Time/Scheme = BDF2, of second order." : ".");
    }

    std::string
    rise_text(const double rise, const ResolutionContext &context)
    {
      return "the energy of the shells has risen in a step by " + number(rise) + " of what it was at the start, more than " + number(largest_energy_rise) +
        ", though in a liquid at rest it can only fall: the step is too long for so stiff a shell. Take " + shorter_steps(0.5, context) +
        (context.order > 1 ? ", or Time/Scheme = backward Euler." : ", or a smaller Solver/Newton tolerance.");
    }

    std::string
    text_without_time(const Concern concern, const double value, const ResolutionContext &context)
    {
      switch (concern)
        {
          case Concern::triangle:
            return triangle_text(value, context);
          case Concern::curvature:
            return curvature_text(value, context);
          case Concern::wrinkles:
            return wrinkles_text(value, context);
          case Concern::without_jumps:
            return without_jumps_text(value, context);
          case Concern::folds:
            return folds_text(value, context);
          case Concern::gap:
            return gap_text("two shells", value, context);
          case Concern::wall:
            return gap_text("a shell and a wall", value, context);
          case Concern::self_gap:
            return self_gap_text(value, context);
          case Concern::shared_cells:
            return shared_cells_text(value, context);
          case Concern::steps:
            return steps_text(value, context);
          case Concern::rise:
            return rise_text(value, context);
          default:
            return energy_text(value, context);
        }
    }
  } // namespace


  void
  EnergyMemory::add_step(const double length, const double of_step, const double power)
  {
    const double of_time = 0.5 * length * (last_power + power);
    n_steps += length > 0.;
    if (n_steps > n_steps_of_start)
      {
        left_over += of_step;
        passed += of_time;
      }
    else
      passed += std::max(0., of_time - of_step);
    last_power = power;
  }


  double
  EnergyMemory::defect() const
  {
    return n_steps < n_steps_of_start + least_n_steps || !(passed > 0.) ? std::numeric_limits<double>::quiet_NaN() : left_over / passed;
  }


  void
  StepErrorMemory::add_step(const double length, const double error)
  {
    sum *= std::exp(-length);
    if (!std::isnan(error))
      sum = std::isnan(sum) ? error : sum + error;
  }


  double
  warning_threshold(const Concern concern, const ResolutionContext &context)
  {
    switch (concern)
      {
        case Concern::triangle:
          return std::min(least_triangle, least_part_of_initial_triangle * context.initial_triangle);
        case Concern::curvature:
          return least_radius * context.finest_cell;
        case Concern::wrinkles:
          return largest_detail;
        case Concern::without_jumps:
          return largest_share_without_jumps;
        case Concern::folds:
          return largest_share_folded;
        case Concern::gap:
        case Concern::wall:
          return least_gap * context.finest_cell;
        case Concern::self_gap:
          return least_self_gap * context.finest_cell;
        case Concern::shared_cells:
          return context.two_viscosities ? least_shared_gap_of_two_viscosities : least_shared_gap;
        case Concern::steps:
          return context.at_rest ? largest_step_error_at_rest : largest_step_error;
        case Concern::rise:
          return largest_energy_rise;
        default:
          return largest_energy_defect;
      }
  }


  std::string
  warning_text(const Concern concern, const double value, const double time, const ResolutionContext &context)
  {
    return "WARNING: from time " + number(time) + " on " + text_without_time(concern, value, context);
  }


  std::vector<std::string>
  update_warnings(WarningMemory &memory, const double time, const ConcernFigures &figures, const ResolutionContext &context)
  {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < n_concerns; ++i)
      {
        const Entry   &entry = entries[i];
        ConcernMemory &past  = memory.concerns[i];
        const double   value = figures[static_cast<std::size_t>(entry.concern)];
        if (is_worse(entry, value, past.worst) || (std::isnan(past.worst) && !std::isnan(value)))
          {
            past.worst         = value;
            past.time_of_worst = time;
          }
        if (std::isnan(past.since) && is_worse(entry, value, warning_threshold(entry.concern, context)))
          {
            past.since = time;
            result.push_back(warning_text(entry.concern, value, time, context));
          }
      }
    return result;
  }


  std::vector<std::pair<std::string, double>>
  worst_figures(const WarningMemory &memory)
  {
    std::vector<std::pair<std::string, double>> result;
    for (std::size_t i = 0; i < n_concerns; ++i)
      result.emplace_back(entries[i].name, memory.concerns[i].worst);
    return result;
  }


  std::string
  warnings_in_short(const WarningMemory &memory, const ResolutionContext &context)
  {
    std::string result;
    for (std::size_t i = 0; i < n_concerns; ++i)
      if (const ConcernMemory &past = memory.concerns[i]; !std::isnan(past.since))
        result += std::string(result.empty() ? "" : "\n") + "WARNED from time " + number(past.since) + " on: " + entries[i].name + " came to " +
          number(past.worst) + " at time " + number(past.time_of_worst) + " (threshold " + number(warning_threshold(entries[i].concern, context)) + ").";
    return result;
  }


  std::string
  warning_of_few_points(const ResolutionContext &context)
  {
    constexpr unsigned int enough = 100; // 162: meshes of 42 and 12 points are coarser ones of it
    if (context.control_points >= enough)
      return "";
    return "WARNING: a control mesh of " + std::to_string(context.control_points) +
      " points has no coarser ones to be judged by: wrinkles, and shapes that it cannot follow, are not noticed. Take Shell mesh/Level = 2 or more.";
  }


  std::string
  warning_of_unknown_steps(const WarningMemory &memory, const ResolutionContext &context)
  {
    if (!context.steps_are_fixed || context.is_explicit || memory.energy.n_steps == 0 || !std::isnan(memory.steps.sum))
      return "";
    return "WARNING: the local error of none of the " + std::to_string(memory.energy.n_steps) +
      " steps is known, which takes more of them than the order of Time/Scheme. Take Time/Tolerance > 0 or a shorter Time/Step.";
  }


  std::string
  warnings_before_failure(const WarningMemory &memory)
  {
    std::string names;
    for (std::size_t i = 0; i < n_concerns; ++i)
      if (!std::isnan(memory.concerns[i].since))
        names += std::string(names.empty() ? "" : ", ") + entries[i].name;
    return names.empty() ? "" : " A likely cause is what the run had warned of before, " + names + ": the warnings say what to change.";
  }
} // namespace tanktread
