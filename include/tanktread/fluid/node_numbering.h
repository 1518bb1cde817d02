// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: places in full arrays for deal.II's degrees of freedom.

#ifndef tanktread_fluid_node_numbering_h
#define tanktread_fluid_node_numbering_h

#include <tanktread/fluid/node_space.h>
#include <tanktread/fluid/taylor_hood_space.h>

#include <limits>
#include <vector>

namespace tanktread
{
  /** Degrees of freedom of all locally owned cells, one cell after the other, each in lexicographic order. */
  std::vector<dealii::types::global_dof_index>
  lexicographic_dofs(const dealii::DoFHandler<3> &dofs);

  /** Numbers the free nodes of a space and collects places in full arrays (see NodeSpace) while the cells are walked through. */
  class NodeNumbering
  {
  public:
    using Index = dealii::types::global_dof_index;

    static constexpr unsigned int unknown = std::numeric_limits<unsigned int>::max();

    /** @param cell_dofs those of lexicographic_dofs(). Keeps `space` by reference. Collective. */
    NodeNumbering(const ScalarSpace &space, const std::vector<Index> &cell_dofs);

    /** Place of a degree of freedom, which gets a row of masters if it needs one; `unknown` for a node that is zero. */
    unsigned int
    place(Index dof);

    Index                          first_owned = 0, n_global = 0;
    unsigned int                   n_owned = 0;
    std::vector<Index>             ghosts;       // global numbers, sorted
    std::vector<unsigned int>      row_start{0}; // of `masters`, one row for each node that has several
    std::vector<NodeSpace::Master> masters;

  private:
    void
    number_owned(const std::vector<Index> &cell_dofs, MPI_Comm communicator);
    void
    find_ghosts(const std::vector<Index> &cell_dofs);
    unsigned int
    free_place(Index dof);

    const dealii::AffineConstraints<double> &constraints_;
    const dealii::IndexSet                  &owned_dofs_;
    FluidVector                              number_; // global, exact as doubles; -1 where there is none
    std::vector<unsigned int>                place_;  // of local degrees of freedom
  };
} // namespace tanktread

#endif
