// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules on ranks that do not hold them but have cells of the fluid near them.

#ifndef tanktread_coupling_shell_guests_h
#define tanktread_coupling_shell_guests_h

#include <tanktread/coupling/shell_layout.h>
#include <tanktread/fluid/fluid_mesh.h>

#include <cstddef>
#include <map>
#include <vector>

namespace tanktread
{
  /**
   * Each rank has its own capsules, and as guests those of other teams that are within two finest cells of its part of the fluid: all that has points of the
   * coupling in cells of this rank, or cuts such cells, is present. What belongs to a capsule goes from its leader to the ranks where it is a guest, and sums over its
   * points in the fluid go back, by messages between these ranks alone.
   */
  class ShellGuests
  {
  public:
    /** No guests anywhere. Keeps `layout` by reference. */
    explicit ShellGuests(const ShellLayout &layout);

    /** Finds out who is a guest where, by the points of the rank's own shells. Collective. Throws NumericalError on all ranks if a point is out of the box. */
    void
    find(const FluidMesh &mesh, const ShellConfigurations &own);

    /** Own capsules without guests anywhere, as when ShellLayout::assign() has given capsules to other teams. */
    void
    clear();

    /** Numbers of the capsules that are present on this rank, in order. */
    const std::vector<unsigned int> &
    present() const
    {
      return present_;
    }
    /** Place of the i-th own capsule among the present ones. */
    unsigned int
    place_of_own(const unsigned int i) const
    {
      return places_of_own_[i];
    }
    bool
    are_none_here() const
    {
      return present_.size() == places_of_own_.size();
    }

    /** Numbers that belong to one of the present capsules; as many wherever it is present. */
    struct Block
    {
      double     *values;
      std::size_t size;
    };

    /** Blocks of guests become those of their leaders. @param blocks the same number for each of the present capsules, one capsule after the other. Collective. */
    void
    update(const std::vector<Block> &blocks) const;

    /** Blocks of own capsules become the sums over all ranks where these are present; those of guests are left as they are. Collective. */
    void
    sum(const std::vector<Block> &blocks) const;

  private:
    /** For each rank, places of the capsules among the present ones that are sent to it or come from it. */
    using Partners = std::map<unsigned int, std::vector<unsigned int>>;

    void
    exchange(const Partners &to, const Partners &from, const std::vector<Block> &blocks, bool add) const;
    void
    sum_in_team(const std::vector<Block> &blocks) const;
    std::size_t
    size(const std::vector<unsigned int> &places, const std::vector<Block> &blocks) const;

    const ShellLayout                                  &layout_;
    std::vector<unsigned int>                           present_, places_of_own_;
    Partners                                            hosts_, leaders_; // of own capsules elsewhere, of guests here
    mutable std::map<unsigned int, std::vector<double>> sent_, received_; // memory of the calls
  };
} // namespace tanktread

#endif
