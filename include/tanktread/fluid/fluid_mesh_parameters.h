// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Fluid mesh" of the parameter file.

#ifndef tanktread_fluid_fluid_mesh_parameters_h
#define tanktread_fluid_fluid_mesh_parameters_h

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

    /** Declares section "Fluid mesh" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** Throws InputError when the cells do not fit into a box of side `box_side`. */
    void
    check(double box_side) const;
  };
} // namespace tanktread

#endif
