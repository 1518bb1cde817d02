// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the box of fluid, its sides and what holds on its faces.

#ifndef tanktread_fluid_box_h
#define tanktread_fluid_box_h

#include <deal.II/base/point.h>

#include <array>
#include <cmath>

namespace tanktread
{
  /** What holds on a pair of opposite faces. */
  enum class Faces
  {
    periodic,  // what leaves through one comes in through the other
    prescribed // the velocity is that of the undisturbed flow: a wall where that flow does not pass the face
  };

  /** A box centred at the origin, side[d] long along axis d. Lengths in a. */
  struct Box
  {
    std::array<double, 3> side  = {{10., 10., 10.}};
    std::array<Faces, 3>  faces = {{Faces::periodic, Faces::periodic, Faces::prescribed}};

    Box() = default;

    /** The cube between walls in z, periodic in x and y. Meant to be implicit. */
    Box(const double side)
      : side({{side, side, side}})
    {}

    Box(const std::array<double, 3> &side, const std::array<Faces, 3> &faces)
      : side(side)
      , faces(faces)
    {}

    bool
    is_periodic(const unsigned int d) const
    {
      return faces[d] == Faces::periodic;
    }

    /** Coordinate of the lower face. */
    double
    lower(const unsigned int d) const
    {
      return -0.5 * side[d];
    }

    double
    volume() const
    {
      return side[0] * side[1] * side[2];
    }

    /** Whether a point lies between the faces with prescribed velocity; along periodic axes it may be anywhere. */
    bool
    contains(const dealii::Point<3> &x) const
    {
      for (unsigned int d = 0; d < 3; ++d)
        if (!is_periodic(d) && !(std::abs(x[d]) < 0.5 * side[d]))
          return false;
      return true;
    }

    /** The periodic image in the box: lower(d) <= x_d < -lower(d) along periodic axes, the rest as it is. */
    dealii::Point<3>
    wrapped(dealii::Point<3> x) const
    {
      for (unsigned int d = 0; d < 3; ++d)
        if (is_periodic(d))
          x[d] -= side[d] * std::floor(x[d] / side[d] + 0.5);
      return x;
    }
  };
} // namespace tanktread

#endif
