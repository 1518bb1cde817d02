// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the mass matrix of the pressures over the viscosity.

#ifndef tanktread_fluid_pressure_mass_h
#define tanktread_fluid_pressure_mass_h

#include <tanktread/fluid/node_space.h>

#include <vector>

namespace tanktread
{
  /**
   * (1/mu p, q) on the free nodes of the pressures, on full arrays (see NodeSpace) in single precision; mu is 1 or one number a cell. `space` is kept by
   * reference.
   */
  class PressureMass
  {
  public:
    explicit PressureMass(const NodeSpace &space);

    /** @param viscosities one number a cell. */
    void
    set_viscosity(const std::vector<double> &viscosities);

    /** y = M p for owned nodes; updates the rest of p, and what y has beyond its owned nodes is void. Collective. */
    void
    apply(float *p, float *y) const;

    /** One number an owned node, hanging nodes included exactly. Collective. */
    std::vector<double>
    diagonal() const;

  private:
    const NodeSpace    &space_;
    std::vector<double> sizes_; // of cubes with the mass matrix of the cells: h mu^{-1/3}
  };
} // namespace tanktread

#endif
