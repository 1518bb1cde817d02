// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: places in full arrays for deal.II's degrees of freedom.

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_tools.h>

#include <tanktread/fluid/node_numbering.h>

#include <algorithm>

namespace tanktread
{
  using Index = dealii::types::global_dof_index;

  std::vector<Index>
  lexicographic_dofs(const dealii::DoFHandler<3> &dofs)
  {
    const auto        &fe    = dofs.get_fe();
    const auto         order = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(fe.degree);
    std::vector<Index> cell_dofs(fe.n_dofs_per_cell()), result;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(cell_dofs);
          for (const unsigned int i : order)
            result.push_back(cell_dofs[i]);
        }
    return result;
  }


  NodeNumbering::NodeNumbering(const ScalarSpace &space, const std::vector<Index> &cell_dofs)
    : constraints_(space.constraints())
    , owned_dofs_(space.partitioner()->locally_owned_range())
    , number_(space.partitioner())
    , place_(space.partitioner()->locally_owned_size() + space.partitioner()->n_ghost_indices(), unknown)
  {
    number_owned(cell_dofs, space.partitioner()->get_mpi_communicator());
    find_ghosts(cell_dofs);
  }


  unsigned int
  NodeNumbering::place(const Index dof)
  {
    if (!constraints_.is_constrained(dof))
      return free_place(dof);
    const auto &entries = *constraints_.get_constraint_entries(dof);
    if (entries.empty())
      return unknown;
    if (entries.size() == 1 && entries.front().second == 1.)
      return free_place(entries.front().first);
    unsigned int &result = place_[number_.get_partitioner()->global_to_local(dof)];
    if (result == unknown)
      {
        result = n_owned + ghosts.size() + row_start.size() - 1;
        for (const auto &[master, weight] : entries)
          masters.push_back({free_place(master), static_cast<float>(weight)});
        row_start.push_back(masters.size());
      }
    return result;
  }


  void
  NodeNumbering::number_owned(const std::vector<Index> &cell_dofs, const MPI_Comm communicator)
  {
    number_ = -1.;
    // In its own cells every owned degree of freedom occurs; those seen through constraints only may belong to others.
    for (const Index dof : cell_dofs)
      if (!constraints_.is_constrained(dof) && owned_dofs_.is_element(dof))
        {
          unsigned int &p = place_[number_.get_partitioner()->global_to_local(dof)];
          if (p == unknown)
            p = n_owned++;
        }
    const Index n = n_owned;
    n_global      = dealii::Utilities::MPI::sum(n, communicator);
    MPI_Exscan(&n, &first_owned, 1, DEAL_II_DOF_INDEX_MPI_TYPE, MPI_SUM, communicator);
    for (unsigned int i = 0; i < number_.locally_owned_size(); ++i)
      if (place_[i] != unknown)
        number_.local_element(i) = first_owned + place_[i];
    number_.update_ghost_values();
  }


  void
  NodeNumbering::find_ghosts(const std::vector<Index> &cell_dofs)
  {
    const auto add = [&](const Index dof) {
      if (!owned_dofs_.is_element(dof))
        ghosts.push_back(number_(dof));
    };
    for (const Index dof : cell_dofs)
      if (!constraints_.is_constrained(dof))
        add(dof);
      else
        for (const auto &entry : *constraints_.get_constraint_entries(dof))
          add(entry.first);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  }


  unsigned int
  NodeNumbering::free_place(const Index dof)
  {
    unsigned int &p = place_[number_.get_partitioner()->global_to_local(dof)];
    if (p == unknown)
      p = n_owned + (std::lower_bound(ghosts.begin(), ghosts.end(), Index(number_(dof))) - ghosts.begin());
    return p;
  }
} // namespace tanktread
