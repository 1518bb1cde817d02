// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities and their gradients at arbitrary points, and the adjoint.

#ifndef tanktread_fluid_point_interpolation_h
#define tanktread_fluid_point_interpolation_h

#include <deal.II/base/point.h>

#include <tanktread/fluid/cell_locator.h>
#include <tanktread/fluid/taylor_hood_space.h>

#include <cstddef>
#include <vector>

namespace tanktread
{
  /**
   * The matrix Phi: free velocity nodes -> velocity at points X_q, and its gradient; the transposes give load vectors. `reinit` for every new set of points.
   *
   * Each rank has the points in its own cells, local_points(), and arrays of results and of loads hold those only, in this order, with 3 (or 9) numbers a
   * point.
   * Velocities and loads are vectors of TaylorHoodSpace::reinit(), without values at ghosts.
   */
  class PointInterpolation
  {
  public:
    /** `space` is kept by reference. */
    explicit PointInterpolation(const TaylorHoodSpace &space);

    /** Finds the cells of `points` (the same on all ranks). Collective. Throws NumericalError, on all ranks, unless each point is in one cell of one rank. */
    void
    reinit(const std::vector<dealii::Point<3>> &points);

    /**
     * The same for points that not all ranks know. @param points those that may be in cells of this rank, others among them. @param n_all how many different points
     * all ranks have together. Throws NumericalError too where a point is in cells of a rank that does not know it.
     */
    void
    reinit(const std::vector<dealii::Point<3>> &points, std::size_t n_all);

    /** Which of the points are on this rank, ascending. */
    const std::vector<unsigned int> &
    local_points() const
    {
      return local_points_;
    }

    /** The cells (of this rank) that the local points are in, and their positions in the unit cube. */
    const std::vector<unsigned int> &
    cells() const
    {
      return cells_;
    }
    const std::vector<dealii::Point<3>> &
    unit_positions() const
    {
      return unit_;
    }

    /** values[3 r + c] = u_c at the r-th local point. Collective. */
    void
    values(const FluidBlockVector &velocity, std::vector<double> &values) const;

    /** gradients[9 r + 3 c + d] = du_c/dx_d, from inside the cell. Collective. */
    void
    gradients(const FluidBlockVector &velocity, std::vector<double> &gradients) const;

    /** laplacians[3 r + c] of u_c, from inside the cell. Collective. */
    void
    laplacians(const FluidBlockVector &velocity, std::vector<double> &laplacians) const;

    /** Both at once. */
    void
    values_and_gradients(const FluidBlockVector &velocity, std::vector<double> &values, std::vector<double> &gradients) const;

    /**
     * The transpose: adds to the velocity of `load` the functional v -> sum_q F_q . v(X_q) + sum_q G_q : grad v(X_q). Collective.
     *
     * @param forces F at the local points. @param moments G in the layout of the gradients, or empty on all ranks.
     */
    void
    add_load(const std::vector<double> &forces, const std::vector<double> &moments, FluidBlockVector &load) const;

  private:
    /** Points of one cell: order_[begin], ..., order_[end - 1]. */
    struct Group
    {
      unsigned int cell, begin, end;
    };

    /** Fills order_ and groups_. */
    void
    sort_by_cell();

    /** Calls evaluate_in(group, nodal velocities of its cell) for every group. */
    template <typename Function>
    void
    for_groups(const FluidBlockVector &velocity, const Function &evaluate_in) const;
    /** Calls evaluate_at(r, nodal velocities of its cell, shape functions) for every local point r. */
    template <typename Function>
    void
    for_points(const FluidBlockVector &velocity, const Function &evaluate_at) const;

    const TaylorHoodSpace        &space_;
    CellLocator                   locator_;
    std::vector<unsigned int>     local_points_, cells_; // and the cells of the local points
    std::vector<dealii::Point<3>> unit_;                 // their positions there
    std::vector<unsigned int>     order_;                // local points by cell, so that each cell's nodes are fetched once
    std::vector<Group>            groups_;
    std::vector<unsigned int>     starts_; // for sorting
  };
} // namespace tanktread

#endif
