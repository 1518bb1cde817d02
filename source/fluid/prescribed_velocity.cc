// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities on the faces of the box that are not zero.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/prescribed_velocity.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    const TaylorHoodSpace &
    checked(const TaylorHoodSpace &space)
    {
      for (unsigned int d = 0; d < 3; ++d)
        if (space.mesh.box().is_periodic(d))
          throw std::logic_error("PrescribedVelocity: the box has periodic faces.");
      return space;
    }


    double
    product(const Columns &a, const Columns &b)
    {
      double result = 0.;
      for (unsigned int c = 0; c < 3; ++c)
        result += std::inner_product(a[c].begin(), a[c].end(), b[c].begin(), 0.);
      return result;
    }
  } // namespace


  PrescribedVelocity::PrescribedVelocity(const TaylorHoodSpace &space)
    : space_(checked(space))
    , whole_space_(TaylorHoodSpace::with_faces(space))
    , operator_(whole_space_)
  {
    find_nodes();
    whole_space_.reinit(src_);
    whole_space_.reinit(dst_);
    velocity_.fill(std::vector<double>(on_faces_.size(), 0.));

    // A pressure of one everywhere loads the nodes on the faces, -B^T 1, with minus the flux of their shape functions, and no others.
    src_.block(pressure_block) = 1.;
    operator_.vmult(dst_, src_);
    src_ = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      for (const unsigned int node : on_faces_)
        flux_[c].push_back(-dst_.block(velocity_block).local_element(3 * node + c));
    flux_of_x_ = dealii::Utilities::MPI::sum(product(flux_, places_), space.mesh.communicator());
  }


  void
  PrescribedVelocity::find_nodes()
  {
    constexpr unsigned int    unknown = std::numeric_limits<unsigned int>::max();
    const NodeSpace          &all = *whole_space_.velocity, &inner = *space_.velocity;
    const Box                &box     = space_.mesh.box();
    const std::vector<double> corners = lower_corners(space_);
    std::vector<bool>         found(all.n_owned(), false);
    inner_.assign(inner.n_owned(), unknown);
    for (unsigned int cell = 0; cell < all.n_cells(); ++cell)
      for (unsigned int a = 0; a < 27; ++a)
        {
          const unsigned int node = all.cell_nodes(cell)[a], inside = inner.cell_nodes(cell)[a];
          if (node >= all.n_owned() || found[node])
            continue;
          found[node]                 = true;
          const double           half = 0.5 * all.cell_sizes()[cell];
          const dealii::Point<3> place =
            dealii::Point<3>(corners[3 * cell], corners[3 * cell + 1], corners[3 * cell + 2]) + half * dealii::Point<3>(a % 3, a / 3 % 3, a / 9);
          bool on_face = false;
          for (unsigned int d = 0; d < 3; ++d)
            on_face = on_face || std::abs(place[d]) > 0.5 * box.side[d] - 0.5 * half;
          if (!on_face)
            {
              inner_.at(inside) = node;
              continue;
            }
          on_faces_.push_back(node);
          for (unsigned int d = 0; d < 3; ++d)
            places_[d].push_back(place[d]);
        }
    if (std::find(inner_.begin(), inner_.end(), unknown) != inner_.end())
      throw std::logic_error("PrescribedVelocity: a node of the space is not one of those with the nodes on the faces.");
  }


  double
  PrescribedVelocity::set(const Columns &velocity)
  {
    const double flux = dealii::Utilities::MPI::sum(product(flux_, velocity), space_.mesh.communicator());
    for (unsigned int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < on_faces_.size(); ++i)
        velocity_[c][i] = velocity[c][i] - flux / flux_of_x_ * places_[c][i];
    return flux;
  }


  void
  PrescribedVelocity::extend(const FluidBlockVector &fields, FluidBlockVector &whole) const
  {
    FluidVector &u = whole.block(velocity_block);
    for (unsigned int c = 0; c < 3; ++c)
      {
        for (std::size_t i = 0; i < inner_.size(); ++i)
          u.local_element(3 * inner_[i] + c) = fields.block(velocity_block).local_element(3 * i + c);
        for (std::size_t i = 0; i < on_faces_.size(); ++i)
          u.local_element(3 * on_faces_[i] + c) = velocity_[c][i];
      }
    whole.block(pressure_block) = fields.block(pressure_block);
  }


  void
  PrescribedVelocity::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    extend(src, src_);
    operator_.vmult(dst_, src_);
    for (std::size_t i = 0; i < inner_.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        dst.block(velocity_block).local_element(3 * i + c) = dst_.block(velocity_block).local_element(3 * inner_[i] + c);
    dst.block(pressure_block) = dst_.block(pressure_block);
  }
} // namespace tanktread
