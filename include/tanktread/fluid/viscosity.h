// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a viscosity that differs from place to place.

#ifndef tanktread_fluid_viscosity_h
#define tanktread_fluid_viscosity_h

#include <tanktread/fluid/cut_cell.h>
#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <array>
#include <vector>

namespace tanktread
{
  /** Abscissae of the Gauss rule with three points on the unit interval. */
  const std::array<double, 3> &
  gauss_abscissae();

  /** Cells in parts of which the viscosity is larger than elsewhere in them. */
  struct CutCells
  {
    std::vector<unsigned int> cells;   // on this rank
    std::vector<double>       weights; // 125 for each, see CellWeights, of the part with the larger viscosity times the difference
  };

  /**
   * Viscosity, in that of the outer liquid, at the points of the 3 x 3 x 3 Gauss rule of each cell of this rank, and what there is more in cut cells. The
   * strain form is integrated with these, preconditioners take the cells'
   * means.
   */
  class Viscosity
  {
  public:
    /**
     * @param at_points 27 positive numbers a cell, x fastest. @param least not larger than any of them, the same on all ranks. @param cut what to add to
     * `at_points`.
     */
    Viscosity(std::vector<double> at_points, double least, CutCells cut = {});

    const std::vector<double> &
    at_points() const
    {
      return at_points_;
    }
    const CutCells &
    cut() const
    {
      return cut_;
    }
    double
    least() const
    {
      return least_;
    }
    /** One number a cell. */
    const std::vector<double> &
    means() const
    {
      return means_;
    }
    /** The number at the points of each cell where all 27 of it are the same in all cells of this rank; empty otherwise. */
    const std::vector<double> &
    in_cells() const
    {
      return in_cells_;
    }
    /**
     * What there is more in cut cells at the points of the 3 x 3 x 3 rule, 27 numbers for each: positive ones with the same integral that come near to the
     * weights, for preconditioners.
     */
    std::vector<double>
    cut_at_points() const;

    /**
     * y += 2 ((viscosity - 1) eps(u_inf), eps(v)): what the viscosity adds to the load of the flow that the velocities are disturbances of. Its strain rate is
     * linear in space, for which the rules are exact where the viscosity is constant. Collective.
     */
    void
    add_excess_stress(const TaylorHoodSpace &space, const UndisturbedFlow &flow, FluidVector &y) const;

  private:
    std::vector<double> at_points_, means_, in_cells_;
    double              least_;
    CutCells            cut_;
  };
} // namespace tanktread

#endif
