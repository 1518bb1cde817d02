// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the pressure inside of capsules above that of the continuous field, at points of the fluid.

#ifndef tanktread_simulation_interior_pressure_h
#define tanktread_simulation_interior_pressure_h

#include <tanktread/solver/scene.h>
#include <tanktread/surface/interior.h>

#include <vector>

namespace tanktread
{
  /** pi of the capsule that a point lies in, zero outside of all, periodic images included. Knows the shells about the rank's cells. */
  class InteriorPressure
  {
  public:
    /** Keeps `scene` by reference. Collective. */
    InteriorPressure(Scene &scene, const State &state);

    /** At a point in cells of this rank. Not collective. */
    double
    operator()(const dealii::Point<3> &point) const;

  private:
    const Box            &box_;
    std::vector<Interior> interiors_;
    std::vector<double>   pressure_jumps_;
  };
} // namespace tanktread

#endif
