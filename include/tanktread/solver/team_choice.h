// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which team each capsule had better belong to.

#ifndef tanktread_solver_team_choice_h
#define tanktread_solver_team_choice_h

#include <tanktread/coupling/coupling.h>

#include <vector>

namespace tanktread
{
  /** How many of a capsule's points in the fluid lie in cells of a team. */
  struct PointsOfTeam
  {
    unsigned int capsule, team;
    double       n_points;
  };

  /**
   * Gives capsules to the teams in whose cells most of their points lie, as far as none gets more than its share of the work and a tenth, or one capsule: the most points first. A
   * capsule's present team counts one and a half times, so that it does not go back and forth. A pure function.
   *
   * @param work of each capsule. @param present team of each. @param points of all capsules.
   */
  std::vector<unsigned int>
  chosen_teams(const std::vector<double> &work, const std::vector<unsigned int> &present, unsigned int n_teams, std::vector<PointsOfTeam> points);

  /** For the capsules where the coupling's points are now, their work in proportion to their control points. The same on all ranks. Collective. */
  std::vector<unsigned int>
  chosen_teams(const Coupling &coupling);
} // namespace tanktread

#endif
