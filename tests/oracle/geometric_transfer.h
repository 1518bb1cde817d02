// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation between two meshes by deal.II, what the own one is compared with.

#ifndef tanktread_oracle_geometric_transfer_h
#define tanktread_oracle_geometric_transfer_h

#include <tanktread/fluid/taylor_hood_space.h>

namespace tanktread::oracle
{
  /**
   * Interpolates a condensed vector of one mesh to the next finer one with MGTwoLevelTransfer; constrained entries of the result are resolved.
   *
   * @param u in deal.II's numbering, constrained entries zero. Collective.
   */
  FluidVector
  prolongated(const ScalarSpace &coarse, const ScalarSpace &fine, const FluidVector &u);
} // namespace tanktread::oracle

#endif
