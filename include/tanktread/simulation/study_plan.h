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

  /** A run with some causes coarser than in the parameter file, each so many times. In unbounded liquid, where it costs little, a box is larger instead. */
  struct StudyRun
  {
    std::map<Cause, unsigned int> coarser;

    /** Name of its folder: "mesh-1_step-1"; empty for the run itself. */
    std::string
    name() const;
  };

  /** Runs, by their numbers, that differ by the causes alone: the one whose error is wanted first, each of the others once more coarser (or finer). For the stop the run itself alone. */
  struct StudySeries
  {
    std::vector<Cause>       causes; // more than one: varied together
    std::vector<std::size_t> runs;
    bool                     is_finer = false; // the companions: a larger box in unbounded liquid

    /** "step", or "mesh, step" for several. */
    std::string
    name() const;

    /** How much coarser one run is than the one before, as the power law has it, and the order that theory gives it. */
    double
    ratio() const;
    double
    expected_order(const Parameters &parameters) const;
  };

  struct StudyPlan
  {
    std::vector<StudyRun>    runs; // the run itself first
    std::vector<StudySeries> series;
  };

  /** @param larger_box whether the companions that tell the error of the box have larger ones. */
  StudyPlan
  study_plan(const StudyParameters &study, bool larger_box);

  /** What is set, as "Section/Parameter=value", to make a companion of a run with these parameters. */
  std::vector<std::string>
  changes(const Parameters &parameters, const StudyRun &run);
} // namespace tanktread

#endif
