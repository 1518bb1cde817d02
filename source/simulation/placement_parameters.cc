// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many capsules there are, and where.

#include <deal.II/base/parameter_handler.h>

#include <tanktread/simulation/placement_parameters.h>

namespace tanktread
{
  void
  PlacementParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::List;
    prm.enter_subsection("Capsule");
    prm.add_parameter("Centres",
                      centres,
                      "Centres of the capsules, in a: x, y, z of the first; x, y, z of the second; and so on. All capsules are of one kind. Along periodic axes they may lie "
                      "anywhere.",
                      List(List(Double(), 3, 3, ","), 1, 1000000, ";"));
    prm.leave_subsection();
  }


  std::vector<Eigen::RowVector3d>
  PlacementParameters::positions() const
  {
    std::vector<Eigen::RowVector3d> result;
    for (const std::vector<double> &centre : centres)
      result.emplace_back(centre[0], centre[1], centre[2]);
    return result;
  }
} // namespace tanktread
