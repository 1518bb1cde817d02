// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Time".

#ifndef tanktread_simulation_time_stepping_h
#define tanktread_simulation_time_stepping_h

#include <tanktread/simulation/time_schemes.h>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Section "Time". Times in the scene's unit. */
  struct TimeParameters
  {
    TimeScheme scheme           = TimeScheme::bdf3;
    double     step             = 0.1;
    double     tolerance        = 0.;
    double     steady_tolerance = 0.;
    double     limit_tolerance  = 0.;

    /** Declares section "Time" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace tanktread

#endif
