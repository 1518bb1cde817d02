// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: pressures and their loads without the constant pressure, which is none of the shells' business.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/pressure_without_mean.h>
#include <tanktread/fluid/stokes_operator.h>

#include <algorithm>
#include <numeric>

namespace tanktread
{
  PressureWithoutMean::PressureWithoutMean(const TaylorHoodSpace &space)
    : space_(space)
    , volume_(space.mesh.box().volume())
  {
    const NodeSpace              &p = *space.pressure;
    dealii::AlignedVector<double> ones(p.full_size()), integrals(p.full_size());
    std::fill(ones.begin(), ones.end(), 1.);
    std::fill(integrals.begin(), integrals.end(), 0.);
    p.update(ones.data());
    add_pressure_mass(cubes(space), ones.data(), integrals.data());
    p.collect(integrals.data());
    integrals_.assign(integrals.begin(), integrals.begin() + p.n_owned());
  }


  void
  PressureWithoutMean::load(const FluidBlockVector &fields, dealii::AlignedVector<double> &values) const
  {
    const NodeSpace &p = *space_.pressure;
    values.resize_fast(p.full_size());
    p.load(fields.block(pressure_block), values.data());
    const double mean =
      dealii::Utilities::MPI::sum(std::inner_product(integrals_.begin(), integrals_.end(), values.begin(), 0.), space_.mesh.communicator()) / volume_;
    for (unsigned int i = 0; i < p.n_owned(); ++i)
      values[i] -= mean;
    p.update(values.data());
  }


  void
  PressureWithoutMean::add_load(dealii::AlignedVector<double> &values, FluidBlockVector &load) const
  {
    const NodeSpace &p = *space_.pressure;
    p.collect(values.data());
    const double excess = dealii::Utilities::MPI::sum(std::accumulate(values.begin(), values.begin() + p.n_owned(), 0.), space_.mesh.communicator());
    for (unsigned int i = 0; i < p.n_owned(); ++i)
      values[i] -= excess / volume_ * integrals_[i];
    p.store(values.data(), load.block(pressure_block), true);
  }
} // namespace tanktread
