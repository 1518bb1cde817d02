// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities given by formulas, for tests.

#ifndef tanktread_tests_nodal_velocity_h
#define tanktread_tests_nodal_velocity_h

#include <tanktread/fluid/taylor_hood_space.h>

#include <array>
#include <cmath>

namespace tanktread
{
  /**
   * Velocity vector with the values of `formula`, Point<3> -> std::array<double, 3>, at the free nodes. It has to be periodic in x and y; at the walls the
   * velocity is zero.
   */
  template <typename Formula>
  FluidBlockVector
  nodal_velocity(const TaylorHoodSpace &space, const Formula &formula)
  {
    FluidBlockVector result;
    space.reinit(result);
    const NodeSpace &nodes = *space.velocity;
    unsigned int     index = 0;
    for (const auto &cell : space.mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int *const cell_nodes = nodes.cell_nodes(index++);
          for (unsigned int a = 0; a < 27; ++a)
            if (cell_nodes[a] < nodes.n_owned())
              {
                const dealii::Point<3>      offset(a % 3, a / 3 % 3, a / 9);
                const std::array<double, 3> u = formula(cell->vertex(0) + 0.5 * space.mesh.cell_size(cell->level()) * offset);
                for (unsigned int c = 0; c < 3; ++c)
                  result.block(velocity_block).local_element(3 * cell_nodes[a] + c) = u[c];
              }
        }
    return result;
  }


  /** A smooth velocity with many wave lengths, periodic in a box of that side; not divergence-free. */
  struct Waves
  {
    explicit Waves(const double side, const double phase = 0.)
      : k(2. * dealii::numbers::PI / side)
      , phase(phase)
    {}

    std::array<double, 3>
    operator()(const dealii::Point<3> &x) const
    {
      return {{std::sin(k * x[0] + phase) * std::cos(k * x[2]) + 0.3 * std::sin(3. * k * x[1]),
               std::cos(2. * k * x[0] + phase) * std::sin(k * x[1]) + x[2] * x[2],
               std::sin(k * x[1]) * std::sin(2. * k * x[2] + phase) + 0.2 * std::cos(4. * k * x[0])}};
    }

    double k, phase;
  };
} // namespace tanktread

#endif
