// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: flows carried from one mesh to the next.

#ifndef tanktread_fluid_field_transfer_h
#define tanktread_fluid_field_transfer_h

#include <tanktread/fluid/taylor_hood_space.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace tanktread
{
  /**
   * Takes velocities and pressures from a mesh that is about to change and interpolates them at the nodes of the mesh that it becomes, whatever the partitions
   * of the two. Where the
   * old cells are as large as the new ones, or larger, nothing is lost. Every rank knows the owners of all old cells while the object lives.
   */
  class FieldTransfer
  {
  public:
    /** Copies `fields`. Collective. */
    FieldTransfer(const TaylorHoodSpace &space, const std::vector<FluidBlockVector *> &fields);

    /** Sets `fields`, as many and in the same order, to vectors of `space`, on a mesh made of the same box. Collective. */
    void
    interpolate(const TaylorHoodSpace &space, const std::vector<FluidBlockVector *> &fields) const;

  private:
    struct Place
    {
      unsigned int     rank, cell;
      dealii::Point<3> unit;
    };

    /** The old cell that contains a point, and where in it. */
    Place
    locate(const FluidMesh &mesh, const dealii::Point<3> &point) const;

    /** What the fields of one block are at places on this rank, four numbers a place: those of Place but the rank. */
    std::vector<double>
    evaluate(unsigned int block, const std::vector<double> &places) const;

    void
    interpolate_block(unsigned int block, const NodeSpace &nodes, const FluidMesh &mesh, const std::vector<FluidBlockVector *> &fields) const;

    struct Cell
    {
      unsigned int rank, number;
    };

    unsigned int                               finest_;    // level of the old mesh
    std::unordered_map<std::uint64_t, Cell>    cells_;     // by packed key, of all ranks
    std::vector<unsigned int>                  nodes_[2];  // of velocities and pressures: those of each cell of this rank
    std::vector<dealii::AlignedVector<double>> values_[2]; // full array of each field
  };
} // namespace tanktread

#endif
