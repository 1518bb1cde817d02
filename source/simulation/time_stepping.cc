// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Time", and the time schemes as formulas.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/simulation/time_stepping.h>

namespace tanktread
{
  void
  TimeParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Time");
    add_enum_parameter(prm,
                       "Scheme",
                       scheme,
                       {{"BDF2", TimeScheme::bdf2}, {"backward Euler", TimeScheme::backward_euler}},
                       "BDF2: second order, variable steps, started by one of SDIRK2, which is solved in two stages; backward Euler: first order.");
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
    prm.leave_subsection();
  }


  ImplicitStep
  backward_euler_step(const ControlPoints &x_n, const double dt)
  {
    return {x_n, dt};
  }


  ImplicitStep
  bdf2_step(const ControlPoints &x_n, const ControlPoints &x_previous, const double dt, const double dt_previous)
  {
    const double omega = dt / dt_previous, denominator = 1. + 2. * omega;
    return {((1. + omega) * (1. + omega) * x_n - omega * omega * x_previous) / denominator, dt * (1. + omega) / denominator};
  }


  ImplicitStep
  sdirk2_stage(const ControlPoints &x_n, const double dt)
  {
    return backward_euler_step(x_n, sdirk2_gamma * dt);
  }


  ImplicitStep
  sdirk2_step(const ControlPoints &x_n, const ControlPoints &displacement, const double dt)
  {
    return {x_n + (1. - sdirk2_gamma) / sdirk2_gamma * displacement, sdirk2_gamma * dt};
  }
} // namespace tanktread
