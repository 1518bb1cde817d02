// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the viscosity of the liquids inside and outside the shell, cell by cell.

#ifndef tanktread_coupling_shell_viscosity_h
#define tanktread_coupling_shell_viscosity_h

#include <tanktread/coupling/surface_distance.h>
#include <tanktread/fluid/viscosity.h>

namespace tanktread
{
  /**
   * Tells the cells inside the shell from those outside. Cells that it cuts, where the distances of the 27 nodes have both signs, have the smaller viscosity
   * and weights for what there is more on the side of the larger one, see inside_weights(). Of the other cells those are inside that the shell's neighbourhood
   * separates from the rest of the box, or whose distances are negative.
   */
  class ShellViscosity
  {
  public:
    /** Keeps `space` by reference. */
    explicit ShellViscosity(const TaylorHoodSpace &space);

    /** 1 outside, `ratio` inside. @param distance from the shell on the mesh of `space`. */
    Viscosity
    operator()(const SurfaceDistance &distance, double ratio) const;

  private:
    struct Cell
    {
      Lattice position; // of the lower corner
      int     size;     // in finest cells
    };

    const TaylorHoodSpace &space_;
    std::vector<Cell>      cells_;
  };
} // namespace tanktread

#endif
