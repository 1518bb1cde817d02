// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Fluid mesh" of the parameter file.

#include <deal.II/base/parameter_handler.h>

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/fluid_mesh_parameters.h>

#include <sstream>

namespace tanktread
{
  void
  FluidMeshParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::Integer;
    prm.enter_subsection("Fluid mesh");
    prm.add_parameter("Finest cell",
                      finest_cell,
                      "Side of the cells at the shell, in a; the mesh takes the next smaller side its octree has.",
                      Double(1e-4, 10.));
    prm.add_parameter("Coarsest cell", coarsest_cell, "Side of the cells away from the shell, in a; adjusted to divide the box.", Double(1e-4, 100.));
    prm.add_parameter("Band width", band_width, "Distance from the shell within which cells are finest ones, in finest cells.", Double(1., 20.));
    prm.add_parameter(
      "Grading",
      grading,
      "Distance from the shell within which cells of any larger size are not larger, in cells of that size; 0: they grow as fast as 2:1 balance lets them.",
      Integer(0, 16));
    add_enum_parameter(prm,
                       "Pressure space",
                       pressure_space,
                       {{"Q1", PressureSpace::q1}},
                       "Q1: continuous trilinear functions and the indicator of the capsule's interior.");
    prm.leave_subsection();
  }


  void
  FluidMeshParameters::check(const double box_side) const
  {
    std::ostringstream message;
    if (coarsest_cell > 0.5 * box_side)
      message << "Fluid mesh/Coarsest cell is " << coarsest_cell << "; allowed: at most half of Scene/Box side, " << 0.5 * box_side << '.';
    else if (coarsest_cell < box_side / 64.)
      message << "Fluid mesh/Coarsest cell is " << coarsest_cell << "; allowed: at least 1/64 of Scene/Box side, " << box_side / 64.
              << " (only the neighbourhood of the shell needs small cells).";
    else if (finest_cell > coarsest_cell)
      message << "Fluid mesh/Finest cell is " << finest_cell << "; allowed: at most Fluid mesh/Coarsest cell, " << coarsest_cell << '.';
    else if (box_side / finest_cell > 1 << 18)
      message << "Fluid mesh/Finest cell is " << finest_cell << "; allowed: at least " << box_side / (1 << 18) << " in this box.";
    if (!message.str().empty())
      throw InputError(message.str());
  }
} // namespace tanktread
