// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: when a run has to say that its meshes or steps do not resolve what it computes.

#ifndef tanktread_simulation_resolution_warnings_h
#define tanktread_simulation_resolution_warnings_h

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /** What a run can warn of: one figure each. */
  enum class Concern
  {
    triangle,      // worst_triangle() of the control mesh
    curvature,     // smallest radius of curvature, in a
    wrinkles,      // ShapeQuality::detail_ratio
    without_jumps, // InterfaceQuality::without_jumps
    folds,         // InterfaceQuality::folded
    gap,           // between capsules, in a
    wall,          // gap between a capsule and a face with prescribed velocity, in a
    energy,        // what the steps have left over in the balance; see EnergyMemory
    steps,         // what their local errors add up to, in a; see StepErrorMemory
    rise,          // of the energy in a step, in a liquid at rest; see RestEnergy
    self_gap,      // between two sheets of one capsule, in a; see smallest_self_gap()
    shared_cells   // gap between capsules over the finest cell, where two of them are in the same cells
  };

  constexpr unsigned int n_concerns = 12;

  /** One number for each Concern: of a step the worst of all capsules, not a number where it is not known. */
  using ConcernFigures = std::array<double, n_concerns>;

  /** What thresholds and advice depend on. */
  struct ResolutionContext
  {
    double       finest_cell      = 0.;    // h, in a
    double       initial_triangle = 1.;    // worst_triangle() of the initial shape: flat ones begin with long triangles
    unsigned int control_points   = 0;     // of a capsule
    bool         bends            = true;  // whether the shell resists bending
    bool         moments_alone    = false; // Capsule/Bending form = moment-only, control points that move with the material
    bool         is_explicit      = false; // Solver/Coupling
    unsigned int order            = 3;     // of Time/Scheme
    double       step             = 0.;    // Time/Step
    bool         steps_are_fixed  = true;  // Time/Tolerance = 0
    bool         at_rest          = false; // the undisturbed liquid
    bool         two_viscosities  = false; // another one inside
  };

  /** The worst value of a figure in a run so far, and since when it has been beyond its threshold. */
  struct ConcernMemory
  {
    double worst = std::numeric_limits<double>::quiet_NaN(), time_of_worst = worst, since = worst;
  };

  /**
   * What the steps leave over, |r_E| summed over capsules and steps, over the energy that has passed: what the liquid has dissipated and what the shells have given to it or taken, by the trapezoidal rule. (In steady
   * motion the shells' work vanishes, at the start from rest the dissipation: it grows with the third power of time, their energy with the second.) What the first four steps leave over is not counted: from rest they
   * pass a transient that need not be resolved, and the integral of (33b) has fewer than four levels. It is taken off what passes in them instead, so that a shape that has come to rest is not measured by nothing.
   */
  struct EnergyMemory
  {
    double       left_over = 0., passed = 0., last_power = 0.;
    unsigned int n_steps = 0;

    /** @param left_over sum of |r_E| over the capsules. @param power dissipation and sum of |P| at the end of the step. A length of zero: the start. */
    void
    add_step(double length, double left_over, double power);

    /** left_over / passed; not a number before ten steps have been counted, and for shells whose forces have no energy. */
    double
    defect() const;
  };

  /** Local errors of the steps of about the last unit of time, sum of e_n exp(-(t - t_n)): what is older has faded as the shape relaxes. Steps whose error is not known add nothing. */
  struct StepErrorMemory
  {
    double sum = std::numeric_limits<double>::quiet_NaN(); // in a; not a number before one is known

    /** @param error local error in a, or not a number. */
    void
    add_step(double length, double error);
  };

  /** Part of what a checkpoint has to write. */
  struct WarningMemory
  {
    std::array<ConcernMemory, n_concerns> concerns;
    EnergyMemory                          energy;
    StepErrorMemory                       steps;
  };

  /** The value beyond which there is a warning; below it for triangle, curvature and gaps, above it for the others. */
  double
  warning_threshold(Concern concern, const ResolutionContext &context);

  /** What happened, the figure, since when, and what to change. @param name of the capsules that it is about may be empty. */
  std::string
  warning_text(Concern concern, double value, double time, const ResolutionContext &context);

  /** Takes the figures of a step into account. Returns the warnings that have not been given before, each once. */
  std::vector<std::string>
  update_warnings(WarningMemory &memory, double time, const ConcernFigures &figures, const ResolutionContext &context);

  /** "worst_triangle" and so on with the worst values of the run, for summary.csv. */
  std::vector<std::pair<std::string, double>>
  worst_figures(const WarningMemory &memory);

  /** One line for each warning that has been given: the worst value and its time; empty without warnings. */
  std::string
  warnings_in_short(const WarningMemory &memory, const ResolutionContext &context);

  /** What is said at the start of a run whose control mesh has too few points to be judged by a coarser one; empty if it has not. */
  std::string
  warning_of_few_points(const ResolutionContext &context);

  /** What is said at the end of a run with fixed steps if the local error of none of them is known; empty if one is, or without steps. */
  std::string
  warning_of_unknown_steps(const WarningMemory &memory, const ResolutionContext &context);

  /** For the sentence that a failed run ends with: which warnings came before it, as the likely cause; empty without warnings. */
  std::string
  warnings_before_failure(const WarningMemory &memory);
} // namespace tanktread

#endif
