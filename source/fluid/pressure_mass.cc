// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the mass matrix of the pressures over the viscosity.

#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/pressure_mass.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  namespace
  {
    /** Of the trilinear functions on the unit cube. */
    std::vector<double>
    unit_cube_matrix()
    {
      std::vector<double> result(64, 1. / 216.);
      for (unsigned int i = 0; i < 8; ++i)
        for (unsigned int j = 0; j < 8; ++j)
          for (unsigned int bit = 1; bit < 8; bit *= 2)
            result[8 * i + j] *= (i & bit) == (j & bit) ? 2. : 1.;
      return result;
    }
  } // namespace


  PressureMass::PressureMass(const NodeSpace &space)
    : space_(space)
    , sizes_(space.cell_sizes())
  {}


  void
  PressureMass::set_viscosity(const std::vector<double> &viscosities)
  {
    for (std::size_t i = 0; i < sizes_.size(); ++i)
      sizes_[i] = space_.cell_sizes()[i] / std::cbrt(viscosities[i]);
  }


  void
  PressureMass::apply(float *const p, float *const y) const
  {
    space_.update(p);
    std::fill(y, y + space_.full_size(), 0.f);
    add_pressure_mass({space_.n_cells(), sizes_.data(), nullptr, space_.cell_nodes(0)}, p, y);
    space_.collect(y);
  }


  std::vector<double>
  PressureMass::diagonal() const
  {
    std::vector<double> factors;
    for (const double h : sizes_)
      factors.push_back(std::pow(h, 3));
    return space_.diagonal(unit_cube_matrix(), factors);
  }
} // namespace tanktread
