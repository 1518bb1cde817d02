// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where results go and how often.

#ifndef tanktread_simulation_output_parameters_h
#define tanktread_simulation_output_parameters_h

#include <set>
#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Section "Output". Intervals in units of time of the scene. */
  struct OutputParameters
  {
    std::string directory;                // empty: output/<name of the parameter file>, filled in by read_parameters()
    double      history_interval    = 0.; // 0: each step
    double      field_interval      = 1.; // 0: first and last only
    double      checkpoint_interval = 0.; // 0: none

    double checkpoint_wall_interval = 1800.; // in seconds; 0: none

    unsigned int surface_subdivisions = 2; // n: 4^n triangles for each face of the control mesh

    std::set<double> contour_times;

    /** Declares section "Output" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace tanktread

#endif
