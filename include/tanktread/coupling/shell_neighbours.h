// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how near the shells of a scene come to each other, whichever ranks hold them.

#ifndef tanktread_coupling_shell_neighbours_h
#define tanktread_coupling_shell_neighbours_h

#include <tanktread/coupling/shell_layout.h>
#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/shell/gaps.h>
#include <tanktread/shell/shell_box.h>

#include <array>
#include <vector>

namespace tanktread
{
  /** Boxes about the points of all shells of the scene, by the capsules' numbers, the same on all ranks. Collective. */
  std::vector<ShellBox>
  boxes_of_all(const ShellLayout &layout, const ShellConfigurations &own);

  /** The shells of the capsules with these numbers, from the ranks that hold them. @param own the rank's own shells. Collective. */
  ShellConfigurations
  shells_of_others(const ShellLayout &layout, const ShellConfigurations &own, const std::vector<unsigned int> &numbers);

  /** Shells and the numbers of their capsules. */
  struct NumberedShells
  {
    std::vector<unsigned int> numbers;
    ShellConfigurations       shells;
  };

  /** All shells that may be about cells of this rank or cut them, whoever holds them: those whose boxes meet the box about the rank's cells. Collective. */
  NumberedShells
  shells_about_cells(const ShellLayout &layout, const ShellConfigurations &own, const FluidMesh &mesh);

  /**
   * smallest_gap() of all shells of a scene, capsules told by their numbers. A rank asks for the shells whose boxes are near those of its own ones. The same on all ranks. Collective.
   */
  ShellGap
  smallest_gap(const ShellLayout &layout, const ShellConfigurations &own, const std::array<double, 3> &periods, double reach);
} // namespace tanktread

#endif
