// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: pressures and their loads without the constant pressure, which is none of the shells' business.

#ifndef tanktread_coupling_pressure_without_mean_h
#define tanktread_coupling_pressure_without_mean_h

#include <deal.II/base/aligned_vector.h>

#include <tanktread/fluid/taylor_hood_space.h>

#include <vector>

namespace tanktread
{
  /**
   * A constant pressure is removed from p_h, and from the load of the continuity equation, of both of which shells would know by errors of the quadrature only:
   * two maps that are each other's transpose.
   */
  class PressureWithoutMean
  {
  public:
    /** Keeps `space` by reference. Collective. */
    explicit PressureWithoutMean(const TaylorHoodSpace &space);

    /** A full array of the pressure of `fields` without its mean. Collective. */
    void
    load(const FluidBlockVector &fields, dealii::AlignedVector<double> &values) const;

    /** Adds a full array of loads, without what a constant pressure meets in it, to the pressure of `load`. Collective; `values` is void afterwards. */
    void
    add_load(dealii::AlignedVector<double> &values, FluidBlockVector &load) const;

  private:
    const TaylorHoodSpace &space_;
    double                 volume_;
    std::vector<double>    integrals_; // of the pressure functions, owned ones
  };
} // namespace tanktread

#endif
