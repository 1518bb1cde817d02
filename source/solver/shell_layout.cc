// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where the unknowns of each capsule stand in the monolithic vectors, and which rank owns them.

#include <deal.II/base/mpi.h>

#include <tanktread/solver/shell_layout.h>

#include <algorithm>

namespace tanktread
{
  ShellLayout::ShellLayout(const unsigned int n_capsules, const unsigned int n_control_points, const MPI_Comm communicator)
    : n_capsules_(n_capsules)
    , n_control_points_(n_control_points)
    , communicator_(communicator)
    , rank_(dealii::Utilities::MPI::this_mpi_process(communicator))
    , n_ranks_(dealii::Utilities::MPI::n_mpi_processes(communicator))
    , team_(new MPI_Comm(MPI_COMM_NULL), [](MPI_Comm *const team) {
      MPI_Comm_free(team);
      delete team;
    })
  {
    unsigned int first = rank_;
    for (unsigned int c = 0; c < n_capsules; ++c)
      if (works_on(c))
        first = owner(c);
    MPI_Comm_split(communicator, int(first), int(rank_), team_.get());
  }


  unsigned int
  ShellLayout::first_capsule(const unsigned int rank) const
  {
    return (std::size_t(rank) * n_capsules_ + n_ranks_ - 1) / n_ranks_;
  }


  unsigned int
  ShellLayout::owner(const unsigned int c) const
  {
    return std::size_t(c) * n_ranks_ / n_capsules_;
  }


  bool
  ShellLayout::works_on(const unsigned int c) const
  {
    const unsigned int next = c + 1 < n_capsules_ ? std::max(owner(c + 1), owner(c) + 1) : n_ranks_;
    return owner(c) <= rank_ && rank_ < next;
  }


  FluidBlockVector
  ShellLayout::vector(const TaylorHoodSpace &space) const
  {
    const unsigned int n = 1 + 3 * n_control_points_;
    dealii::IndexSet   owned(dealii::types::global_dof_index(n) * n_capsules_);
    owned.add_range(dealii::types::global_dof_index(n) * first_capsule(rank_), dealii::types::global_dof_index(n) * first_capsule(rank_ + 1));
    FluidBlockVector result;
    space.reinit(result, shell_block + 1);
    result.block(shell_block).reinit(owned, communicator_);
    result.collect_sizes();
    return result;
  }


  std::vector<ShellUnknowns>
  ShellLayout::unknowns(const FluidBlockVector &vector) const
  {
    const std::size_t   n     = 1 + 3 * std::size_t(n_control_points_);
    const auto         &block = vector.block(shell_block);
    std::vector<double> values(n * n_capsules_);
    std::copy(block.begin(), block.end(), values.begin() + n * first_capsule(rank_));
    for (unsigned int rank = 0; rank < n_ranks_; ++rank)
      if (const unsigned int first = first_capsule(rank), end = first_capsule(rank + 1); first < end)
        MPI_Bcast(&values[n * first], int(n * (end - first)), MPI_DOUBLE, int(rank), communicator_);
    std::vector<ShellUnknowns> result;
    for (unsigned int c = 0; c < n_capsules_; ++c)
      result.push_back({values[n * c], Eigen::Map<const ControlPoints>(&values[n * c + 1], n_control_points_, 3)});
    return result;
  }


  void
  ShellLayout::set(FluidBlockVector &vector, const unsigned int c, const double pressure_jump, const ControlPoints &density) const
  {
    if (!owns(c))
      return;
    double *const entries = vector.block(shell_block).begin() + (1 + 3 * std::size_t(n_control_points_)) * (c - first_capsule(rank_));
    entries[0]            = pressure_jump;
    std::copy(density.data(), density.data() + density.size(), entries + 1);
  }
} // namespace tanktread
