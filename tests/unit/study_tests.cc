// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of error estimates, and of the runs that a study makes.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/study_table.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <stdexcept>

using namespace tanktread;

namespace
{
  /** q + C h^p for h = 1, ratio, ratio^2, ... */
  std::vector<double>
  power_law(const double limit, const double factor, const double order, const double ratio, const unsigned int n)
  {
    std::vector<double> result;
    for (unsigned int k = 0; k < n; ++k)
      result.push_back(limit + factor * std::pow(std::pow(ratio, int(k)), order));
    return result;
  }

  StudyParameters
  study_of(const std::vector<std::string> &vary, const unsigned int levels = 2)
  {
    StudyParameters study;
    study.vary   = vary;
    study.levels = levels;
    return study;
  }

  std::vector<std::string>
  names(const StudyPlan &plan)
  {
    std::vector<std::string> result;
    for (const StudyRun &run : plan.runs)
      result.push_back(run.name());
    return result;
  }
} // namespace

TEST(ErrorEstimate, FindsLimitAndOrderOfAPowerLaw)
{
  for (const double order : {1., 1.7, 2.})
    for (const double ratio : {2., 4.})
      {
        const ErrorEstimate estimate = error_estimate(power_law(3., -0.2, order, ratio, 3), ratio, 2.);
        EXPECT_TRUE(estimate.is_observed);
        EXPECT_NEAR(estimate.order, order, 1e-12);
        EXPECT_NEAR(estimate.extrapolated, 3., 1e-13);
        EXPECT_NEAR(estimate.error, 1.25 * 0.2, 1e-13);
      }
}

TEST(ErrorEstimate, OfTwoValuesTakesTheExpectedOrderAndAWiderBar)
{
  const ErrorEstimate estimate = error_estimate(power_law(1., 0.1, 2., 2., 2), 2., 2.);
  EXPECT_FALSE(estimate.is_observed);
  EXPECT_NEAR(estimate.extrapolated, 1., 1e-14);
  EXPECT_NEAR(estimate.error, 0.3, 1e-14);
}

TEST(ErrorEstimate, BelievesNoOrderOfValuesThatDoNotConverge)
{
  EXPECT_FALSE(error_estimate({1., 1.1, 1.05}, 2., 2.).is_observed); // to and fro
  EXPECT_FALSE(error_estimate({1., 1.1, 1.21}, 2., 2.).is_observed); // order 0.14
  // An order above the expected one may be chance: the limit is not taken to be nearer for it.
  const ErrorEstimate fast = error_estimate({1., 1.1, 2.7}, 2., 2.);
  EXPECT_NEAR(fast.order, 4., 1e-12);
  EXPECT_NEAR(fast.error, 1.25 * 0.1 / 3., 1e-14);
}

TEST(ErrorEstimate, RefusesWhatTellsNothing)
{
  EXPECT_THROW(error_estimate({1.}, 2., 2.), std::invalid_argument);
  EXPECT_THROW(error_estimate({1., 2.}, 1., 2.), std::invalid_argument);
}

TEST(StudyPlan, VariesEachCauseAlone)
{
  const StudyPlan plan = study_plan(study_of({"cells", "step"}, 3), false);
  EXPECT_EQ(names(plan), (std::vector<std::string>{"", "cells-1", "cells-2", "step-1", "step-2"}));
  ASSERT_EQ(plan.series.size(), 2u);
  EXPECT_EQ(plan.series[0].runs, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(plan.series[1].runs, (std::vector<std::size_t>{0, 3, 4}));
}

TEST(StudyPlan, FrugallyVariesTheOthersOnTheCoarserMesh)
{
  const StudyPlan plan = study_plan(study_of({"step", "mesh", "box"}), false);
  EXPECT_EQ(names(plan), (std::vector<std::string>{"", "mesh-1", "mesh-1_step-1", "mesh-1_box-1"}));
  EXPECT_EQ(plan.series[0].runs, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(plan.series[1].runs, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(plan.series[2].runs, (std::vector<std::size_t>{1, 3}));
}

TEST(StudyPlan, VariesAllTogether)
{
  StudyParameters study = study_of({"mesh", "step"}, 3);
  study.together        = true;
  const StudyPlan plan  = study_plan(study, false);
  EXPECT_EQ(names(plan), (std::vector<std::string>{"", "mesh-1_step-1", "mesh-2_step-2"}));
  ASSERT_EQ(plan.series.size(), 1u);
  EXPECT_EQ(plan.series[0].name(), "mesh, step");
  Parameters parameters;
  EXPECT_EQ(plan.series[0].expected_order(parameters), 2.);
  parameters.solver.interface = Interface::plain;
  EXPECT_EQ(plan.series[0].expected_order(parameters), 1.);
}

TEST(StudyPlan, SaysWhatACompanionSets)
{
  Parameters parameters;
  parameters.output.directory         = "there";
  parameters.scene.box_side           = {10., 10., 8.};
  parameters.fluid_mesh.finest_cell   = 0.15625;
  const std::vector<std::string> sets = changes(parameters, {{{Cause::mesh, 1}, {Cause::step, 2}, {Cause::box, 1}}});
  for (const std::string set :
       {"Output/Directory=there/study/mesh-1_step-2_box-1", "Fluid mesh/Finest cell=0.3125", "Shell mesh/Level=2", "Scene/Box side=5, 5, 4"})
    EXPECT_EQ(std::count(sets.begin(), sets.end(), set), 1) << set;
  EXPECT_EQ(changes(parameters, {}), std::vector<std::string>{"Study/Vary="});
}

TEST(StudyParameters, RefuseWhatCannotBeVaried)
{
  EXPECT_NO_THROW(study_of({"mesh", "stop"}).check(1, true, false, false));
  EXPECT_THROW(study_of({"mesh", "cells"}).check(3, true, false, false), InputError);
  EXPECT_THROW(study_of({"step", "step"}).check(3, true, false, false), InputError);
  EXPECT_THROW(study_of({"stop"}).check(3, false, false, false), InputError);
  EXPECT_THROW(study_of({"mesh"}, 3).check(1, true, false, false), InputError);
  EXPECT_THROW(study_of({"control mesh"}).check(-1, true, false, false), InputError);
}

TEST(StudyPlan, TakesLargerBoxesInUnboundedLiquid)
{
  Parameters parameters;
  parameters.scene.boundary = Boundary::unbounded;
  parameters.scene.box_side = {7.5};
  const StudyPlan plan      = study_plan(study_of({"box"}), true);
  const auto      sets      = changes(parameters, plan.runs[1]);
  EXPECT_EQ(std::count(sets.begin(), sets.end(), "Scene/Box side=15"), 1);
  // The run is 32 times as far from the limit as its companion.
  const StudyTable table = study_table(plan, {{{{"D", 1.032}}}, {{{"D", 1.001}}}}, parameters);
  EXPECT_NEAR(table.rows[0].estimates[0]->extrapolated, 1., 1e-12);
  EXPECT_NEAR(table.rows[0].error(), 1.25 * 0.032, 1e-12);
}

TEST(StudyTable, AddsTheBarsAndSaysWhatIsMissing)
{
  const StudyPlan plan = study_plan(study_of({"cells", "step"}), false);
  Parameters      parameters;
  parameters.time.scheme = TimeScheme::bdf2;
  const StudyTable table = study_table(plan, {{{{"D", 1.}, {"w", 2.}}}, {{{"D", 1.03}}}, {{{"D", 0.7}, {"w", 2.}}}}, parameters);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_NEAR(table.rows[0].error(), 0.03 + 0.3, 1e-14); // differences by 2^2 - 1, times 3
  EXPECT_TRUE(table.rows[0].is_complete());
  EXPECT_FALSE(table.rows[1].is_complete());
  EXPECT_NE(table.as_csv().find("D,cells,1,0.03,2,0,0.99"), std::string::npos) << table.as_csv();
}

TEST(StudyPlan, MakesNoCompanionForTheStop)
{
  EXPECT_EQ(names(study_plan(study_of({"stop"}), false)), (std::vector<std::string>{""}));
  StudyParameters study = study_of({"stop", "mesh", "step"}, 3);
  EXPECT_EQ(names(study_plan(study, false)), (std::vector<std::string>{"", "mesh-1", "mesh-2", "mesh-1_step-1", "mesh-1_step-2"}));
  study.together       = true;
  const StudyPlan plan = study_plan(study, false);
  EXPECT_EQ(names(plan), (std::vector<std::string>{"", "mesh-1_step-1", "mesh-2_step-2"}));
  ASSERT_EQ(plan.series.size(), 2u);
  EXPECT_EQ(plan.series[0].name(), "stop");
  EXPECT_EQ(plan.series[1].name(), "mesh, step");
}

TEST(StudyTable, TakesTheStopFromTheLimitsOfTheRun)
{
  const StudyPlan                     plan    = study_plan(study_of({"stop"}), false);
  const std::map<std::string, double> summary = {{"D_last_2", 0.381}, {"D_limit_2", 0.38}, {"D_limit_error_2", 2e-4}, {"D_period", 3.}, {"theta_last_2", 0.14}};
  const StudyTable                    table   = study_table(plan, {summary}, Parameters());
  std::map<std::string, StudyRow>     rows;
  for (const StudyRow &row : table.rows)
    rows.emplace(row.quantity, row);
  EXPECT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows.count("D_limit_error_2"), 0u);
  EXPECT_NEAR(rows.at("D_limit_2").error(), 2e-4, 1e-15);
  EXPECT_NEAR(rows.at("D_last_2").error(), 1.2e-3, 1e-15);
  EXPECT_NEAR(rows.at("D_last_2").estimates[0]->extrapolated, 0.38, 1e-15);
  EXPECT_FALSE(rows.at("D_period").is_complete());
  EXPECT_FALSE(rows.at("theta_last_2").is_complete()); // the run has no limit of it
}

TEST(StudyTable, ReadsOnlySummariesOfRunsThatEndedWell)
{
  const std::string folder = testing::TempDir() + "/summaries";
  std::filesystem::create_directories(folder);
  EXPECT_FALSE(finished_summary(folder + "/nowhere"));
  std::ofstream(folder + "/summary.csv") << "quantity,value\noutcome,failed\nD_last,0.3\n";
  EXPECT_FALSE(finished_summary(folder));
  std::ofstream(folder + "/summary.csv") << "quantity,value\noutcome,steady\nmode,steady\nfrom,1\nend,2\nD_last,0.3\nD_period,nan\n";
  const auto summary = finished_summary(folder);
  ASSERT_TRUE(summary);
  EXPECT_EQ(*summary, (std::map<std::string, double>{{"D_last", 0.3}}));
}

namespace
{
  /** n equal steps over ten units of time. */
  Eigen::VectorXd
  grid(const int n)
  {
    return Eigen::VectorXd::LinSpaced(n + 1, 0., 10.);
  }

  constexpr double pi = 3.14159265358979323846;

  /** A history.csv over ten units of time; semi-axes and [eta] go with D, and there are no normal stress differences. */
  void
  write_history(const std::string &file, const std::function<double(double)> &D)
  {
    std::ofstream stream(file);
    stream << std::setprecision(15) << "time,D_xz,theta,L,B,W,intrinsic_viscosity,N1,N2\n";
    for (int n = 0; n <= 400; ++n)
      {
        const double t = 10. * n / 400;
        stream << t << ',' << D(t) << ",0.2," << 1. + D(t) << ',' << 1. - D(t) << ",1," << 2.5 + D(t) << ",nan,nan\n";
      }
  }
} // namespace

TEST(CurveDifference, OfAClockThatGoesWrongLeavesNoRest)
{
  const Eigen::VectorXd t = grid(200), x = (2. * t.array()).sin(), slope = 2. * (2. * t.array()).cos();
  const Eigen::VectorXd delay = (1e-3 - 2e-4 * t.array()).matrix();
  const CurveDifference found = curve_difference(t, x, slope, slope.cwiseProduct(delay));
  EXPECT_NEAR(found.largest, 2e-3, 1e-5);
  EXPECT_NEAR(found.at_end, 2. * std::abs(std::cos(20.)) * 1e-3, 1e-15); // a delay of -1e-3 there
  EXPECT_LT(found.rest, 1e-15);
  EXPECT_LT(found.time, 1e-15);
}

TEST(CurveDifference, KeepsWhatIsNoDelay)
{
  const Eigen::VectorXd t = grid(2000), x = (2. * pi * t.array()).sin(), slope = 2. * pi * (2. * pi * t.array()).cos();
  const Eigen::VectorXd other = 0.01 * (6. * pi * t.array()).sin();
  const CurveDifference found = curve_difference(t, x, slope, other + 0.02 * slope);
  EXPECT_NEAR(found.rest, 0.01 / std::sqrt(2.), 1e-5);
  EXPECT_NEAR(found.time, 0.01 / (2. * pi), 1e-5);
  EXPECT_NEAR(found.size, 1., 1e-6);
}

TEST(StudyTable, IsNotDeceivedByExtremesThatAgreeByChance)
{
  const std::string folder = testing::TempDir() + "/curves";
  std::filesystem::create_directories(folder + "/companion");
  const double mean = 0.2, amplitude = 0.05, error = 0.003;
  const auto   run = [&](const double t) { return mean + amplitude * std::sin(2. * pi * t / 2.5); };
  write_history(folder + "/history.csv", run);
  write_history(folder + "/companion/history.csv",
                [&](const double t) { return run(t) + 0.5 * error * (1. + std::cos(4. * pi * t / 2.5)); }); // vanishes at the extremes, and is no delay
  const CurveDifferences curves = curve_differences_of(folder, folder + "/companion");
  EXPECT_NEAR(curves.at("D").largest, error, 1e-6);
  EXPECT_NEAR(curves.at("D").rest, error * std::sqrt(0.375), 1e-5);
  EXPECT_NEAR(curves.at("intrinsic_viscosity").largest, error, 1e-6);
  EXPECT_EQ(curves.count("N1"), 0u); // not finite
  EXPECT_NEAR(curves.at("theta").largest, 0., 1e-12);

  Parameters                          parameters;
  const StudyPlan                     plan = study_plan(study_of({"target"}), false);
  const std::map<std::string, double> summary =
    {{"D_minimum", 0.15}, {"D_maximum", 0.25}, {"D_period", 2.5}, {"D_frequency", 0.4}, {"D_last", 0.2}, {"intrinsic_viscosity_mean", 2.7}};
  for (const StudyRow &row : study_table(plan, {summary, summary}, parameters).rows)
    EXPECT_EQ(row.error(), 0.) << row.quantity;
  std::map<std::string, double> bars;
  for (const StudyRow &row : study_table(plan, {summary, summary}, parameters, {curves}).rows)
    bars[row.quantity] = row.error();
  const double rest = error * std::sqrt(0.375), delay = rest / (amplitude * 2. * pi / 2.5 / std::sqrt(2.));
  EXPECT_NEAR(bars.at("D_minimum"), 2. * rest, 1e-5);
  EXPECT_NEAR(bars.at("D_maximum"), 2. * rest, 1e-5);
  EXPECT_NEAR(bars.at("D_period"), 2. * delay, 1e-3 * delay);
  EXPECT_NEAR(bars.at("D_frequency") / 0.4, bars.at("D_period") / 2.5, 1e-12);
  EXPECT_NEAR(bars.at("D_last"), 1.5 * error, 1e-5);
  EXPECT_NEAR(bars.at("intrinsic_viscosity_mean"), rest, 1e-5);
  EXPECT_NEAR(bars.at("D_curve"), 1.5 * error, 1e-5);
}

TEST(StudyTable, LeavesDifferencesThatAreLargerThanTheCurvesSayAsTheyAre)
{
  const CurveDifferences curves = {{"D", {0.3, 1e-4, 1e-4, 1e-5, 1e-4}}};
  const StudyTable table = study_table(study_plan(study_of({"target"}), false), {{{{"D_maximum", 0.3}}}, {{{"D_maximum", 0.31}}}}, Parameters(), {curves});
  EXPECT_EQ(table.rows[0].quantity, "D_curve");
  EXPECT_NEAR(table.rows[1].error(), 0.01, 1e-14);
}

TEST(StudyTable, BelievesObservedOrdersWithoutTheCurves)
{
  const CurveDifferences curves = {{"D", {0.3, 0.1, 0.1, 0.1, 0.1}}};
  const StudyTable       table =
    study_table(study_plan(study_of({"cells"}, 3), false), {{{{"D_maximum", 0.3}}}, {{{"D_maximum", 0.31}}}, {{{"D_maximum", 0.35}}}}, Parameters(), {curves});
  EXPECT_TRUE(table.rows[1].estimates[0]->is_observed);
  EXPECT_NEAR(table.rows[1].error(), 1.25 * 0.01 / 3., 1e-14);
}

TEST(StudyTable, TakesLastValuesWhereTheCompanionHasNoLimit)
{
  const CurveDifferences curves = {{"D_2", {0.3, 0.02, 0.007, 0.001, 0.1}}};
  const StudyPlan        plan   = study_plan(study_of({"target", "stop"}), false); // the stop is its first series
  const StudyTable       table  = study_table(plan, {{{{"D_limit_2", 0.3}, {"D_limit_error_2", 1e-3}}}, {{{"D_last_2", 0.31}}}}, Parameters(), {{}, curves});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].quantity, "D_curve_2");
  EXPECT_NEAR(table.rows[0].error(), 0.03, 1e-14);
  EXPECT_TRUE(table.rows[0].is_complete()); // the stop is no error of a curve
  EXPECT_EQ(table.rows[1].quantity, "D_limit_2");
  EXPECT_NEAR(table.rows[1].error(), 0.007 + 1e-3, 1e-14);
  EXPECT_TRUE(table.rows[1].is_complete());
}

TEST(StudyPlan, KeepsTheControlMeshThatTheTargetHasChosen)
{
  Parameters parameters;
  parameters.accuracy.target_error = 0.01;
  parameters.shell_mesh.level      = 2;
  const StudyRun companion{{{Cause::target, 1}}};
  const auto     sets = [&](const std::string &text) {
    const std::vector<std::string> all = changes(parameters, companion);
    return std::count(all.begin(), all.end(), text);
  };
  EXPECT_EQ(sets("Accuracy/Target error=0.04"), 1);
  EXPECT_EQ(sets("Shell mesh/Level=2"), 0); // set in the file, or of a shape that has its own
  parameters.choices = {{"Shell mesh", "Level", "2"}};
  EXPECT_EQ(sets("Shell mesh/Level=2"), 1);
}
