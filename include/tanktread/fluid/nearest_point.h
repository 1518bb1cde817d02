// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which of many points is the nearest, periodic images included.

#ifndef tanktread_fluid_nearest_point_h
#define tanktread_fluid_nearest_point_h

#include <tanktread/fluid/box.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** A search tree of points in a box and of their images along its periodic axes: a search takes the logarithm of their number. */
  class NearestPoint
  {
  public:
    /** @param points one at least, anywhere along periodic axes. */
    NearestPoint(const std::vector<dealii::Point<3>> &points, const Box &box);
    ~NearestPoint();

    /** Number of the point whose nearest image is nearest to x. */
    unsigned int
    operator()(const dealii::Point<3> &x) const;

  private:
    struct Tree;
    const Box                   box_;
    std::unique_ptr<const Tree> tree_;
  };
} // namespace tanktread

#endif
