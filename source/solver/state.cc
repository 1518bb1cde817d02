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
  combination(const std::vector<double> &weights, const std::vector<const State *> &states)
  {
    State result = *states[0];
    result.fluid *= weights[0];
    for (CapsuleState &capsule : result.capsules)
      {
        capsule.x *= weights[0];
        capsule.force *= weights[0];
        capsule.pressure_jump *= weights[0];
      }
    for (std::size_t i = 1; i < states.size(); ++i)
      {
        result.fluid.add(weights[i], states[i]->fluid);
        for (std::size_t c = 0; c < result.capsules.size(); ++c)
          {
            const CapsuleState &further = states[i]->capsules[c];
            result.capsules[c].x += weights[i] * further.x;
            result.capsules[c].force += weights[i] * further.force;
            result.capsules[c].pressure_jump += weights[i] * further.pressure_jump;
          }
      }
    return result;
  }
} // namespace tanktread
