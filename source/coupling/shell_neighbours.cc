// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how near the shells of a scene come to each other, whichever ranks hold them.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/shell_neighbours.h>

#include <algorithm>
#include <limits>
#include <map>

namespace tanktread
{
  namespace
  {
    /** The nearest gap that any rank has found, the same on all. Collective. */
    ShellGap
    least(const ShellGap &found, const MPI_Comm communicator)
    {
      ShellGap result = found;
      for (const auto &[gap, first, second] :
           dealii::Utilities::MPI::all_gather(communicator, std::array<double, 3>{{found.gap, double(found.first), double(found.second)}}))
        if (gap < result.gap || (gap == result.gap && first < result.first))
          result = {gap, static_cast<unsigned int>(first), static_cast<unsigned int>(second)};
      return result;
    }
  } // namespace


  std::vector<ShellBox>
  boxes_of_all(const ShellLayout &layout, const ShellConfigurations &own)
  {
    std::vector<double> corners;
    for (const auto &shell : own)
      {
        const ShellBox box = shell_box(shell->points());
        corners.insert(corners.end(), box.lower.begin(), box.lower.end());
        corners.insert(corners.end(), box.upper.begin(), box.upper.end());
      }
    const std::vector<double> all = layout.gathered(corners, 6);
    std::vector<ShellBox>     result;
    for (std::size_t i = 0; i < all.size(); i += 6)
      result.push_back({{{all[i], all[i + 1], all[i + 2]}}, {{all[i + 3], all[i + 4], all[i + 5]}}});
    return result;
  }


  ShellConfigurations
  shells_of_others(const ShellLayout &layout, const ShellConfigurations &own, const std::vector<unsigned int> &numbers)
  {
    using Numbers = std::map<unsigned int, std::vector<unsigned int>>;
    Numbers asked;
    for (const unsigned int c : numbers)
      asked[layout.leader(layout.team_of(c))].push_back(c);
    std::map<unsigned int, std::vector<double>> sent;
    for (const auto &[rank, of_rank] : dealii::Utilities::MPI::some_to_some(layout.communicator(), asked))
      for (const unsigned int c : of_rank)
        {
          const ControlPoints &x = own[std::lower_bound(layout.own().begin(), layout.own().end(), c) - layout.own().begin()]->x();
          sent[rank].insert(sent[rank].end(), x.data(), x.data() + x.size());
        }
    const auto                             received = dealii::Utilities::MPI::some_to_some(layout.communicator(), sent);
    std::map<unsigned int, const double *> next; // of what each rank has sent
    for (const auto &[rank, values] : received)
      next[rank] = values.data();
    ShellConfigurations result;
    for (const unsigned int c : numbers)
      {
        const double *&values  = next.at(layout.leader(layout.team_of(c)));
        const Capsule &capsule = layout.capsules()[c];
        result.push_back(std::make_shared<ShellConfiguration>(capsule, Eigen::Map<const ControlPoints>(values, capsule.n_control_points(), 3)));
        values += 3 * std::size_t(capsule.n_control_points());
      }
    return result;
  }


  NumberedShells
  shells_about_cells(const ShellLayout &layout, const ShellConfigurations &own, const FluidMesh &mesh)
  {
    NumberedShells result{layout.own(), own};
    if (layout.n_teams() == 1)
      return result;
    constexpr double      huge = std::numeric_limits<double>::max();
    ShellBox              of_cells{{{huge, huge, huge}}, {{-huge, -huge, -huge}}};
    std::array<double, 3> periods;
    bool                  has_cells = false;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          has_cells = true;
          for (unsigned int d = 0; d < 3; ++d)
            {
              of_cells.lower[d] = std::min(of_cells.lower[d], cell->vertex(0)[d]);
              of_cells.upper[d] = std::max(of_cells.upper[d], cell->vertex(7)[d]);
            }
        }
    for (unsigned int d = 0; d < 3; ++d)
      periods[d] = mesh.box().is_periodic(d) ? mesh.box().side[d] : std::numeric_limits<double>::infinity();
    const std::vector<ShellBox> boxes = boxes_of_all(layout, own);
    std::vector<unsigned int>   further;
    for (unsigned int c = 0; c < boxes.size(); ++c)
      if (has_cells && layout.team_of(c) != layout.team_of_rank(layout.rank()) && box_distance(of_cells, boxes[c], periods) == 0.)
        further.push_back(c);
    const ShellConfigurations of_others = shells_of_others(layout, own, further);
    result.numbers.insert(result.numbers.end(), further.begin(), further.end());
    result.shells.insert(result.shells.end(), of_others.begin(), of_others.end());
    return result;
  }


  ShellGap
  smallest_gap(const ShellLayout &layout, const ShellConfigurations &own, const std::array<double, 3> &periods, const double reach)
  {
    if (layout.n_teams() == 1)
      return smallest_gap(own, periods, reach);
    const std::vector<ShellBox> boxes = boxes_of_all(layout, own);
    std::vector<double>         nearest(boxes.size(), std::numeric_limits<double>::infinity()); // from the own ones
    for (const unsigned int c : layout.own())
      for (unsigned int d = 0; d < boxes.size(); ++d)
        if (layout.team_of(d) != layout.team_of(c))
          nearest[d] = std::min(nearest[d], box_distance(boxes[c], boxes[d], periods));
    // Those within reach first; where none is that near, or gaps are much wider than the boxes are apart, all that may be nearer than what has been found.
    const double        first_reach   = std::max(reach, dealii::Utilities::MPI::min(*std::min_element(nearest.begin(), nearest.end()), layout.communicator()));
    ShellConfigurations shells        = own;
    std::vector<unsigned int> numbers = layout.own();
    ShellGap                  result;
    for (double radius = first_reach;; radius = result.gap)
      {
        std::vector<unsigned int> further;
        for (unsigned int d = 0; d < boxes.size(); ++d)
          if (nearest[d] <= radius && std::find(numbers.begin(), numbers.end(), d) == numbers.end())
            further.push_back(d);
        const ShellConfigurations of_others = shells_of_others(layout, own, further);
        shells.insert(shells.end(), of_others.begin(), of_others.end());
        numbers.insert(numbers.end(), further.begin(), further.end());
        // Pair by pair in the order of numbers, which says whose points are taken and whose surface: the same whoever holds them.
        ShellGap   here;
        const auto judge = [&](const std::size_t i, const std::size_t j) {
          const bool in_order = numbers[i] <= numbers[j];
          const auto first = in_order ? i : j, second = in_order ? j : i;
          if (first != second && box_distance(boxes[numbers[first]], boxes[numbers[second]], periods) >= here.gap)
            return;
          ShellConfigurations both = {shells[first]};
          if (first != second)
            both.push_back(shells[second]);
          if (const ShellGap gap = smallest_gap(both, periods, reach); gap.gap < here.gap)
            here = {gap.gap, numbers[gap.first == 0 ? first : second], numbers[gap.second == 0 ? first : second]};
        };
        for (std::size_t i = 0; i < own.size(); ++i)
          for (std::size_t j = i; j < shells.size(); ++j)
            judge(i, j);
        result = least(here, layout.communicator());
        if (result.gap <= radius)
          break;
      }
    if (result.second < result.first)
      std::swap(result.first, result.second);
    return result;
  }
} // namespace tanktread
