// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: wall time spent in named parts of the program.

#ifndef tanktread_base_timings_h
#define tanktread_base_timings_h

#include <chrono>
#include <string>
#include <vector>

namespace tanktread
{
  /**
   * Adds up wall time (s) and calls of named parts. It never communicates: each rank has its own figures. Parts that contain each other are both counted in
   * full.
   *
   *     Timings timings;
   *     {
   *       const Timings::Scope scope(timings, "Shell force");
   *       ...
   *     }
   */
  class Timings
  {
  public:
    /** Measures from its construction to its destruction. */
    class Scope
    {
    public:
      Scope(Timings &timings, const std::string &name);
      Scope(const Scope &) = delete;
      ~Scope();

    private:
      Timings                                    &timings;
      const std::size_t                           part;
      const std::chrono::steady_clock::time_point start;
    };

    struct Part
    {
      std::string  name;
      double       seconds = 0.;
      unsigned int calls   = 0;
    };

    Timings();

    /** Seconds since construction. */
    double
    elapsed() const;

    /** All parts, in the order of their first use. */
    const std::vector<Part> &
    parts() const;

    /** Table of all parts: calls, seconds and share of the time since construction. */
    std::string
    table() const;

  private:
    std::size_t
    find_or_add(const std::string &name);

    std::chrono::steady_clock::time_point start;
    std::vector<Part>                     all_parts;
  };
} // namespace tanktread

#endif
