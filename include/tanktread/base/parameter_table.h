// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the list of all declared parameters, and how it is printed.

#ifndef tanktread_base_parameter_table_h
#define tanktread_base_parameter_table_h

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** What is known of one declared parameter. */
  struct ParameterInfo
  {
    std::string section;       // "Scene"; nested sections joined by '/'
    std::string name;          // "Shear number G"
    std::string value;         // present value
    std::string default_value; // value when nothing is set
    std::string documentation; // meaning and scale, on one line
    std::string allowed;       // pattern in words: "a number >= 0"
  };

  /** All parameters declared in `prm`, in the order of their declaration. */
  std::vector<ParameterInfo>
  parameter_table(const dealii::ParameterHandler &prm);

  /**
   * Puts the machine-readable description of a dealii::Patterns class into words: "[Double 0...MAX_DOUBLE (inclusive)]" becomes "a number >= 0". A lower
   * bound that is the smallest positive double means "> 0". Descriptions it does not know come back as they are.
   */
  std::string
  pattern_in_words(const std::string &description);

  /** The parameters with their present values as a parameter file that can be read again; documentation and allowed values stand above each as comments. */
  std::string
  parameters_as_prm(const dealii::ParameterHandler &prm);

  /** The parameters with their defaults, allowed values and documentation as one Markdown table a section. */
  std::string
  parameters_as_markdown(const dealii::ParameterHandler &prm);
} // namespace tanktread

#endif
