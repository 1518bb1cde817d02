// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Fluid mesh" of the parameter file.

#ifndef tanktread_fluid_fluid_mesh_parameters_h
#define tanktread_fluid_fluid_mesh_parameters_h

#include <tanktread/fluid/box.h>

#include <array>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Pressure functions of the Taylor-Hood pair besides the indicator of the capsule's interior. */
  enum class PressureSpace
  {
    q1
  };

  /** Section "Fluid mesh". Lengths in a. */
  struct FluidMeshParameters
  {
    double       finest_cell   = 0.15625;
    double       coarsest_cell = 2.5;
    double       band_width    = 1.5;
    unsigned int grading       = 0; // cells of each larger size between the shell and where the next size may begin

    PressureSpace pressure_space = PressureSpace::q1;

    double finest_in_gaps = 0.; // how small finest cells may become for films; 0, or finest_cell and more: they stay as they are

    /** Declares section "Fluid mesh" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** Throws InputError when the cells do not fit into the box, or the box is not one that divide() can divide. */
    void
    check(const Box &box) const;
  };

  /** The cubes that a box is divided into: n_rung_0 along each axis on the first rung of the mesh, and each of those coarsest_level times into eight. */
  struct BoxDivision
  {
    std::array<int, 3> n_rung_0;
    unsigned int       coarsest_level;
  };

  /**
   * Cubes of about the size `coarsest_cell` that fill a box, one or more along each axis and two or more along a periodic one, where none may be its own
   * neighbour. Of the sizes up to sqrt(2) times larger or smaller than asked for it takes the one nearest to it (on a logarithmic scale, in octaves), 1024
   * cubes on the first rung counting like an octave: the direct solver there wants few, so their number should be divisible by two as often as may be. They are
   * halved until no axis has more than four.
   *
   * Throws InputError if no size will do, and if the box is periodic along all axes: nothing would hold the liquid then.
   */
  BoxDivision
  divide(const Box &box, double coarsest_cell);
} // namespace tanktread

#endif
