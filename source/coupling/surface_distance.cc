// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: signed distances from the shell at the nodes of the finest fluid cells near it.

#include <tanktread/coupling/surface_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tanktread
{
  SurfaceDistance::SurfaceDistance(const FluidMesh &mesh, std::vector<QuadraticPatch> patches)
    : h_(mesh.cell_size(mesh.finest_level()))
    , corner_(mesh.box().lower(0), mesh.box().lower(1), mesh.box().lower(2))
    , patches_(std::move(patches))
  {
    std::vector<Lattice> cells(patches_.size());
    Lattice              high;
    block_.low.fill(std::numeric_limits<int>::max());
    high.fill(std::numeric_limits<int>::min());
    for (std::size_t q = 0; q < patches_.size(); ++q)
      for (unsigned int d = 0; d < 3; ++d)
        {
          cells[q][d]   = static_cast<int>(std::floor((patches_[q].X[d] - corner_[d]) / h_));
          block_.low[d] = std::min(block_.low[d], cells[q][d] - 2);
          high[d]       = std::max(high[d], cells[q][d] + 2);
        }
    for (unsigned int d = 0; d < 3; ++d)
      block_.size[d] = high[d] - block_.low[d] + 1;

    start_.assign(block_.n_cells() + 1, 0);
    for (const Lattice &cell : cells)
      ++start_[block_.number(cell) + 1];
    for (std::size_t i = 1; i < start_.size(); ++i)
      start_[i] += start_[i - 1];
    std::vector<unsigned int> next(start_);
    order_.resize(patches_.size());
    sorted_positions_.resize(patches_.size());
    for (std::size_t q = 0; q < patches_.size(); ++q)
      {
        const unsigned int place = next[block_.number(cells[q])]++;
        order_[place]            = q;
        sorted_positions_[place] = patches_[q].X;
      }
  }


  std::vector<Lattice>
  SurfaceDistance::cells_nearby() const
  {
    std::vector<char>    near(start_.size() - 1, 0);
    std::vector<Lattice> result;
    Lattice              cell, other;
    for (cell[2] = block_.low[2] + 2; cell[2] < block_.low[2] + block_.size[2] - 2; ++cell[2])
      for (cell[1] = block_.low[1] + 2; cell[1] < block_.low[1] + block_.size[1] - 2; ++cell[1])
        for (cell[0] = block_.low[0] + 2; cell[0] < block_.low[0] + block_.size[0] - 2; ++cell[0])
          if (start_[block_.number(cell)] < start_[block_.number(cell) + 1])
            for (int n = 0; n < 27; ++n)
              {
                other = {cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1};
                if (!std::exchange(near[block_.number(other)], 1))
                  result.push_back(other);
              }
    return result;
  }


  double
  SurfaceDistance::at(const Lattice &node) const
  {
    // Cells that come closer than two cells to the node.
    Lattice first, last;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const int lower = node[d] >= 0 ? node[d] / 2 : (node[d] - 1) / 2; // the cell that contains the node, the upper one of two
        first[d]        = std::max(lower - (node[d] % 2 == 0 ? 2 : 1), block_.low[d]);
        last[d]         = std::min(lower + 1, block_.low[d] + block_.size[d] - 1);
      }
    const Eigen::Vector3d y       = corner_ + 0.5 * h_ * Eigen::Vector3d(node[0], node[1], node[2]);
    double                nearest = std::numeric_limits<double>::infinity();
    std::size_t           found   = order_.size();
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        {
          if (first[0] > last[0])
            continue;
          const unsigned int end = start_[block_.number({last[0], j, k}) + 1];
          for (unsigned int i = start_[block_.number({first[0], j, k})]; i < end; ++i)
            {
              const double distance = (sorted_positions_[i] - y).squaredNorm();
              if (distance < nearest)
                {
                  nearest = distance;
                  found   = i;
                }
            }
        }
    return found == order_.size() ? nearest : signed_distance(patches_[order_[found]], y);
  }
} // namespace tanktread
