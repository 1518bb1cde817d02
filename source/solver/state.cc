// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the unknowns of a time level.

#include <tanktread/solver/state.h>

namespace tanktread
{
  ShellFields
  positions(const State &state)
  {
    ShellFields result;
    for (const CapsuleState &capsule : state.capsules)
      result.push_back(capsule.x);
    return result;
  }


  ShellFields
  forces(const State &state)
  {
    ShellFields result;
    for (const CapsuleState &capsule : state.capsules)
      result.push_back(capsule.force);
    return result;
  }


  void
  add(State &state, const double factor, const State &increment)
  {
    for (std::size_t c = 0; c < state.capsules.size(); ++c)
      {
        CapsuleState       &capsule = state.capsules[c];
        const CapsuleState &change  = increment.capsules[c];
        capsule.x += factor * change.x;
        capsule.force += factor * change.force;
        capsule.pressure_jump += factor * change.pressure_jump;
        capsule.volume_shift += factor * change.volume_shift;
      }
    for (unsigned int b = 0; b <= pressure_block; ++b)
      state.fluid.block(b).add(factor, increment.fluid.block(b));
  }


  State
  extrapolated(const State &state, const State &before, const double ratio)
  {
    State result = state;
    for (std::size_t c = 0; c < state.capsules.size(); ++c)
      {
        CapsuleState       &capsule = result.capsules[c];
        const CapsuleState &now = state.capsules[c], &past = before.capsules[c];
        capsule.x += ratio * (now.x - past.x);
        capsule.force += ratio * (now.force - past.force);
        capsule.pressure_jump += ratio * (now.pressure_jump - past.pressure_jump);
      }
    result.fluid.sadd(1. + ratio, -ratio, before.fluid);
    return result;
  }
} // namespace tanktread
