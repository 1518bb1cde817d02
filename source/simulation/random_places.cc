// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules at random in a box, none of which overlap.

#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/random_places.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace tanktread
{
  namespace
  {
    constexpr unsigned int n_trials = 1000, n_rounds = 100, last_rounds = 20;
    constexpr double       first_size = 0.3, least_growth = 2e-3; // in n_rounds
    constexpr double       densest = 0.74;                        // part of a volume that spheres can fill

    /** Numbers that are the same with all libraries, which those of <random>'s distributions are not. */
    class Chance
    {
    public:
      explicit Chance(const unsigned int seed)
        : generator_(seed)
      {}

      /** In [0, 1). */
      double
      number()
      {
        return std::ldexp(double(generator_() >> 11), -53);
      }

      Eigen::RowVector3d
      in_cube(const double half_side)
      {
        const double x = number(), y = number(), z = number();
        return half_side * Eigen::RowVector3d(2. * x - 1., 2. * y - 1., 2. * z - 1.);
      }

      Eigen::Vector3d
      direction()
      {
        for (;;)
          if (const Eigen::Vector3d x = in_cube(1.).transpose(); x.squaredNorm() > 1e-4 && x.squaredNorm() < 1.)
            return x.normalized();
      }

      /** All orientations alike (Shoemake, Graphics Gems III, 124 (1992)). */
      Eigen::Matrix3d
      turn()
      {
        const double u = number(), a = 2. * M_PI * number(), b = 2. * M_PI * number(), p = std::sqrt(1. - u), q = std::sqrt(u);
        return Eigen::Quaterniond(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)).toRotationMatrix();
      }

    private:
      std::mt19937_64 generator_;
    };

    /** Points of a shape about the origin with outward normals. */
    struct Cloud
    {
      explicit Cloud(const FittedShape &shape)
      {
        const TriangleMesh mesh = limit_mesh(shape.topology, shape.control_points);
        points.resize(mesh.vertices.size(), 3);
        for (Eigen::Index i = 0; i < points.rows(); ++i)
          points.row(i) = mesh.vertices[i].transpose();
        normals.setZero(points.rows(), 3);
        for (const auto &face : mesh.faces)
          {
            const Eigen::Vector3d &p = mesh.vertices[face[0]], area = 0.5 * (mesh.vertices[face[1]] - p).cross(mesh.vertices[face[2]] - p);
            for (const auto i : face)
              normals.row(i) += area.transpose();
          }
        normals.rowwise().normalize();
        radius    = points.rowwise().norm().maxCoeff();
        is_sphere = radius - points.rowwise().norm().minCoeff() < 1e-3 * radius;
      }

      ControlPoints points, normals;
      double        radius;    // of the sphere around all points
      bool          is_sphere; // whose gaps need no points
    };

    /** Capsules that have reached a part of their size. */
    class Suspension
    {
    public:
      Suspension(const RandomPlacement &wanted, const Cloud &cloud, const Box &box)
        : wanted_(wanted)
        , cloud_(cloud)
        , box_(box)
        , chance_(wanted.seed)
        , step_(*std::min_element(box.side.begin(), box.side.end()) / 2.)
      {
        const double reach = 2. * cloud_.radius + wanted_.least_gap;
        int          n[3];
        for (unsigned int d = 0; d < 3; ++d)
          n[d] = box_.is_periodic(d) && box_.side[d] < 2. * reach ? 1 : 0; // more than the nearest image
        for (int i = -n[0]; i <= n[0]; ++i)
          for (int j = -n[1]; j <= n[1]; ++j)
            for (int k = -n[2]; k <= n[2]; ++k)
              images_.emplace_back(i * box_.side[0], j * box_.side[1], k * box_.side[2]);
      }

      /** Small capsules, one after the other. Returns whether there was room for all. */
      bool
      begin()
      {
        for (unsigned int c = 0; c < wanted_.number; ++c)
          {
            bool found = false;
            for (unsigned int trial = 0; trial < n_trials && !found; ++trial)
              {
                const Eigen::RowVector3d unit = chance_.in_cube(0.5);
                Place                    place({unit[0] * box_.side[0], unit[1] * box_.side[1], unit[2] * box_.side[2]},
                            wanted_.turned ? chance_.turn() : Eigen::Matrix3d::Identity());
                found = gap(place, c) >= wanted_.least_gap;
                if (found)
                  places_.push_back(std::move(place));
              }
            if (!found)
              return false;
          }
        return true;
      }

      /** Each capsule tries one move; the length of moves is kept such that about a half is done. */
      void
      move_all()
      {
        unsigned int n_moved = 0;
        for (unsigned int c = 0; c < places_.size(); ++c)
          {
            Place place = places_[c];
            place.centre += chance_.in_cube(step_);
            for (unsigned int d = 0; d < 3; ++d)
              if (box_.is_periodic(d))
                place.centre[d] -= box_.side[d] * std::floor(place.centre[d] / box_.side[d] + 0.5);
            if (wanted_.turned)
              place.turn = Eigen::AngleAxisd(std::min(step_ / cloud_.radius, 1.) * chance_.number(), chance_.direction()).toRotationMatrix() * place.turn;
            if (gap(place, c) >= wanted_.least_gap)
              {
                places_[c] = place;
                ++n_moved;
              }
          }
        step_ *= 2 * n_moved > places_.size() ? 1.1 : 0.9;
        step_ = std::min(step_, *std::max_element(box_.side.begin(), box_.side.end()) / 2.);
      }

      /** As far as all gaps stay allowed: points of a capsule move by its radius at most. Returns by how much. */
      double
      grow()
      {
        double smallest = std::numeric_limits<double>::infinity();
        for (unsigned int c = 0; c < places_.size(); ++c)
          smallest = std::min(smallest, gap(places_[c], c));
        const double growth = std::min(1. - size_, (smallest - wanted_.least_gap) / (2. * cloud_.radius));
        size_ += std::max(growth, 0.);
        return growth;
      }

      double
      size() const
      {
        return size_;
      }

      const std::vector<Place> &
      places() const
      {
        return places_;
      }

    private:
      /** Signed distance of the points of a capsule from the tangent planes at the nearest points of the other; `apart`: from the first's centre to the second's. */
      double
      gap_of_clouds(const Place &first, const Place &second, const Eigen::RowVector3d &apart, const double reach) const
      {
        double                   result   = reach;
        const Eigen::Matrix3d    relative = second.turn.transpose() * first.turn;
        const Eigen::RowVector3d shift    = -apart * second.turn; // the first's centre in the second's frame
        for (Eigen::Index i = 0; i < cloud_.points.rows(); ++i)
          {
            const Eigen::RowVector3d p = size_ * (cloud_.points.row(i) * relative.transpose()) + shift;
            if (p.norm() > size_ * cloud_.radius + result)
              continue;
            Eigen::Index nearest;
            const double distance = std::sqrt((size_ * cloud_.points).rowwise().operator-(p).rowwise().squaredNorm().minCoeff(&nearest));
            const double above    = (p - size_ * cloud_.points.row(nearest)).dot(cloud_.normals.row(nearest));
            result                = std::min(result, above < 0. ? std::max(above, -distance) : above);
          }
        return result;
      }

      double
      gap_of_pair(const Place &first, const Place &second, const Eigen::RowVector3d &apart) const
      {
        const double between = apart.norm() - 2. * size_ * cloud_.radius;
        if (cloud_.is_sphere || between >= wanted_.least_gap)
          return between;
        const double reach = wanted_.least_gap + size_ * cloud_.radius; // beyond it gaps only bound the growth of one round
        return std::min(gap_of_clouds(first, second, apart, reach), gap_of_clouds(second, first, -apart, reach));
      }

      /** What is left of the gap to faces, and the least gap between capsules. */
      double
      gap_to_faces(const Place &place) const
      {
        double result = std::numeric_limits<double>::infinity();
        for (unsigned int d = 0; d < 3; ++d)
          if (!box_.is_periodic(d))
            {
              const double extent = cloud_.is_sphere ? cloud_.radius : (cloud_.points * place.turn.row(d).transpose()).cwiseAbs().maxCoeff();
              result              = std::min(result, 0.5 * box_.side[d] - std::abs(place.centre[d]) - size_ * extent - wanted_.face_gap + wanted_.least_gap);
            }
        return result;
      }

      /** Smallest gap of capsule c at `place` to all others, all images and the faces; ends early with one that is not allowed. */
      double
      gap(const Place &place, const unsigned int c) const
      {
        double result = gap_to_faces(place);
        for (unsigned int other = 0; other < places_.size() + (c == places_.size() ? 1 : 0); ++other)
          {
            const Place       &neighbour = other == c ? place : places_[other];
            Eigen::RowVector3d apart     = neighbour.centre - place.centre;
            for (unsigned int d = 0; d < 3; ++d)
              if (box_.is_periodic(d))
                apart[d] -= box_.side[d] * std::floor(apart[d] / box_.side[d] + 0.5);
            for (const Eigen::RowVector3d &image : images_)
              {
                if (other != c || !image.isZero())
                  result = std::min(result, gap_of_pair(place, neighbour, apart + image));
                if (result < wanted_.least_gap)
                  return result;
              }
          }
        return result;
      }

      const RandomPlacement          &wanted_;
      const Cloud                    &cloud_;
      const Box                      &box_;
      Chance                          chance_;
      std::vector<Eigen::RowVector3d> images_; // shifts beyond the nearest image
      std::vector<Place>              places_;
      double                          size_ = first_size, step_;
    };
  } // namespace


  std::vector<Place>
  random_places(const RandomPlacement &wanted, const FittedShape &shape, const Box &box)
  {
    const Cloud cloud(shape);
    Suspension  suspension(wanted, cloud, box);
    const bool  is_full = cloud.is_sphere && wanted.number * std::pow(2. + wanted.least_gap, 3) * M_PI / 6. > densest * box.volume();
    bool        fits    = !is_full && suspension.begin();
    double      before  = suspension.size(); // some rounds ago
    for (unsigned int round = 1, left = last_rounds; fits && left > 0; ++round)
      {
        suspension.move_all();
        suspension.grow();
        if (suspension.size() >= 1.)
          --left;
        else if (round % n_rounds == 0)
          {
            fits   = suspension.size() > (1. + least_growth) * before;
            before = suspension.size();
          }
      }
    if (!fits)
      {
        std::ostringstream message;
        message << wanted.number << " capsules with gaps of " << wanted.least_gap << " a find no room in the box";
        if (!is_full)
          message << ": they came to " << suspension.size() << " of their size";
        message << "; allowed: fewer, a smaller gap or a larger box.";
        throw InputError(message.str());
      }
    return suspension.places();
  }
} // namespace tanktread
