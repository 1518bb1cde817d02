// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the coupling sends to ranks where capsules are guests, and what comes back.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/coupling/coupling.h>

#include <algorithm>
#include <utility>

namespace tanktread
{
  void
  Coupling::evaluate(const ShellConfigurations &shells) const
  {
    on_all_ranks(layout_.communicator(), [&] {
      for (const auto &shell : shells)
        {
          shell->points();
          shell->normal_square();
          if (interface_ == Interface::enriched)
            {
              shell->patches();
              shell->point_areas();
            }
        }
    });
  }


  ShellConfigurations
  Coupling::present_shells(const ShellConfigurations &own, const ShellGuests &guests, const ShellConfigurations &known) const
  {
    const std::vector<unsigned int> &present = guests.present();
    ShellFields                      x;
    std::vector<ShellGuests::Block>  blocks;
    for (const unsigned int c : present)
      x.push_back(ControlPoints::Zero(layout_.capsules()[c].n_control_points(), 3));
    for (unsigned int i = 0; i < own.size(); ++i)
      x[guests.place_of_own(i)] = own[i]->x();
    for (ControlPoints &field : x)
      blocks.push_back({field.data(), std::size_t(field.size())});
    guests.update(blocks);
    ShellConfigurations result(present.size());
    for (unsigned int i = 0; i < own.size(); ++i)
      result[guests.place_of_own(i)] = own[i];
    for (unsigned int p = 0; p < present.size(); ++p)
      if (!result[p])
        {
          const Capsule &capsule = layout_.capsules()[present[p]];
          const auto same = std::find_if(known.begin(), known.end(), [&](const auto &shell) { return &shell->capsule() == &capsule && shell->x() == x[p]; });
          result[p]       = same != known.end() ? *same : std::make_shared<ShellConfiguration>(capsule, std::move(x[p]));
        }
    return result;
  }


  const ShellFields &
  Coupling::at_guests(const ShellFields &own, ShellFields &memory, NumbersOfCapsules *const numbers) const
  {
    // A rank without guests may have capsules that are guests elsewhere.
    const bool                       only_own = guests_.are_none_here();
    const std::vector<unsigned int> &present  = guests_.present();
    std::vector<ShellGuests::Block>  blocks;
    memory.resize(only_own ? 0 : present.size());
    for (unsigned int p = 0; p < memory.size(); ++p)
      memory[p].resize(layout_.capsules()[present[p]].n_control_points(), 3);
    for (unsigned int i = 0; !only_own && i < own.size(); ++i)
      memory[guests_.place_of_own(i)] = own[i];
    for (unsigned int p = 0; p < present.size(); ++p)
      {
        const ControlPoints &field = only_own ? own[p] : memory[p];
        blocks.push_back({const_cast<double *>(field.data()), std::size_t(field.size())}); // fields of own capsules are read only
        if (numbers != nullptr)
          blocks.push_back({(*numbers)[p].data(), (*numbers)[p].size()});
      }
    guests_.update(blocks);
    return only_own ? own : memory;
  }


  void
  Coupling::set_point_forces(const ShellFields &g, std::vector<double> &forces, NumbersOfCapsules *const numbers) const
  {
    const ShellFields &present = at_guests(g, fields_, numbers);
    forces.resize(3 * interpolation_->local_points().size());
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      transfers_[p].set_point_forces(present[p], forces);
  }


  ShellFields
  Coupling::sum_moments(const std::vector<double> &values, std::vector<double> *const fluxes) const
  {
    std::size_t n = 0;
    for (const ShellTransfer &transfer : transfers_)
      n += 3 * std::size_t(transfer.capsule().n_control_points());
    sums_.assign(n, 0.);
    std::vector<ShellGuests::Block> blocks;
    double                         *moments = sums_.data();
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      {
        blocks.push_back({moments, 3 * std::size_t(transfers_[p].capsule().n_control_points())});
        if (fluxes != nullptr)
          blocks.push_back({&(*fluxes)[p], 1});
        transfers_[p].add_moments(values, moments);
        moments += 3 * std::size_t(transfers_[p].capsule().n_control_points());
      }
    guests_.sum(blocks);
    ShellFields result;
    for (unsigned int i = 0; i < shells_.size(); ++i)
      result.push_back(Eigen::Map<const ControlPoints>(blocks[(fluxes == nullptr ? 1 : 2) * guests_.place_of_own(i)].values, shells_[i]->x().rows(), 3));
    return result;
  }
} // namespace tanktread
