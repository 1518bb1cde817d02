// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the viscosity of the liquids inside and outside all shells, cell by cell.

#ifndef tanktread_coupling_shell_viscosity_h
#define tanktread_coupling_shell_viscosity_h

#include <tanktread/coupling/surface_distance.h>
#include <tanktread/fluid/cell_weights.h>
#include <tanktread/fluid/viscosity.h>
#include <tanktread/shell/shell_configuration.h>

#include <map>
#include <unordered_map>
#include <vector>

namespace tanktread
{
  /**
   * Tells the cells inside shells from those outside. Cells that a shell cuts, where the distances of the 27 nodes have both signs, have the smaller viscosity
   * and weights for what there is more on the side of the larger one, see inside_weights(). Of the other cells those are inside that the shell's neighbourhood
   * separates from the rest of the box, or whose distances are negative. Insides do not overlap: where two shells cut a cell their weights add.
   *
   * Each shell goes down the octree to the cells in the box about it: time goes with the cells near and inside shells.
   */
  class ShellViscosity
  {
  public:
    /** Keeps `space` by reference. */
    explicit ShellViscosity(const TaylorHoodSpace &space);

    /** 1 outside, `ratio` inside. Coupling surfaces need second derivatives. */
    Viscosity
    operator()(const ShellConfigurations &shells, double ratio) const;

  private:
    struct Cell
    {
      Lattice      position; // of the lower corner
      int          size;     // in finest cells
      unsigned int number;   // among this rank's cells
    };

    /** What lies inside shells. */
    struct Parts
    {
      std::vector<char>                   is_inside; // all of a cell
      std::map<unsigned int, CellWeights> inside;    // of cells that are cut
    };

    /** Of nodes near a shell. */
    using Distances = std::unordered_map<unsigned int, double>;

    using CellIterator = dealii::Triangulation<3>::cell_iterator;

    void
    add_shell(const SurfaceDistance &distance, Parts &parts) const;
    /** Appends this rank's active cells within `cell` that overlap the box about the cells near the shell. */
    void
    find_cells(const CellIterator &cell, const SurfaceDistance &distance, std::vector<Cell> &cells) const;
    /** The image of a finest cell that may be near the shell or inside. */
    Lattice
    image(Lattice cell, const SurfaceDistance &distance) const;
    Side
    side(const Cell &cell, const SurfaceDistance &distance, const CellSides &sides) const;
    /** @param centre image of the finest cell at its centre. */
    void
    add_near_cell(const Cell &cell, const Lattice &centre, const SurfaceDistance &distance, Distances &phi, Parts &parts) const;

    const TaylorHoodSpace    &space_;
    std::vector<unsigned int> number_; // of each active cell among those of this rank
  };
} // namespace tanktread

#endif
