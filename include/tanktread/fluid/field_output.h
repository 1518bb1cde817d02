// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the fluid's fields as VTU.

#ifndef tanktread_fluid_field_output_h
#define tanktread_fluid_field_output_h

#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <functional>
#include <string>

namespace tanktread
{
  /**
   * Writes velocity (disturbance plus undisturbed flow), pressure (the continuous field plus `further_pressure` at each node) and the rank of each cell to
   * `<folder>/<name>_<counter>.pvtu` and a piece for each rank, `<name>_<counter>.<rank>.vtu`; cells are drawn with their quadratic velocity as 2 x 2 x 2
   * linear ones. Files
   * appear under their names only when they are complete.
   *
   * @param further_pressure function of position, not smooth in general: that of the capsule's interior. @param fields as in State::fluid. Collective.
   * @return name of the PVTU file, without the folder.
   * @throws OutputError on all ranks when a file cannot be written on one of them.
   */
  std::string
  write_fluid_fields(const std::string                                     &folder,
                     const std::string                                     &name,
                     unsigned int                                           counter,
                     const TaylorHoodSpace                                 &space,
                     const FluidBlockVector                                &fields,
                     const UndisturbedFlow                                 &undisturbed,
                     const std::function<double(const dealii::Point<3> &)> &further_pressure);
} // namespace tanktread

#endif
