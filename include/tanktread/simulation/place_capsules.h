// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: places of capsules from files or at random, as the lists that the rest of the program knows.

#ifndef tanktread_simulation_place_capsules_h
#define tanktread_simulation_place_capsules_h

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  class ParameterSource;
  struct Parameters;

  /**
   * Makes lists, in `prm` and so in `parameters`, of the places that kinds of capsules have from a file or at random; random ones are found for all kinds together. Throws InputError with the place in
   * `source` of the parameter that is to blame.
   */
  void
  place_capsules(dealii::ParameterHandler &prm, Parameters &parameters, const ParameterSource &source);
} // namespace tanktread

#endif
