// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: sections "Capsule", "Capsule 2", ...: the kinds of capsules of a scene.

#ifndef tanktread_simulation_kind_parameters_h
#define tanktread_simulation_kind_parameters_h

#include <tanktread/shell/shell_parameters.h>
#include <tanktread/simulation/placement_parameters.h>
#include <tanktread/surface/capsule_shape.h>

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  class ParameterSource;

  /** `message` about "Capsule/..." as one about another section. */
  std::string
  in_section(const std::string &section, std::string message);

  /**
   * A kind of capsule and where its capsules start: section "Capsule" for the first one, "Capsule 2", "Capsule 3", ... for others, in which what is not named is as in "Capsule", but for the places.
   * Sizes and moduli of others are given relative to those of the first, with which the scene's units and numbers are made.
   */
  struct KindParameters
  {
    /** @param number of the kind, from 0. */
    explicit KindParameters(unsigned int number = 0);

    std::string            section;
    CapsuleShapeParameters shape;
    PlacementParameters    placement;
    ShellParameters        shell;
    double                 young_modulus_factor   = 1.;    // E h over that of the first kind
    double                 bending_modulus_factor = 1.;    // kappa_B likewise
    bool                   has_random_places      = false; // which are a list by now

    /** Declares the section in `prm`; parsing fills this object, which has to outlive `prm` and stay where it is. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** Those alone that the first kind has not. */
    void
    add_further_parameters(dealii::ParameterHandler &prm);

    /** Throws InputError, about this section, where one of the members does. */
    void
    check() const;

    /** `message` about "Capsule/..." as one about this section. */
    std::string
    in_section(const std::string &message) const
    {
      return tanktread::in_section(section, message);
    }

    bool
    is_first() const;
  };

  /**
   * How many kinds a parameter file has: the largest n for which a section "Capsule n" begins in `text` or is set by one of `overrides` ("Section/Parameter=value"), 1 if none does. Throws InputError
   * where numbers are missing, naming the line.
   */
  unsigned int
  number_of_kinds(const std::string &text, const std::string &file_name, const std::vector<std::string> &overrides);

  /** Gives the sections of further kinds what section "Capsule" sets and they do not, with its place in `source`; places of capsules are no part of that. */
  void
  inherit_from_first_kind(dealii::ParameterHandler &prm, unsigned int n_kinds, ParameterSource &source);
} // namespace tanktread

#endif
