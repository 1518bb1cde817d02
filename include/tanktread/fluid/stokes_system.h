// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a linear solver has to know of the discrete Stokes equations.

#ifndef tanktread_fluid_stokes_system_h
#define tanktread_fluid_stokes_system_h

#include <tanktread/fluid/types.h>

namespace tanktread
{
  struct TaylorHoodSpace;
  class Timings;

  /** The discrete Stokes equations as a linear map, whatever it is computed with. */
  class StokesMap
  {
  public:
    virtual ~StokesMap() = default;

    /** dst = [A, -B^T; -B, 0] src on blocks 0 and 1; blocks from 2 on are not touched. Collective. */
    virtual void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const = 0;
  };

  /** About the inverse of that, to precondition it. */
  class StokesInverse
  {
  public:
    virtual ~StokesInverse() = default;

    /** dst = P^{-1} src on blocks 0 and 1. Collective. @param timings where to add what its parts take, or null. */
    virtual void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src, Timings *timings = nullptr) const = 0;

    virtual const TaylorHoodSpace &
    space() const = 0;
  };
} // namespace tanktread

#endif
