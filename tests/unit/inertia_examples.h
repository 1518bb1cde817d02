// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: meshes and flows that the tests of inertia share.

#ifndef tanktread_tests_inertia_examples_h
#define tanktread_tests_inertia_examples_h

#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/fluid/undisturbed_flow.h>

namespace tanktread
{
  constexpr double pi = dealii::numbers::PI;

  inline FluidMeshParameters
  mesh_parameters(const double coarsest, const double finest)
  {
    FluidMeshParameters p;
    p.coarsest_cell = coarsest;
    p.finest_cell   = finest;
    p.band_width    = 1.;
    return p;
  }

  inline double
  norm(const FluidBlockVector &u)
  {
    return u.block(velocity_block).l2_norm();
  }

  /** Along x, y and z, and changing along all of them. Where the box is periodic the wind jumps, which the terms do not mind: they are sums over cells. */
  inline UndisturbedFlow
  linear_in_all_directions()
  {
    UndisturbedFlow flow = uniaxial_extension(0.4);
    flow.constant[1]     = 0.2;
    flow.linear[0][1]    = 0.3;
    flow.linear[1][2]    = -0.5;
    flow.linear[2][0]    = 0.6;
    return flow;
  }

  /** Two parabolas and (yz, 0, 0) on top of it. */
  inline UndisturbedFlow
  quadratic_in_all_directions()
  {
    UndisturbedFlow flow    = linear_in_all_directions();
    flow.quadratic          = plane_poiseuille(2., 1.1).quadratic;
    flow.quadratic[2][0][0] = 0.3;
    flow.quadratic[0][1][2] = flow.quadratic[0][2][1] = 0.2;
    return flow;
  }
} // namespace tanktread

#endif
