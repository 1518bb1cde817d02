// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: cell by cell averages on the next coarser rung of the mesh.

#ifndef tanktread_fluid_cell_averages_h
#define tanktread_fluid_cell_averages_h

#include <tanktread/fluid/node_space.h>

namespace tanktread
{
  /** Takes one number a cell from a rung to the one before, where a cell gets the mean over its volume. */
  class CellAverages
  {
  public:
    /** @param parent number of the coarse cell, counted over all ranks, that each cell of `fine` lies in or is. Collective. */
    CellAverages(const std::vector<dealii::types::global_dof_index> &parent, const NodeSpace &coarse, const NodeSpace &fine);

    /** Values on the cells of `coarse`. Collective. */
    std::vector<double>
    operator()(const std::vector<double> &values) const;

  private:
    std::vector<unsigned int>                                  parent_; // places in vectors of partitioner_
    std::vector<double>                                        volume_, coarse_volume_;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  };

  /** How many cells the ranks before this one have. Collective. */
  dealii::types::global_dof_index
  first_cell(const NodeSpace &space);
} // namespace tanktread

#endif
