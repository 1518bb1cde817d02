// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities on the faces of the box that are not zero.

#ifndef tanktread_fluid_prescribed_velocity_h
#define tanktread_fluid_prescribed_velocity_h

#include <tanktread/fluid/far_field.h>
#include <tanktread/fluid/stokes_operator.h>

namespace tanktread
{
  /**
   * The discrete Stokes equations with given velocities u_b at the nodes on the faces of a box none of which is periodic. The unknowns of TaylorHoodSpace are the
   * nodes inside, where velocities vanish on the faces; here the operator is that on all nodes, of which the rows of the inner ones are taken: the residual of
   * u + u_b instead of that of u. Linear systems for changes of u stay what they are.
   *
   * The pressures' equations are solvable only if the discrete net flux of u_b through the faces is zero: the multiple of the flow x that takes it away is subtracted.
   */
  class PrescribedVelocity
  {
  public:
    /** Zero velocities. Keeps `space` by reference. Throws std::logic_error for a box with periodic faces. Collective. */
    explicit PrescribedVelocity(const TaylorHoodSpace &space);

    /** Nodes on the faces that belong to this rank, hanging ones excepted. */
    const Columns &
    places() const
    {
      return places_;
    }

    /** As StokesOperator::set_viscosity(). */
    void
    set_viscosity(const Viscosity &viscosity)
    {
      operator_.set_viscosity(viscosity);
    }

    /** @param velocity at places(). Returns the net flux through the faces that was taken out of it. Collective. */
    double
    set(const Columns &velocity);

    /** dst = [A, -B^T; -B, 0] (u + u_b, p) at the unknowns of `space`, src = (u, p); blocks from 2 on are not touched. Collective. */
    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

    /** whole = (u + u_b, p), a vector of whole_space(). */
    void
    extend(const FluidBlockVector &fields, FluidBlockVector &whole) const;

    /** The pair of spaces whose velocities have all nodes of the mesh. */
    const TaylorHoodSpace &
    whole_space() const
    {
      return whole_space_;
    }

  private:
    void
    find_nodes();

    const TaylorHoodSpace    &space_;
    const TaylorHoodSpace     whole_space_;
    StokesOperator            operator_; // on whole_space_
    std::vector<unsigned int> inner_;    // place in whole_space_ of each owned node of space_
    std::vector<unsigned int> on_faces_; // places of the nodes at places_
    Columns                   places_, velocity_;
    Columns                   flux_;      // of a unit velocity at each of the nodes at places_
    double                    flux_of_x_; // of the flow x
    mutable FluidBlockVector  src_, dst_;
  };
} // namespace tanktread

#endif
