// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the pressure inside of capsules above that of the continuous field, at points of the fluid.

#include <tanktread/coupling/shell_neighbours.h>
#include <tanktread/simulation/interior_pressure.h>

#include <cmath>

namespace tanktread
{
  InteriorPressure::InteriorPressure(Scene &scene, const State &state)
    : box_(scene.description().box)
  {
    std::vector<double> of_own;
    for (const CapsuleState &capsule : state.capsules)
      of_own.push_back(capsule.pressure_jump);
    const std::vector<double> of_all = scene.layout().gathered(of_own);
    const NumberedShells      about  = shells_about_cells(scene.layout(), scene.level().shells(state), scene.fluid().mesh());
    for (std::size_t i = 0; i < about.shells.size(); ++i)
      {
        interiors_.emplace_back(about.shells[i]->capsule().surface(), about.shells[i]->x());
        pressure_jumps_.push_back(of_all[about.numbers[i]]);
      }
  }


  double
  InteriorPressure::operator()(const dealii::Point<3> &point) const
  {
    for (std::size_t i = 0; i < interiors_.size(); ++i)
      {
        // The periodic image of the point that is nearest to the capsule.
        Eigen::Vector3d y(point[0], point[1], point[2]);
        for (unsigned int d = 0; d < 3; ++d)
          if (box_.is_periodic(d))
            y[d] -= box_.side[d] * std::round((y[d] - interiors_[i].centre()[d]) / box_.side[d]);
        if (interiors_[i].contains(y))
          return pressure_jumps_[i];
      }
    return 0.;
  }
} // namespace tanktread
