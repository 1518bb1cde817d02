// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: cell by cell averages on the next coarser rung of the mesh.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/cell_averages.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  using Index = dealii::types::global_dof_index;

  Index
  first_cell(const NodeSpace &space)
  {
    const Index n      = space.n_cells();
    Index       result = 0;
    MPI_Exscan(&n, &result, 1, DEAL_II_DOF_INDEX_MPI_TYPE, MPI_SUM, space.partitioner()->get_mpi_communicator());
    return result;
  }


  CellAverages::CellAverages(const std::vector<Index> &parent, const NodeSpace &coarse, const NodeSpace &fine)
  {
    for (const double h : fine.cell_sizes())
      volume_.push_back(std::pow(h, 3));
    for (const double h : coarse.cell_sizes())
      coarse_volume_.push_back(std::pow(h, 3));

    const MPI_Comm   communicator = coarse.partitioner()->get_mpi_communicator();
    const Index      first        = first_cell(coarse);
    dealii::IndexSet owned(dealii::Utilities::MPI::sum(Index(coarse.n_cells()), communicator)), ghosts(owned.size());
    owned.add_range(first, first + coarse.n_cells());
    std::vector<Index> sorted(parent);
    std::sort(sorted.begin(), sorted.end());
    ghosts.add_indices(sorted.begin(), std::unique(sorted.begin(), sorted.end()));
    ghosts.subtract_set(owned);
    partitioner_ = std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, ghosts, communicator);
    for (const Index cell : parent)
      parent_.push_back(partitioner_->global_to_local(cell));
  }


  std::vector<double>
  CellAverages::operator()(const std::vector<double> &values) const
  {
    FluidVector sums(partitioner_);
    for (std::size_t i = 0; i < parent_.size(); ++i)
      sums.local_element(parent_[i]) += volume_[i] * values[i];
    sums.compress(dealii::VectorOperation::add);
    std::vector<double> result(coarse_volume_.size());
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = sums.local_element(i) / coarse_volume_[i];
    return result;
  }
} // namespace tanktread
