// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how much of a shell the enriched interface sees.

#ifndef tanktread_coupling_interface_quality_h
#define tanktread_coupling_interface_quality_h

#include <tanktread/coupling/coupling.h>

#include <vector>

namespace tanktread
{
  /** Shares of a shell's area. */
  struct InterfaceQuality
  {
    double without_jumps = 0.; // in cells that have no kink and jump although points of the shell lie in them
    double folded        = 0.; // in cells where the shell turns so far that its mean normal is shorter than 1/2: two sheets, or an edge
  };

  /**
   * A cell has kink and jump where the shell separates its 27 nodes. Points in other cells are those of a shell that only grazes a cell between its nodes, of a thin part between nodes, or in a cell that is
   * not a finest one. Of each of the rank's own shells; zero before they have been moved, and with the plain interface. Collective.
   */
  std::vector<InterfaceQuality>
  interface_quality(const Coupling &coupling);
} // namespace tanktread

#endif
