// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Study", coarser companions of a run that tell its errors.

#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/study_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    const std::vector<std::string> words = {"mesh", "cells", "control mesh", "step", "box", "stop", "tolerances", "target"}; // in the order of Cause
  }


  const std::string &
  word(const Cause cause)
  {
    return words[static_cast<std::size_t>(cause)];
  }


  void
  StudyParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    std::string selection;
    for (const std::string &cause : words)
      selection += (selection.empty() ? "" : "|") + cause;
    prm.enter_subsection("Study");
    prm.add_parameter(
      "Vary",
      vary,
      "Causes of errors to be told apart by coarser companions of the run: mesh (cells and control mesh, spacings doubled), cells, control mesh, "
      "step (Time/Step doubled, or Time/Tolerance as much larger as doubles the steps), box (half the side, in unbounded liquid twice), stop (no companion: from the limit "
      "that the run's history is extrapolated to), tolerances (Newton tolerance tenfold), target (Accuracy/Target error fourfold: one companion for all that it chooses but the control mesh). "
      "Companions end when the run does. Empty: the run alone.",
      dealii::Patterns::List(dealii::Patterns::Selection(selection)));
    prm.add_parameter("Levels",
                      levels,
                      "Levels of each cause, that of the run included; from 3 on the orders are observed, with 2 those of theory are taken.",
                      dealii::Patterns::Integer(2, 5));
    prm.add_parameter("Together", together, "Whether all causes are varied together, for one error bar, instead of one at a time.");
    prm.add_parameter(
      "Frugal",
      frugal,
      "Whether the other causes are varied on a mesh that is coarser once, where mesh is among them: what they are worth depends little on the mesh.");
    prm.leave_subsection();
  }


  std::vector<Cause>
  StudyParameters::causes() const
  {
    std::vector<Cause> result;
    for (const std::string &name : vary)
      result.push_back(static_cast<Cause>(std::find(words.begin(), words.end(), name) - words.begin()));
    return result;
  }


  void
  StudyParameters::check(const int control_mesh_level, const bool has_stop, const bool is_unbounded, const bool has_target) const
  {
    const auto names = [this](const Cause cause) { return std::count(vary.begin(), vary.end(), word(cause)); };
    for (const Cause cause : causes())
      if (names(cause) > 1)
        throw InputError("Study/Vary names " + word(cause) + " twice");
    if (names(Cause::mesh) > 0 && names(Cause::cells) + names(Cause::control_mesh) > 0)
      throw InputError("Study/Vary names mesh beside cells or control mesh; mesh is both of them");
    if (names(Cause::stop) > 0 && !has_stop)
      throw InputError("Study/Vary names stop; allowed with Time/Steady tolerance > 0 or Time/Limit tolerance > 0");
    if (names(Cause::target) > 0 && !has_target)
      throw InputError("Study/Vary names target; allowed with Accuracy/Target error > 0");
    if (names(Cause::target) > 0 && vary.size() > 1u + names(Cause::stop))
      throw InputError("Study/Vary names target, which varies all causes; allowed beside it: stop");
    if (is_unbounded && together && names(Cause::box) > 0)
      throw InputError("Study/Vary names box; allowed with Study/Together and Scene/Boundary = unbounded: what is coarser in companions, the box is larger");
    // The frugal companions of other causes have a mesh that is coarser once, which is no coarser than the last companion of the mesh.
    const int coarsenings = names(Cause::mesh) + names(Cause::control_mesh) > 0 ? int(levels) - 1 : 0;
    if (coarsenings > 0 && control_mesh_level < coarsenings)
      throw InputError("Study/Vary wants the control mesh coarser " + std::to_string(coarsenings) +
                       (control_mesh_level < 0 ? " times; a control mesh from a file cannot be, allowed: cells"
                                               : " times; allowed with Shell mesh/Level >= " + std::to_string(coarsenings)));
  }
} // namespace tanktread
