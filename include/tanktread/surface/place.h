// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where a capsule starts.

#ifndef tanktread_surface_place_h
#define tanktread_surface_place_h

#include <tanktread/surface/types.h>

#include <Eigen/Core>

namespace tanktread
{
  /** A shape about the origin is turned, x -> R x, and then moved to `centre`, in a. */
  struct Place
  {
    Place(const Eigen::RowVector3d &centre = Eigen::RowVector3d::Zero(), const Eigen::Matrix3d &turn = Eigen::Matrix3d::Identity())
      : centre(centre)
      , turn(turn)
    {}

    Eigen::RowVector3d centre;
    Eigen::Matrix3d    turn; // R
  };

  /** Points of a shape (one a row) at a place. */
  inline ControlPoints
  placed(const ControlPoints &x, const Place &place)
  {
    return (x * place.turn.transpose()).rowwise() + place.centre;
  }
} // namespace tanktread

#endif
