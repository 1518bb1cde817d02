// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which of many points is the nearest, periodic images included.

#include <deal.II/numerics/rtree.h>

#include <tanktread/fluid/nearest_point.h>

#include <utility>

namespace tanktread
{
  struct NearestPoint::Tree
  {
    using Entry = std::pair<dealii::Point<3>, unsigned int>;
    dealii::RTree<Entry> entries;
  };


  NearestPoint::NearestPoint(const std::vector<dealii::Point<3>> &points, const Box &box)
    : box_(box)
  {
    int n[3];
    for (unsigned int d = 0; d < 3; ++d)
      n[d] = box.is_periodic(d) ? 1 : 0;
    std::vector<Tree::Entry> entries;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const dealii::Point<3> inside = box.wrapped(points[p]);
        for (int i = -n[0]; i <= n[0]; ++i)
          for (int j = -n[1]; j <= n[1]; ++j)
            for (int k = -n[2]; k <= n[2]; ++k)
              entries.emplace_back(inside + dealii::Point<3>(i * box.side[0], j * box.side[1], k * box.side[2]), p);
      }
    tree_ = std::make_unique<const Tree>(Tree{dealii::pack_rtree(entries)});
  }


  NearestPoint::~NearestPoint() = default;


  unsigned int
  NearestPoint::operator()(const dealii::Point<3> &x) const
  {
    return tree_->entries.qbegin(boost::geometry::index::nearest(box_.wrapped(x), 1))->second;
  }
} // namespace tanktread
