// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the two ways in which fluid and shell see each other.

#ifndef tanktread_coupling_interface_h
#define tanktread_coupling_interface_h

namespace tanktread
{
  /** How the discrete fluid sees the shell's forces. */
  enum class Interface
  {
    plain,   // finite-element consistent spreading, first order
    enriched // with the kink of the velocity and the jump of the pressure in the cells that the shell cuts, second order; see JumpEnrichment
  };
} // namespace tanktread

#endif
