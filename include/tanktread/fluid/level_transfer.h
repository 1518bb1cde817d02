// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of velocities from one rung of the mesh to the next, and its transpose.

#ifndef tanktread_fluid_level_transfer_h
#define tanktread_fluid_level_transfer_h

#include <deal.II/base/aligned_vector.h>

#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/fluid/node_space.h>

#include <functional>

namespace tanktread
{
  /**
   * Rows of the interpolation matrix for the owned nodes of the finer mesh: value = sum of weights times values at nodes of the coarser mesh, given by their
   * global numbers.
   */
  struct InterpolationRows
  {
    std::vector<std::size_t>                     start; // n_owned + 1
    std::vector<dealii::types::global_dof_index> node;
    std::vector<double>                          weight;
    std::vector<dealii::types::global_dof_index>
      parent; // number of the coarser cell, counted over all ranks, that each owned cell of the finer mesh lies in or is
  };

  /**
   * Lets `mesh` climb one rung and returns the interpolation of quadratic or linear fields from the nodes `coarse` of the rung before.
   *
   * Each cell takes along the free nodes that its nodes follow from, p4est brings that to the rank which owns the cell afterwards: the partitions of the two
   * rungs need not match.
   *
   * @param number_fine_nodes called on the new rung, returns its nodes. Collective.
   */
  InterpolationRows
  climb_with_interpolation(FluidMesh &mesh, const NodeSpace &coarse, const std::function<const NodeSpace &()> &number_fine_nodes);

  /** The matrix of InterpolationRows and its transpose on full arrays (see NodeSpace) of velocities; only owned entries are read and written. */
  template <typename Number>
  class LevelTransfer
  {
  public:
    LevelTransfer(const InterpolationRows &rows, const NodeSpace &coarse, const NodeSpace &fine);

    /** fine += P coarse. Collective. */
    void
    prolongate(const Number *coarse, Number *fine) const;

    /** coarse = P^T fine. Collective. */
    void restrict(const Number *fine, Number *coarse) const;

  private:
    unsigned int                                               n_coarse_, n_fine_;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_; // of the coarse nodes that the rows refer to
    std::vector<unsigned int>                                  start_, node_;
    std::vector<Number>                                        weight_;
    mutable dealii::AlignedVector<Number>                      values_, buffer_;
  };
} // namespace tanktread

#endif
