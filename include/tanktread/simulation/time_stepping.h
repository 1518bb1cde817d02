// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Time", and the time schemes as formulas.

#ifndef tanktread_simulation_time_stepping_h
#define tanktread_simulation_time_stepping_h

#include <tanktread/surface/types.h>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  enum class TimeScheme
  {
    backward_euler,
    bdf2
  };

  /** Section "Time". Times in the scene's unit. */
  struct TimeParameters
  {
    TimeScheme scheme           = TimeScheme::bdf2;
    double     step             = 0.1;
    double     tolerance        = 0.;
    double     steady_tolerance = 0.;

    /** Declares section "Time" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);
  };

  /** One implicit step in the form x = xhat + tau dx/dt(x). */
  struct ImplicitStep
  {
    ControlPoints xhat;
    double        tau;
  };

  /** Backward Euler: xhat = x_n, tau = dt. */
  ImplicitStep
  backward_euler_step(const ControlPoints &x_n, double dt);

  /**
   * BDF2 with variable steps, omega = dt / dt_previous:
   *
   *     xhat = ((1 + omega)^2 x_n - omega^2 x_{n-1}) / (1 + 2 omega),   tau = dt (1 + omega) / (1 + 2 omega).
   */
  ImplicitStep
  bdf2_step(const ControlPoints &x_n, const ControlPoints &x_previous, double dt, double dt_previous);

  /** 1 - 1 / sqrt(2): the implicit part of each stage of SDIRK2, Alexander, SIAM J. Numer. Anal. 14, 1006 (1977). */
  inline constexpr double sdirk2_gamma = 0.29289321881345247560;

  /**
   * SDIRK2, second order from one level and L-stable, by two stages. The first is backward Euler over a part of the step, the second goes on with its velocity
   * U' = dx/dt, given as the displacement d = gamma dt U' that it made:
   *
   *     stage: xhat = x_n,   tau = gamma dt;      step: xhat = x_n + (1 - gamma) / gamma d,   tau = gamma dt.
   */
  ImplicitStep
  sdirk2_stage(const ControlPoints &x_n, double dt);
  ImplicitStep
  sdirk2_step(const ControlPoints &x_n, const ControlPoints &displacement, double dt);
} // namespace tanktread

#endif
