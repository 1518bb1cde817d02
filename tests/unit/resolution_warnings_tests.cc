// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of what a run warns of.

#include <gtest/gtest.h>
#include <tanktread/simulation/resolution_warnings.h>

#include <cmath>
#include <limits>

using namespace tanktread;

namespace
{
  const double unknown = std::numeric_limits<double>::quiet_NaN();

  const ResolutionContext context = {0.2, 1., 162, false, false, false};

  constexpr std::array<Concern, n_concerns> all_concerns = {{Concern::triangle,
                                                             Concern::curvature,
                                                             Concern::wrinkles,
                                                             Concern::without_jumps,
                                                             Concern::folds,
                                                             Concern::gap,
                                                             Concern::wall,
                                                             Concern::energy,
                                                             Concern::steps,
                                                             Concern::rise,
                                                             Concern::self_gap,
                                                             Concern::shared_cells}};

  ConcernFigures
  only(const Concern concern, const double value)
  {
    ConcernFigures result;
    result.fill(unknown);
    result[static_cast<std::size_t>(concern)] = value;
    return result;
  }

  bool
  low_is_bad(const Concern concern)
  {
    return concern == Concern::triangle || concern == Concern::curvature || concern == Concern::gap || concern == Concern::wall ||
      concern == Concern::self_gap || concern == Concern::shared_cells;
  }

  /** A value that is so many times as bad as the threshold. */
  double
  times_as_bad(const Concern concern, const double factor)
  {
    const double threshold = warning_threshold(concern, context);
    return low_is_bad(concern) ? threshold / factor : threshold * factor;
  }

  bool
  has(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace


TEST(ResolutionWarnings, OncePerConcernAndNotBelowTheThreshold)
{
  for (const Concern concern : all_concerns)
    {
      WarningMemory memory;
      EXPECT_TRUE(update_warnings(memory, 1., only(concern, times_as_bad(concern, 0.99)), context).empty());
      EXPECT_TRUE(warnings_in_short(memory, context).empty());
      EXPECT_TRUE(warnings_before_failure(memory).empty());
      const auto said = update_warnings(memory, 2.5, only(concern, times_as_bad(concern, 1.01)), context);
      ASSERT_EQ(said.size(), 1u);
      EXPECT_EQ(said[0], warning_text(concern, times_as_bad(concern, 1.01), 2.5, context));
      EXPECT_TRUE(update_warnings(memory, 3., only(concern, times_as_bad(concern, 2.)), context).empty());
      EXPECT_TRUE(update_warnings(memory, 4., only(concern, times_as_bad(concern, 0.5)), context).empty());
      EXPECT_TRUE(update_warnings(memory, 5., only(concern, times_as_bad(concern, 2.)), context).empty());
    }
}


TEST(ResolutionWarnings, SayTimeFigureAndWhatToChange)
{
  for (const Concern concern : all_concerns)
    for (const bool bends : {false, true})
      for (const bool is_explicit : {false, true})
        {
          const std::string text = warning_text(concern, 0.0123, 7.25, {0.2, 1., 162, bends, bends, is_explicit});
          EXPECT_TRUE(has(text, "WARNING: from time 7.25 on ")) << text;
          EXPECT_TRUE(has(text, "0.0123") || has(text, "1.23 %")) << text;
          EXPECT_TRUE(has(text, "Take ") || has(text, "take ")) << text;
          EXPECT_TRUE(has(text, "Fluid mesh/") || has(text, "Shell mesh/") || has(text, "Scene/") || has(text, "Time/") || has(text, "Solver/")) << text;
        }
  EXPECT_TRUE(has(warning_text(Concern::wrinkles, 2., 0., {0.2, 1., 162, false, false, false}), "Scene/Reduced bending modulus"));
  EXPECT_FALSE(has(warning_text(Concern::wrinkles, 2., 0., {0.2, 1., 162, true, false, false}), "Scene/Reduced bending modulus"));
  EXPECT_TRUE(has(warning_text(Concern::energy, 0.5, 0., {0.2, 1., 162, true, false, true}), "Solver/Coupling = implicit"));
  EXPECT_TRUE(has(warning_text(Concern::triangle, 0.1, 0., {0.2, 1., 162, true, true, false}), "Capsule/Bending form = variational"));
}


TEST(ResolutionWarnings, TheWorstValuesAreKept)
{
  WarningMemory memory;
  for (const auto &figure : worst_figures(memory))
    EXPECT_TRUE(std::isnan(figure.second));
  update_warnings(memory, 1., only(Concern::triangle, 0.9), context);
  update_warnings(memory, 2., only(Concern::triangle, 0.3), context);
  update_warnings(memory, 3., only(Concern::triangle, 0.2), context);
  update_warnings(memory, 4., only(Concern::triangle, 0.35), context);
  update_warnings(memory, 5., only(Concern::triangle, unknown), context);
  EXPECT_EQ(memory.concerns[0].worst, 0.2);
  EXPECT_EQ(memory.concerns[0].time_of_worst, 3.);
  EXPECT_EQ(memory.concerns[0].since, 2.);
  EXPECT_EQ(worst_figures(memory).front().first, "worst_triangle");
  EXPECT_EQ(worst_figures(memory).front().second, 0.2);
  EXPECT_EQ(warnings_in_short(memory, context), "WARNED from time 2 on: worst_triangle came to 0.2 at time 3 (threshold 0.4).");
  EXPECT_EQ(warnings_before_failure(memory), " A likely cause is what the run had warned of before, worst_triangle: the warnings say what to change.");
  update_warnings(memory, 6., only(Concern::folds, 0.01), context);
  update_warnings(memory, 7., only(Concern::folds, 0.02), context);
  EXPECT_EQ(memory.concerns[4].worst, 0.02);
  EXPECT_EQ(memory.concerns[4].time_of_worst, 7.);
}


TEST(ResolutionWarnings, RadiiAndGapsCountInCellsOfTheFluid)
{
  for (const Concern concern : {Concern::curvature, Concern::gap, Concern::wall})
    EXPECT_NEAR(warning_threshold(concern, {0.5, 1., 162, true, false, false}), 2.5 * warning_threshold(concern, context), 1e-15);
  EXPECT_EQ(warning_threshold(Concern::gap, context), 0.2);
}


TEST(ResolutionWarnings, FlatShapesBeginWithLongTriangles)
{
  EXPECT_EQ(warning_threshold(Concern::triangle, {0.2, 0.9, 162, true, false, false}), 0.4);
  EXPECT_EQ(warning_threshold(Concern::triangle, {0.2, 0.3, 162, true, false, false}), 0.15);
}


TEST(EnergyMemory, LeftOverByTheWorkAfterTheStart)
{
  EnergyMemory memory;
  for (unsigned int i = 0; i < 4; ++i)
    memory.add_step(0.1, 100., 2.); // the start
  for (unsigned int i = 0; i < 9; ++i)
    memory.add_step(0.1, 0.001, 2.);
  EXPECT_TRUE(std::isnan(memory.defect()));
  memory.add_step(0.2, 0.011, 4.);
  // 9 steps with 0.2 and one with the mean of 2 and 4.
  EXPECT_NEAR(memory.defect(), 0.02 / (9 * 0.2 + 0.6), 1e-15);
  memory.add_step(0.2, unknown, 4.); // forces without an energy
  EXPECT_TRUE(std::isnan(memory.defect()));
}


TEST(EnergyMemory, ShapesThatHaveComeToRestAreMeasuredByTheirWayThere)
{
  EnergyMemory memory;
  memory.add_step(0., 0., 30.);
  memory.add_step(0.1, 0.5, 10.); // 2 by the trapezoidal rule, 1.5 by the energy
  for (unsigned int i = 0; i < 13; ++i)
    memory.add_step(0.1, 1e-4, 0.);
  EXPECT_NEAR(memory.defect(), 10 * 1e-4 / (1.5 + 0.5 - 1e-4), 1e-9);
}


TEST(StepErrorMemory, WhatIsOlderThanAUnitOfTimeFades)
{
  StepErrorMemory memory;
  memory.add_step(0.5, unknown);
  EXPECT_TRUE(std::isnan(memory.sum));
  memory.add_step(0.5, 0.01);
  memory.add_step(0.5, 0.02);
  EXPECT_NEAR(memory.sum, 0.01 * std::exp(-0.5) + 0.02, 1e-15);
  memory.add_step(2., unknown);
  EXPECT_NEAR(memory.sum, 0.01 * std::exp(-2.5) + 0.02 * std::exp(-2.), 1e-15);
  // In a motion that does not change as many as there are in a unit of time, about.
  for (unsigned int i = 0; i < 1000; ++i)
    memory.add_step(0.01, 1e-5);
  EXPECT_NEAR(memory.sum, 1e-3, 1e-5);
}


TEST(ResolutionWarnings, WhatCannotBeJudgedIsSaid)
{
  ResolutionContext context;
  WarningMemory     memory;
  context.control_points = 42;
  EXPECT_NE(warning_of_few_points(context).find("a control mesh of 42 points has no coarser ones"), std::string::npos);
  context.control_points = 162;
  EXPECT_EQ(warning_of_few_points(context), "");

  context.steps_are_fixed = true;
  EXPECT_EQ(warning_of_unknown_steps(memory, context), ""); // no steps
  memory.energy.add_step(1., 0., 0.);
  EXPECT_NE(warning_of_unknown_steps(memory, context).find("none of the 1 steps is known"), std::string::npos);
  memory.steps.add_step(1., 1e-3);
  EXPECT_EQ(warning_of_unknown_steps(memory, context), "");
  memory.steps            = {};
  context.steps_are_fixed = false;
  EXPECT_EQ(warning_of_unknown_steps(memory, context), "");
}
