// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Study", coarser companions of a run that tell its errors.

#ifndef tanktread_simulation_study_parameters_h
#define tanktread_simulation_study_parameters_h

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** What a number of the summary may be wrong by. */
  enum class Cause
  {
    mesh, // cells and control mesh together
    cells,
    control_mesh,
    step,
    box,
    stop,
    tolerances,
    target // all that Accuracy/Target error chooses
  };

  /** As in the parameter file. */
  const std::string &
  word(Cause cause);

  /** Section "Study". */
  struct StudyParameters
  {
    std::vector<std::string> vary; // words of causes; empty: no study
    unsigned int             levels   = 2;
    bool                     together = false;
    bool                     frugal   = true;

    /** Declares section "Study" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    bool
    is_wanted() const
    {
      return !vary.empty();
    }

    std::vector<Cause>
    causes() const;

    /**
     * @param control_mesh_level of the run, or a negative number if its control mesh has none. Throws InputError for a cause that is named twice or that the run
     * cannot vary.
     */
    void
    check(int control_mesh_level, bool has_stop, bool is_unbounded, bool has_target) const;
  };
} // namespace tanktread

#endif
