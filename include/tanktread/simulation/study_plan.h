// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the runs of a study and what is learned from which of them.

#ifndef tanktread_simulation_study_plan_h
#define tanktread_simulation_study_plan_h

#include <tanktread/simulation/study_parameters.h>

#include <map>
#include <string>
#include <vector>

namespace tanktread
{
  struct Parameters;

  /** A run with some causes coarser than in the parameter file, each so many times. */
  struct StudyRun
  {
    std::map<Cause, unsigned int> coarser;

    /** Name of its folder: "mesh-1_step-1"; empty for the run itself. */
    std::string
    name() const;
  };

  /** Runs, by their numbers, that differ by the causes alone: the finest first. */
  struct StudySeries
  {
    std::vector<Cause>       causes; // more than one: varied together
    std::vector<std::size_t> runs;

    /** "step", or "mesh, step" for several. */
    std::string
    name() const;

    /** How much coarser one run is than the one before, as the power law has it, and the order that theory gives it. */
    double
    ratio() const;
    double
    expected_order(bool is_enriched, bool is_second_order_in_time) const;
  };

  struct StudyPlan
  {
    std::vector<StudyRun>    runs; // the run itself first
    std::vector<StudySeries> series;
  };

  StudyPlan
  study_plan(const StudyParameters &study);

  /** What is set, as "Section/Parameter=value", to make a companion of a run with these parameters. */
  std::vector<std::string>
  changes(const Parameters &parameters, const StudyRun &run);
} // namespace tanktread

#endif
