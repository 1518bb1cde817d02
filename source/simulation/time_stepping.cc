// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Time".

#include <tanktread/base/enum_parameter.h>
#include <tanktread/simulation/time_stepping.h>

namespace tanktread
{
  void
  TimeParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Time");
    add_enum_parameter(
      prm,
      "Scheme",
      scheme,
      {{"BDF2", TimeScheme::bdf2},
       {"BDF3", TimeScheme::bdf3},
       {"SDIRK2", TimeScheme::sdirk2},
       {"SDIRK3", TimeScheme::sdirk3},
       {"backward Euler", TimeScheme::backward_euler}},
      "BDF2, BDF3: second and third order, one solution a step, started by steps of SDIRK2 or SDIRK3; SDIRK2, SDIRK3: second and third order, two "
      "and three solutions a step; backward Euler: first order.");
    prm.add_parameter(
      "Step",
      step,
      "Length of a time step, in the scene's unit of time; with a tolerance the largest length. A step that fails is tried with half its length.",
      Double(1e-8, 1e3));
    prm.add_parameter("Tolerance",
                      tolerance,
                      "Largest local error of a step, root mean square over the shell's control points, in a; 0: all steps have length Step.",
                      Double(0., 1.));
    prm.add_parameter("Steady tolerance",
                      steady_tolerance,
                      "The run ends when semi-axes (in a) and inclination (in radians) change slower than this per unit of time; 0: at the end time only.",
                      Double(0., 1.));
    prm.add_parameter(
      "Limit tolerance",
      limit_tolerance,
      "The run ends when the shape that it relaxes to is known, by extrapolation, to this: error bars of D, L, B and W relative, of theta / pi absolute; "
      "0: not for this.",
      Double(0., 1.));
    prm.leave_subsection();
  }
} // namespace tanktread
