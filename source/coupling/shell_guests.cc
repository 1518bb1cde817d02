// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules on ranks that do not hold them but have cells of the fluid near them.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/shell_guests.h>

#include <algorithm>
#include <numeric>

namespace tanktread
{
  namespace
  {
    constexpr int message_tag = 7714;

    std::vector<dealii::Point<3>>
    points_of(const ShellConfiguration &shell)
    {
      const ControlPoints          &X = shell.points();
      std::vector<dealii::Point<3>> result;
      result.reserve(X.rows());
      for (Eigen::Index q = 0; q < X.rows(); ++q)
        result.emplace_back(X(q, 0), X(q, 1), X(q, 2));
      return result;
    }
  } // namespace


  ShellGuests::ShellGuests(const ShellLayout &layout)
    : layout_(layout)
  {
    clear();
  }


  void
  ShellGuests::clear()
  {
    hosts_.clear();
    leaders_.clear();
    present_ = layout_.own();
    places_of_own_.resize(present_.size());
    std::iota(places_of_own_.begin(), places_of_own_.end(), 0u);
  }


  void
  ShellGuests::find(const FluidMesh &mesh, const ShellConfigurations &own)
  {
    clear();
    if (layout_.n_teams() == 1)
      return; // all ranks hold all capsules
    std::vector<std::vector<dealii::Point<3>>> points;
    for (unsigned int i = 0; layout_.leads() && i < own.size(); ++i)
      points.push_back(points_of(*own[i]));
    std::map<unsigned int, std::vector<unsigned int>> numbers_for; // of own capsules, for each rank that is to have them as guests
    const auto                                        ranks = mesh.ranks_near(points);
    for (unsigned int i = 0; i < ranks.size(); ++i)
      for (const unsigned int rank : ranks[i])
        if (layout_.team_of_rank(rank) != layout_.team_of(layout_.own()[i]))
          {
            numbers_for[rank].push_back(layout_.own()[i]);
            hosts_[rank].push_back(i);
          }
    const auto numbers_from = dealii::Utilities::MPI::some_to_some(layout_.communicator(), numbers_for);
    for (const auto &[rank, numbers] : numbers_from)
      present_.insert(present_.end(), numbers.begin(), numbers.end());
    std::sort(present_.begin(), present_.end());
    const auto place = [&](const unsigned int number) -> unsigned int { return std::lower_bound(present_.begin(), present_.end(), number) - present_.begin(); };
    for (unsigned int i = 0; i < places_of_own_.size(); ++i)
      places_of_own_[i] = place(layout_.own()[i]);
    for (auto &[rank, places] : hosts_)
      for (unsigned int &i : places)
        i = places_of_own_[i];
    for (const auto &[rank, numbers] : numbers_from)
      for (const unsigned int number : numbers)
        leaders_[rank].push_back(place(number));
  }


  std::size_t
  ShellGuests::size(const std::vector<unsigned int> &places, const std::vector<Block> &blocks) const
  {
    const std::size_t n_each = present_.empty() ? 0 : blocks.size() / present_.size();
    std::size_t       result = 0;
    for (const unsigned int place : places)
      for (std::size_t k = 0; k < n_each; ++k)
        result += blocks[n_each * place + k].size;
    return result;
  }


  void
  ShellGuests::exchange(const Partners &to, const Partners &from, const std::vector<Block> &blocks, const bool add) const
  {
    const std::size_t        n_each = present_.empty() ? 0 : blocks.size() / present_.size();
    std::vector<MPI_Request> requests;
    requests.reserve(to.size() + from.size());
    for (const auto &[rank, places] : from)
      {
        std::vector<double> &buffer = received_[rank];
        buffer.resize(size(places, blocks));
        requests.emplace_back();
        MPI_Irecv(buffer.data(), int(buffer.size()), MPI_DOUBLE, int(rank), message_tag, layout_.communicator(), &requests.back());
      }
    for (const auto &[rank, places] : to)
      {
        std::vector<double> &buffer = sent_[rank];
        buffer.clear();
        for (const unsigned int place : places)
          for (std::size_t k = 0; k < n_each; ++k)
            buffer.insert(buffer.end(), blocks[n_each * place + k].values, blocks[n_each * place + k].values + blocks[n_each * place + k].size);
        requests.emplace_back();
        MPI_Isend(buffer.data(), int(buffer.size()), MPI_DOUBLE, int(rank), message_tag, layout_.communicator(), &requests.back());
      }
    MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    for (const auto &[rank, places] : from) // in the order of ranks: sums are the same whoever came first
      {
        const double *value = received_[rank].data();
        for (const unsigned int place : places)
          for (std::size_t k = 0; k < n_each; ++k)
            for (std::size_t i = 0; i < blocks[n_each * place + k].size; ++i, ++value)
              if (add)
                blocks[n_each * place + k].values[i] += *value;
              else
                blocks[n_each * place + k].values[i] = *value;
      }
  }


  void
  ShellGuests::update(const std::vector<Block> &blocks) const
  {
    exchange(hosts_, leaders_, blocks, false);
  }


  void
  ShellGuests::sum(const std::vector<Block> &blocks) const
  {
    exchange(leaders_, hosts_, blocks, true);
    sum_in_team(blocks);
  }


  void
  ShellGuests::sum_in_team(const std::vector<Block> &blocks) const
  {
    if (layout_.is_team_of_one())
      return;
    const std::size_t    n_each = present_.empty() ? 0 : blocks.size() / present_.size();
    std::vector<double> &all    = sent_[layout_.rank()];
    all.clear();
    for (const unsigned int place : places_of_own_)
      for (std::size_t k = n_each * place; k < n_each * (place + 1); ++k)
        all.insert(all.end(), blocks[k].values, blocks[k].values + blocks[k].size);
    MPI_Allreduce(MPI_IN_PLACE, all.data(), int(all.size()), MPI_DOUBLE, MPI_SUM, layout_.team());
    const double *value = all.data();
    for (const unsigned int place : places_of_own_)
      for (std::size_t k = n_each * place; k < n_each * (place + 1); value += blocks[k++].size)
        std::copy_n(value, blocks[k].size, blocks[k].values);
  }
} // namespace tanktread
