// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: numbers in messages.

#ifndef tanktread_base_number_text_h
#define tanktread_base_number_text_h

#include <sstream>
#include <string>

namespace tanktread
{
  /** `value` with at most so many digits: "0.05", "1e-07". */
  inline std::string
  number_text(const double value, const int digits = 6)
  {
    std::ostringstream text;
    text.precision(digits);
    text << value;
    return text.str();
  }
} // namespace tanktread

#endif
