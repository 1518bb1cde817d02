// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of error estimates, and of the runs that a study makes.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/study_table.h>

#include <cmath>
#include <filesystem>
#include <fstream>
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
