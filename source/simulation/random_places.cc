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

    /** Capsules that have reached a part of their size, and fixed ones of full size. */
    class Suspension
    {
    public:
      Suspension(const RandomPlacement &wanted, const std::vector<KindInPlace> &kinds, const Box &box)
        : wanted_(wanted)
        , kinds_(kinds)
        , box_(box)
        , chance_(wanted.seed)
        , step_(*std::min_element(box.side.begin(), box.side.end()) / 2.)
      {
        for (unsigned int k = 0; k < kinds.size(); ++k)
          {
            clouds_.emplace_back(kinds[k].shape);
            largest_radius_ = std::max(largest_radius_, clouds_[k].radius);
            for (const Place &place : kinds[k].fixed)
              capsules_.push_back({place, k});
          }
        n_fixed_           = capsules_.size();
        const double reach = 2. * largest_radius_ + wanted_.least_gap;
        int          n[3];
        for (unsigned int d = 0; d < 3; ++d)
          n[d] = box_.is_periodic(d) && box_.side[d] < 2. * reach ? 1 : 0; // more than the nearest image
        for (int i = -n[0]; i <= n[0]; ++i)
          for (int j = -n[1]; j <= n[1]; ++j)
            for (int k = -n[2]; k <= n[2]; ++k)
              images_.emplace_back(i * box_.side[0], j * box_.side[1], k * box_.side[2]);
      }

      /** Whether all capsules and the gaps around them would be too much for the box; known of spheres of one size. */
      bool
      is_full() const
      {
        double volume = 0.;
        for (unsigned int k = 0; k < kinds_.size(); ++k)
          {
            if (!clouds_[k].is_sphere || std::abs(clouds_[k].radius - clouds_[0].radius) > 1e-3 * clouds_[0].radius)
              return false;
            volume += (kinds_[k].number + kinds_[k].fixed.size()) * std::pow(2. * clouds_[k].radius + wanted_.least_gap, 3) * M_PI / 6.;
          }
        return volume > densest * box_.volume();
      }

      /** Small capsules, one after the other. Returns whether there was room for all. */
      bool
      begin()
      {
        for (unsigned int k = 0; k < kinds_.size(); ++k)
          for (unsigned int n = 0; n < kinds_[k].number; ++n)
            {
              bool found = false;
              for (unsigned int trial = 0; trial < n_trials && !found; ++trial)
                {
                  const Eigen::RowVector3d unit = chance_.in_cube(0.5);
                  Place                    place({unit[0] * box_.side[0], unit[1] * box_.side[1], unit[2] * box_.side[2]},
                              kinds_[k].turned ? chance_.turn() : Eigen::Matrix3d::Identity());
                  capsules_.push_back({std::move(place), k});
                  found = gap(capsules_.back(), capsules_.size() - 1) >= wanted_.least_gap;
                  if (!found)
                    capsules_.pop_back();
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
        for (std::size_t c = n_fixed_; c < capsules_.size(); ++c)
          {
            PlacedCapsule moved = capsules_[c];
            Place        &place = moved.place;
            place.centre += chance_.in_cube(step_);
            for (unsigned int d = 0; d < 3; ++d)
              if (box_.is_periodic(d))
                place.centre[d] -= box_.side[d] * std::floor(place.centre[d] / box_.side[d] + 0.5);
            if (kinds_[moved.kind].turned)
              place.turn =
                Eigen::AngleAxisd(std::min(step_ / clouds_[moved.kind].radius, 1.) * chance_.number(), chance_.direction()).toRotationMatrix() * place.turn;
            if (gap(moved, c) >= wanted_.least_gap)
              {
                capsules_[c] = moved;
                ++n_moved;
              }
          }
        step_ *= 2 * n_moved > capsules_.size() - n_fixed_ ? 1.1 : 0.9;
        step_ = std::min(step_, *std::max_element(box_.side.begin(), box_.side.end()) / 2.);
      }

      /** As far as all gaps stay allowed: points of a capsule move by its radius at most. Returns by how much. */
      double
      grow()
      {
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t c = n_fixed_; c < capsules_.size(); ++c)
          smallest = std::min(smallest, gap(capsules_[c], c));
        const double growth = std::min(1. - size_, (smallest - wanted_.least_gap) / (2. * largest_radius_));
        size_ += std::max(growth, 0.);
        return growth;
      }

      double
      size() const
      {
        return size_;
      }

      /** The random places of each kind. */
      std::vector<std::vector<Place>>
      places() const
      {
        std::vector<std::vector<Place>> result(kinds_.size());
        for (std::size_t c = n_fixed_; c < capsules_.size(); ++c)
          result[capsules_[c].kind].push_back(capsules_[c].place);
        return result;
      }

    private:
      struct PlacedCapsule
      {
        Place        place;
        unsigned int kind;
      };

      /** A capsule as it is now. */
      struct Body
      {
        const Cloud           &cloud;
        const Eigen::Matrix3d &turn;
        double                 size;
      };

      Body
      body(const PlacedCapsule &capsule, const std::size_t c) const
      {
        return {clouds_[capsule.kind], capsule.place.turn, c < n_fixed_ ? 1. : size_};
      }

      /** Signed distance of the points of a capsule from the tangent planes at the nearest points of the other; `apart`: from the first's centre to the second's. */
      double
      gap_of_clouds(const Body &first, const Body &second, const Eigen::RowVector3d &apart, const double reach) const
      {
        double                   result   = reach;
        const Eigen::Matrix3d    relative = second.turn.transpose() * first.turn;
        const Eigen::RowVector3d shift    = -apart * second.turn; // the first's centre in the second's frame
        for (Eigen::Index i = 0; i < first.cloud.points.rows(); ++i)
          {
            const Eigen::RowVector3d p = first.size * (first.cloud.points.row(i) * relative.transpose()) + shift;
            if (p.norm() > second.size * second.cloud.radius + result)
              continue;
            Eigen::Index nearest;
            const double distance = std::sqrt((second.size * second.cloud.points).rowwise().operator-(p).rowwise().squaredNorm().minCoeff(&nearest));
            const double above    = (p - second.size * second.cloud.points.row(nearest)).dot(second.cloud.normals.row(nearest));
            result                = std::min(result, above < 0. ? std::max(above, -distance) : above);
          }
        return result;
      }

      double
      gap_of_pair(const Body &first, const Body &second, const Eigen::RowVector3d &apart) const
      {
        const double radii = first.size * first.cloud.radius + second.size * second.cloud.radius, between = apart.norm() - radii;
        if ((first.cloud.is_sphere && second.cloud.is_sphere) || between >= wanted_.least_gap)
          return between;
        const double reach = wanted_.least_gap + 0.5 * radii; // beyond it gaps only bound the growth of one round
        return std::min(gap_of_clouds(first, second, apart, reach), gap_of_clouds(second, first, -apart, reach));
      }

      /** What is left of the gap to faces, and the least gap between capsules. */
      double
      gap_to_faces(const Body &body, const Eigen::RowVector3d &centre) const
      {
        double result = std::numeric_limits<double>::infinity();
        for (unsigned int d = 0; d < 3; ++d)
          if (!box_.is_periodic(d))
            {
              const double extent = body.cloud.is_sphere ? body.cloud.radius : (body.cloud.points * body.turn.row(d).transpose()).cwiseAbs().maxCoeff();
              result              = std::min(result, 0.5 * box_.side[d] - std::abs(centre[d]) - body.size * extent - wanted_.face_gap + wanted_.least_gap);
            }
        return result;
      }

      /** Smallest gap of `capsule`, number c, to all others, all images and the faces; ends early with one that is not allowed. */
      double
      gap(const PlacedCapsule &capsule, const std::size_t c) const
      {
        const Body body   = this->body(capsule, c);
        double     result = gap_to_faces(body, capsule.place.centre);
        for (std::size_t other = 0; other < capsules_.size(); ++other)
          {
            const PlacedCapsule &neighbour = other == c ? capsule : capsules_[other];
            Eigen::RowVector3d   apart     = neighbour.place.centre - capsule.place.centre;
            for (unsigned int d = 0; d < 3; ++d)
              if (box_.is_periodic(d))
                apart[d] -= box_.side[d] * std::floor(apart[d] / box_.side[d] + 0.5);
            for (const Eigen::RowVector3d &image : images_)
              {
                if (other != c || !image.isZero())
                  result = std::min(result, gap_of_pair(body, this->body(neighbour, other), apart + image));
                if (result < wanted_.least_gap)
                  return result;
              }
          }
        return result;
      }

      const RandomPlacement          &wanted_;
      const std::vector<KindInPlace> &kinds_;
      const Box                      &box_;
      Chance                          chance_;
      std::vector<Cloud>              clouds_; // of the kinds
      double                          largest_radius_ = 0.;
      std::vector<Eigen::RowVector3d> images_;   // shifts beyond the nearest image
      std::vector<PlacedCapsule>      capsules_; // the fixed ones first
      std::size_t                     n_fixed_ = 0;
      double                          size_    = first_size, step_;
    };
  } // namespace


  std::vector<std::vector<Place>>
  random_places(const RandomPlacement &wanted, const std::vector<KindInPlace> &kinds, const Box &box)
  {
    Suspension suspension(wanted, kinds, box);
    const bool is_full = suspension.is_full();
    bool       fits    = !is_full && suspension.begin();
    double     before  = suspension.size(); // some rounds ago
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
        unsigned int       number = 0;
        for (const KindInPlace &kind : kinds)
          number += kind.number;
        message << number << " capsules with gaps of " << wanted.least_gap << " a find no room in the box";
        if (!is_full)
          message << ": they came to " << suspension.size() << " of their size";
        message << "; allowed: fewer, a smaller gap or a larger box.";
        throw InputError(message.str());
      }
    return suspension.places();
  }
} // namespace tanktread
