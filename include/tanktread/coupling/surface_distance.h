// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: signed distances from the shell at the nodes of the finest fluid cells near it.

#ifndef tanktread_coupling_surface_distance_h
#define tanktread_coupling_surface_distance_h

#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/surface/closest_point.h>

#include <array>

namespace tanktread
{
  /** Position of a finest cell, or twice that of a node, counted from the box's lower corner and not wrapped periodically. */
  using Lattice = std::array<int, 3>;

  /** The finest cells low[d] <= i_d < low[d] + size[d]. */
  struct LatticeBlock
  {
    Lattice low, size;

    bool
    contains(const Lattice &cell) const
    {
      for (unsigned int d = 0; d < 3; ++d)
        if (cell[d] < low[d] || cell[d] >= low[d] + size[d])
          return false;
      return true;
    }
    std::size_t
    number(const Lattice &cell) const
    {
      return (std::size_t(cell[2] - low[2]) * size[1] + (cell[1] - low[1])) * size[0] + (cell[0] - low[0]);
    }
    std::size_t
    n_cells() const
    {
      return std::size_t(size[0]) * size[1] * size[2];
    }
  };

  /**
   * Sorts the surface's points into the finest cells of the mesh, so that those near a node are found without a search. Distances are those from the nearest of
   * the points within the cells that are closer than two cells to the node, by its quadratic_patch; they depend on the points alone, not on the mesh or the
   * ranks.
   */
  class SurfaceDistance
  {
  public:
    SurfaceDistance(const FluidMesh &mesh, std::vector<QuadraticPatch> patches);

    /** All finest cells, whether or not they exist, that contain points or touch one that does. */
    std::vector<Lattice>
    cells_nearby() const;

    /** Distance in a, positive outside, of the node at (i, j, k) h/2 from the lower corner of the box. Infinite if no point is near. */
    double
    at(const Lattice &node) const;

    const std::vector<QuadraticPatch> &
    patches() const
    {
      return patches_;
    }

    /** Of cells about all points, with two cells to spare. */
    const LatticeBlock &
    block() const
    {
      return block_;
    }

  private:
    double                       h_;
    Eigen::Vector3d              corner_; // the lower one of the box
    std::vector<QuadraticPatch>  patches_;
    LatticeBlock                 block_;
    std::vector<unsigned int>    start_;            // of each cell's points in the next
    std::vector<unsigned int>    order_;            // points, cell by cell
    std::vector<Eigen::Vector3d> sorted_positions_; // in that order
  };
} // namespace tanktread

#endif
