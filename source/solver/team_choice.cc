// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which team each capsule had better belong to.

#include <deal.II/base/mpi.h>

#include <tanktread/solver/team_choice.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace tanktread
{
  std::vector<unsigned int>
  chosen_teams(const std::vector<double> &work, const std::vector<unsigned int> &present, const unsigned int n_teams, std::vector<PointsOfTeam> points)
  {
    constexpr double preference = 1.5, slack = 1.1;
    const double     share = slack * std::accumulate(work.begin(), work.end(), 0.) / n_teams;
    for (PointsOfTeam &of_team : points)
      if (of_team.team == present[of_team.capsule])
        of_team.n_points *= preference;
    std::sort(points.begin(), points.end(), [](const PointsOfTeam &a, const PointsOfTeam &b) {
      return std::make_tuple(-a.n_points, a.capsule, a.team) < std::make_tuple(-b.n_points, b.capsule, b.team);
    });
    std::vector<unsigned int> result(work.size(), n_teams); // none yet
    std::vector<double>       load(n_teams, 0.);
    const auto                give = [&](const unsigned int c, const unsigned int team) {
      result[c] = team;
      load[team] += work[c];
    };
    for (const PointsOfTeam &of_team : points)
      if (result[of_team.capsule] == n_teams && (load[of_team.team] == 0. || load[of_team.team] + work[of_team.capsule] <= share))
        give(of_team.capsule, of_team.team);
    for (unsigned int c = 0; c < work.size(); ++c)
      if (result[c] == n_teams)
        give(c, std::min_element(load.begin(), load.end()) - load.begin());
    return result;
  }


  std::vector<unsigned int>
  chosen_teams(const Coupling &coupling)
  {
    const ShellLayout                 &layout = coupling.layout();
    std::vector<double>                work;
    std::vector<unsigned int>          present;
    std::vector<std::array<double, 3>> here;
    for (unsigned int c = 0; c < layout.n_capsules(); ++c)
      {
        work.push_back(layout.capsules()[c].n_control_points());
        present.push_back(layout.team_of(c));
      }
    for (unsigned int p = 0; p < coupling.transfers().size(); ++p)
      if (const unsigned int n = coupling.transfers()[p].n_points(); n > 0)
        here.push_back({{double(coupling.guests().present()[p]), double(layout.team_of_rank(layout.rank())), double(n)}});
    std::map<std::pair<unsigned int, unsigned int>, double> sums; // several ranks of a team may have points
    for (const auto &of_rank : dealii::Utilities::MPI::all_gather(layout.communicator(), here))
      for (const auto &[capsule, team, n_points] : of_rank)
        sums[{static_cast<unsigned int>(capsule), static_cast<unsigned int>(team)}] += n_points;
    std::vector<PointsOfTeam> points;
    for (const auto &[place, n_points] : sums)
      points.push_back({place.first, place.second, n_points});
    return chosen_teams(work, present, layout.n_teams(), std::move(points));
  }
} // namespace tanktread
