// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: parameters whose value is one word of a fixed list.

#ifndef tanktread_base_enum_parameter_h
#define tanktread_base_enum_parameter_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /**
   * Declares parameter `name` in the current section of `prm`; its allowed values are the first members of `names` and parsing sets `value` to the
   * matching second member. The default is the present value of `value`, which therefore has to occur in `names` and has to outlive `prm`.
   */
  template <typename Enum>
  void
  add_enum_parameter(dealii::ParameterHandler                        &prm,
                     const std::string                               &name,
                     Enum                                            &value,
                     const std::vector<std::pair<std::string, Enum>> &names,
                     const std::string                               &documentation)
  {
    std::string allowed, initial;
    for (const auto &[word, enumerator] : names)
      {
        allowed += (allowed.empty() ? "" : "|") + word;
        if (enumerator == value)
          initial = word;
      }
    prm.declare_entry(name, initial, dealii::Patterns::Selection(allowed), documentation);
    prm.add_action(name, [&value, names](const std::string &text) {
      for (const auto &[word, enumerator] : names)
        if (word == text)
          value = enumerator;
    });
  }
} // namespace tanktread

#endif
