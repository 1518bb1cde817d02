// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many capsules there are, and where.

#ifndef tanktread_simulation_placement_parameters_h
#define tanktread_simulation_placement_parameters_h

#include <Eigen/Core>

#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** The parameters of section "Capsule" that place capsules, all of one kind. */
  struct PlacementParameters
  {
    std::vector<std::vector<double>> centres = {{0., 0., 0.}}; // of the enclosed volumes, in a

    /** Declares the parameters in section "Capsule" of `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    std::vector<Eigen::RowVector3d>
    positions() const;
  };
} // namespace tanktread

#endif
