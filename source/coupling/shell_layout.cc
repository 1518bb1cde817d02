// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which ranks hold which capsules, and where the unknowns of each stand in the monolithic vectors.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/shell_layout.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace tanktread
{
  ShellLayout::ShellLayout(const Capsules &capsules, const MPI_Comm communicator, const unsigned int n_teams)
    : capsules_(capsules)
    , communicator_(communicator)
    , rank_(dealii::Utilities::MPI::this_mpi_process(communicator))
    , n_ranks_(dealii::Utilities::MPI::n_mpi_processes(communicator))
    , n_teams_(std::min({n_ranks_, capsules.size(), n_teams == 0 ? n_ranks_ : n_teams}))
    , team_(team_of_rank(rank_))
    , team_size_((team_ + 1 < n_teams_ ? leader(team_ + 1) : n_ranks_) - leader(team_))
  {
    MPI_Comm *const team = new MPI_Comm(MPI_COMM_NULL);
    MPI_Comm_split(communicator, int(team_), int(rank_), team);
    team_communicator_.reset(team, [](const MPI_Comm *const communicator) {
      MPI_Comm copy = *communicator;
      MPI_Comm_free(&copy);
      delete communicator;
    });
    std::vector<unsigned int> by_number;
    for (unsigned int c = 0; c < capsules.size(); ++c)
      by_number.push_back(std::size_t(c) * n_teams_ / capsules.size());
    assign(std::move(by_number));
  }


  unsigned int
  ShellLayout::leader(const unsigned int team) const
  {
    return (std::size_t(team) * n_ranks_ + n_teams_ - 1) / n_teams_;
  }


  unsigned int
  ShellLayout::team_of_rank(const unsigned int rank) const
  {
    return std::size_t(rank) * n_teams_ / n_ranks_;
  }


  void
  ShellLayout::assign(std::vector<unsigned int> team_of)
  {
    if (team_of.size() != capsules_.size())
      throw std::logic_error("ShellLayout: each capsule needs a team.");
    team_of_ = std::move(team_of);
    own_.clear();
    for (unsigned int c = 0; c < team_of_.size(); ++c)
      if (team_of_[c] == team_)
        own_.push_back(c);
  }


  double
  ShellLayout::sum(const double of_own) const
  {
    return dealii::Utilities::MPI::sum(leads() ? of_own : 0., communicator_);
  }


  double
  ShellLayout::max(const double of_own) const
  {
    return dealii::Utilities::MPI::max(leads() ? of_own : -std::numeric_limits<double>::infinity(), communicator_);
  }


  std::vector<double>
  ShellLayout::gathered(const std::vector<double> &of_own, const unsigned int n_each) const
  {
    // Contributions of the leaders, rank by rank, then put where the capsules' numbers say.
    std::vector<int> counts(n_ranks_, 0), starts(n_ranks_, 0);
    for (const unsigned int team : team_of_)
      counts[leader(team)] += n_each;
    for (unsigned int rank = 1; rank < n_ranks_; ++rank)
      starts[rank] = starts[rank - 1] + counts[rank - 1];
    std::vector<double> by_rank(std::size_t(n_each) * n_capsules()), result(by_rank.size());
    MPI_Allgatherv(of_own.data(), counts[rank_], MPI_DOUBLE, by_rank.data(), counts.data(), starts.data(), MPI_DOUBLE, communicator_);
    for (unsigned int c = 0; c < n_capsules(); ++c)
      {
        int &start = starts[leader(team_of_[c])];
        std::copy_n(&by_rank[start], n_each, &result[std::size_t(n_each) * c]);
        start += int(n_each);
      }
    return result;
  }


  void
  ShellLayout::share(double *const values, const std::size_t n) const
  {
    if (!is_team_of_one())
      MPI_Bcast(values, int(n), MPI_DOUBLE, 0, team());
  }


  std::size_t
  ShellLayout::first_entry(const unsigned int i) const
  {
    std::size_t result = 0;
    for (unsigned int j = 0; j < i; ++j)
      result += 1 + 3 * std::size_t(capsule(j).n_control_points());
    return result;
  }


  FluidBlockVector
  ShellLayout::vector(const TaylorHoodSpace &space) const
  {
    using Index       = dealii::types::global_dof_index;
    const Index n_own = leads() ? first_entry(this->n_own()) : 0, n = capsules_.size() + 3 * capsules_.n_control_points();
    Index       before = 0;
    MPI_Exscan(&n_own, &before, 1, DEAL_II_DOF_INDEX_MPI_TYPE, MPI_SUM, communicator_);
    dealii::IndexSet owned(n);
    owned.add_range(rank_ == 0 ? 0 : before, (rank_ == 0 ? 0 : before) + n_own);
    FluidBlockVector result;
    space.reinit(result, shell_block + 1);
    result.block(shell_block).reinit(owned, communicator_);
    result.collect_sizes();
    return result;
  }


  std::vector<ShellUnknowns>
  ShellLayout::unknowns(const FluidBlockVector &vector) const
  {
    const auto         &block = vector.block(shell_block);
    std::vector<double> values(first_entry(n_own()));
    std::copy(block.begin(), block.begin() + block.locally_owned_size(), values.begin());
    share(values.data(), values.size());
    std::vector<ShellUnknowns> result;
    const double              *entries = values.data();
    for (unsigned int i = 0; i < n_own(); ++i)
      {
        const Eigen::Index n = capsule(i).n_control_points();
        result.push_back({entries[0], Eigen::Map<const ControlPoints>(entries + 1, n, 3)});
        entries += 1 + 3 * n;
      }
    return result;
  }


  void
  ShellLayout::set(FluidBlockVector &vector, const unsigned int i, const double pressure_jump, const ControlPoints &density) const
  {
    if (!leads())
      return;
    double *const entries = vector.block(shell_block).begin() + first_entry(i);
    entries[0]            = pressure_jump;
    std::copy(density.data(), density.data() + density.size(), entries + 1);
  }
} // namespace tanktread
