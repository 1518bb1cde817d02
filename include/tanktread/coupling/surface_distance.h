// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: signed distances from the shell at the nodes of the finest fluid cells near it.

#ifndef tanktread_coupling_surface_distance_h
#define tanktread_coupling_surface_distance_h

#include <tanktread/coupling/cell_runs.h>
#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/surface/closest_point.h>

#include <vector>

namespace tanktread
{
  /**
   * Sorts the surface's points into the finest cells of the mesh, so that those near a node are found without a search. Distances are those from the nearest of
   * the points within the cells that are at most one cell away from the node in each direction, by its quadratic_patch; they depend on the points alone, not on
   * the mesh or the ranks.
   *
   * Memory goes with the points and the rows of cells along x that pass the capsule, not with the cells around it.
   */
  class SurfaceDistance
  {
  public:
    /** Throws NumericalError when a coordinate of a point is not finite, and when the points are as far apart as those of no shell. */
    SurfaceDistance(const FluidMesh &mesh, std::vector<QuadraticPatch> patches);

    /** All finest cells, whether or not they exist, that contain points or touch one that does; in an order that depends on the points alone. */
    std::vector<Lattice>
    cells_nearby() const;

    /** The same cells as a set. */
    CellRuns
    runs_nearby() const;

    /** Distance in a, positive outside, of the node at (i, j, k) h/2 from the lower corner of the box. Infinite if no point is near. */
    double
    at(const Lattice &node) const;

    const std::vector<QuadraticPatch> &
    patches() const
    {
      return patches_;
    }

    /** Lowest index of the cells nearby in each direction. */
    const Lattice &
    low() const
    {
      return low_;
    }
    /** How many cells from the lowest to the highest of the cells nearby in each direction. */
    Lattice
    extent() const
    {
      return {{size_x_, rows_.size_y, rows_.size_z}};
    }

  private:
    /** A cell that contains points. */
    struct Cell
    {
      std::int64_t x;
      unsigned int start; // of its points in order_; they end where those of the next begin
    };

    /** Sorts points into cells, cells by z, y and x, points of a cell as they came. */
    void
    sort_points(const std::vector<Lattice> &cells);

    double                                                    h_;
    Eigen::Vector3d                                           corner_; // the lower one of the box
    std::vector<QuadraticPatch>                               patches_;
    Lattice                                                   low_;
    std::int64_t                                              size_x_;    // of the cells nearby
    LatticeRows                                               rows_;      // of the cells nearby
    std::vector<unsigned int>                                 start_;     // of each row in the next
    std::vector<Cell>                                         cells_;     // row by row, and one more for the end
    std::vector<unsigned int>                                 order_;     // points, cell by cell
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> positions_; // of the points in that order
  };
} // namespace tanktread

#endif
