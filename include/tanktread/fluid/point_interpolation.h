// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities and their gradients at arbitrary points, and the adjoint.

#ifndef tanktread_fluid_point_interpolation_h
#define tanktread_fluid_point_interpolation_h

#include <deal.II/base/point.h>

#include <tanktread/fluid/taylor_hood_space.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace tanktread
{
  /**
   * Finds cells by integer coordinates: a point's position on level l is floor((x - corner) / h_l), so the search is a few hash look-ups, has no tolerance and
   * gives each point exactly one cell (the upper one if it lies on a face) on exactly one rank.
   */
  class CellLocator
  {
  public:
    struct Location
    {
      int              cell = -1; // index among the locally owned active cells in deal.II's order; -1: not on this rank
      dealii::Point<3> unit;      // position in the unit cell
    };

    explicit CellLocator(const FluidMesh &mesh);

    /** The point is wrapped into the box in x and y; throws NumericalError if it is not between the walls. */
    Location
    locate(const dealii::Point<3> &point) const;

  private:
    const FluidMesh                       &mesh_;
    std::unordered_map<std::uint64_t, int> cells_;
    std::vector<unsigned int>              levels_; // that occur on this rank, finest first
  };

  /**
   * The matrices Phi: velocity coefficients -> velocity at points X_q, and its gradient, with the constraints resolved, so that they act on condensed vectors and their
   * transposes give condensed load vectors. `reinit` for every new set of points; all point arrays are replicated on all ranks and have 3 (or 9) doubles a point.
   */
  class PointInterpolation
  {
  public:
    explicit PointInterpolation(const TaylorHoodSpace &space);

    /** Locates `points` (the same on all ranks) and evaluates shape functions. Collective. Throws NumericalError if a point is in no cell. */
    void
    reinit(const std::vector<dealii::Point<3>> &points);

    /** values[3 q + c] = u_c(X_q). Collective; the result is the same on all ranks. `velocity`: condensed coefficients. */
    void
    values(const FluidBlockVector &velocity, std::vector<double> &values) const;

    /** As values(), and gradients[9 q + 3 c + d] = du_c/dx_d (X_q). */
    void
    values_and_gradients(const FluidBlockVector &velocity, std::vector<double> &values, std::vector<double> &gradients) const;

    /**
     * The transpose: adds to the velocity blocks of `load` the functional v -> sum_q F_q . v(X_q) + sum_q G_q : grad v(X_q).
     *
     * @param forces 3 n_points doubles F. @param moments 9 n_points doubles G in the layout of the gradients, or empty.
     */
    void
    add_load(const std::vector<double> &forces, const std::vector<double> &moments, FluidBlockVector &load) const;

    unsigned int
    n_points() const
    {
      return n_points_;
    }

  private:
    /** One non-zero of a row: local index in the ghosted vector, shape value and gradient. */
    struct Entry
    {
      unsigned int          index;
      double                value;
      std::array<double, 3> gradient;
    };

    /** One degree of freedom of a cell expressed by unconstrained ones. */
    struct ResolvedDof
    {
      std::vector<std::pair<unsigned int, double>> masters; // local index, weight
    };
    using ResolvedCell = std::array<ResolvedDof, 27>; // lexicographic

    const ResolvedCell &
    resolve(int cell);

    const TaylorHoodSpace                                   &space_;
    CellLocator                                              locator_;
    std::vector<dealii::DoFHandler<3>::active_cell_iterator> cells_;
    std::unordered_map<int, ResolvedCell>                    resolved_;
    std::vector<unsigned int>                                lexicographic_to_hierarchic_;
    unsigned int                                             n_points_ = 0;
    std::vector<unsigned int>                                local_points_;
    std::vector<std::size_t>                                 row_start_;
    std::vector<Entry>                                       entries_;
  };
} // namespace tanktread

#endif
