// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: values at nodes, told by places that any division of the mesh among ranks has.

#ifndef tanktread_fluid_placed_values_h
#define tanktread_fluid_placed_values_h

#include <tanktread/fluid/taylor_hood_space.h>

#include <cstdint>
#include <vector>

namespace tanktread
{
  /**
   * Places of the owned nodes of `nodes`, one of the node spaces of `space`, in their order: numbers that are the same on whatever rank the node is. Positions in halves of the finest
   * cells, wrapped along periodic axes, 21 bits an axis.
   */
  std::vector<std::uint64_t>
  places_of_nodes(const TaylorHoodSpace &space, const NodeSpace &nodes);

  /** Numbers at places, n for each. A place may be known to several ranks, with the same numbers. */
  struct PlacedValues
  {
    std::vector<std::uint64_t> places;
    std::vector<double>        values;
  };

  /**
   * The numbers at the wanted places, of whichever rank knows them; places and numbers meet on ranks that the places alone decide on. Throws NumericalError, on all ranks, if nobody knows a place.
   * @param n numbers a place. Collective.
   */
  std::vector<double>
  values_at(const std::vector<std::uint64_t> &wanted, const PlacedValues &known, unsigned int n, MPI_Comm communicator);
} // namespace tanktread

#endif
