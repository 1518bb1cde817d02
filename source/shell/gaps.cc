// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how near shells come to each other.

#include <tanktread/shell/gaps.h>
#include <tanktread/surface/surface_geometry.h>

#include <boost/geometry/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

namespace tanktread
{
  namespace
  {
    namespace geometry = boost::geometry;

    constexpr double least_turn = -0.9; // cosine between the normals of two sheets

    /** A shell's points to look up, made when they are needed. */
    class Surface
    {
    public:
      explicit Surface(const ShellConfiguration &shell)
        : shell_(shell)
        , low_(shell.points().colwise().minCoeff())
        , high_(shell.points().colwise().maxCoeff())
      {}

      /** Smallest signed distance of every `stride`-th of the other's points, moved by `shift`, from this surface. */
      double
      distance(const ControlPoints &points, const Eigen::RowVector3d &shift, const unsigned int stride)
      {
        double result = std::numeric_limits<double>::infinity();
        for (Eigen::Index q = 0; q < points.rows(); q += stride)
          {
            const Eigen::RowVector3d y = points.row(q) + shift;
            // Points that cannot be nearer than what has been found.
            if ((low_ - y).cwiseMax(y - high_).cwiseMax(0.).norm() > std::max(0., result))
              continue;
            const auto found = *tree().qbegin(geometry::index::nearest(Point(y[0], y[1], y[2]), 1));
            result           = std::min(result, signed_distance(patch(found.second), y.transpose()));
          }
        return result;
      }

      /** Distance of the boxes about both; zero if they meet. */
      double
      box_distance(const Surface &other, const Eigen::RowVector3d &shift) const
      {
        return (low_ - other.high_ - shift).cwiseMax(other.low_ + shift - high_).cwiseMax(0.).norm();
      }

      /** Smallest distance of its points from those parts of itself that face the other way, within `reach`. */
      double
      distance_to_opposite(const double reach)
      {
        const ControlPoints n      = normals(shell_.capsule().coupling_surface(), shell_.x());
        double              result = std::numeric_limits<double>::infinity();
        std::vector<Value>  near;
        for (Eigen::Index q = 0; q < n.rows(); q += 2) // half of them find the others
          {
            const Eigen::RowVector3d y = points().row(q), side = Eigen::RowVector3d::Constant(std::min(reach, result)), low = y - side, high = y + side;
            near.clear();
            tree().query(geometry::index::intersects(geometry::model::box<Point>(Point(low[0], low[1], low[2]), Point(high[0], high[1], high[2]))),
                         std::back_inserter(near));
            const auto distance = [&](const Value &found) {
              return n.row(q).dot(n.row(found.second)) < least_turn ? (points().row(found.second) - y).norm() : std::numeric_limits<double>::infinity();
            };
            for (const Value &found : near)
              if (distance(found) < std::min(reach, result))
                result = distance(found);
          }
        return result;
      }

      const ControlPoints &
      points() const
      {
        return shell_.points();
      }

    private:
      using Point = geometry::model::point<double, 3, geometry::cs::cartesian>;
      using Value = std::pair<Point, unsigned int>;
      using Tree  = geometry::index::rtree<Value, geometry::index::linear<16>>;

      const Tree &
      tree()
      {
        if (!tree_)
          {
            const ControlPoints &X = shell_.points();
            std::vector<Value>   values;
            for (Eigen::Index q = 0; q < X.rows(); ++q)
              values.emplace_back(Point(X(q, 0), X(q, 1), X(q, 2)), q);
            tree_ = std::make_unique<Tree>(values.begin(), values.end());
          }
        return *tree_;
      }

      QuadraticPatch
      patch(const unsigned int q) const
      {
        const SubdivisionSurface &surface = shell_.capsule().coupling_surface();
        if (surface.derivatives() == Derivatives::second)
          return shell_.patches()[q];
        const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
        return {shell_.points().row(q), surface.S_1().at(q, shell_.x()), surface.S_2().at(q, shell_.x()), zero, zero, zero};
      }

      const ShellConfiguration &shell_;
      Eigen::RowVector3d        low_, high_;
      std::unique_ptr<Tree>     tree_;
    };


    /** Images next to the box of a unit of periods: shifts by -1, 0, 1 periods from that one which brings the two middles together. */
    std::vector<Eigen::RowVector3d>
    image_shifts(const Eigen::RowVector3d &from, const Eigen::RowVector3d &to, const std::array<double, 3> &periods)
    {
      std::vector<Eigen::RowVector3d> result = {Eigen::RowVector3d::Zero()};
      for (unsigned int d = 0; d < 3; ++d)
        if (std::isfinite(periods[d]))
          {
            const double                          nearest = periods[d] * std::round((to[d] - from[d]) / periods[d]);
            const std::vector<Eigen::RowVector3d> before  = std::exchange(result, {});
            for (Eigen::RowVector3d shift : before)
              for (const int image : {-1, 0, 1})
                {
                  shift[d] = nearest + image * periods[d];
                  result.push_back(shift);
                }
          }
      return result;
    }
  } // namespace


  double
  smallest_self_gap(const ShellConfiguration &shell, const double reach)
  {
    return Surface(shell).distance_to_opposite(reach);
  }


  ShellGap
  smallest_gap(const ShellConfigurations &shells, const std::array<double, 3> &periods, const double reach)
  {
    constexpr unsigned int far_stride = 16;
    ShellGap               result;
    std::vector<Surface>   surfaces;
    for (const auto &shell : shells)
      surfaces.emplace_back(*shell);
    for (unsigned int c = 0; c < shells.size(); ++c)
      for (unsigned int d = c; d < shells.size(); ++d)
        for (const Eigen::RowVector3d &shift : image_shifts(shells[d]->x().colwise().mean(), shells[c]->x().colwise().mean(), periods))
          {
            const double boxes = surfaces[c].box_distance(surfaces[d], shift);
            if (boxes >= result.gap || (c == d && (shift.isZero() || boxes > reach)))
              continue;
            const double gap = surfaces[c].distance(surfaces[d].points(), shift, boxes > reach ? far_stride : 1);
            if (gap < result.gap)
              result = {gap, c, d};
          }
    return result;
  }


  double
  smallest_distance_from_faces(const ShellConfigurations &shells, const std::array<double, 3> &half_sides)
  {
    double result = std::numeric_limits<double>::infinity();
    for (const auto &shell : shells)
      for (unsigned int d = 0; d < 3; ++d)
        result = std::min(result, half_sides[d] - shell->points().col(d).cwiseAbs().maxCoeff());
    return result;
  }
} // namespace tanktread
