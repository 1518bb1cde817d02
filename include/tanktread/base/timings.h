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
   * full. A name that begins with "- " is that of a piece of the part above it, the last one before it without.
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
    /** Measures from its construction to its destruction; nothing if it is given a null pointer. */
    class Scope
    {
    public:
      Scope(Timings &timings, const std::string &name);
      Scope(Timings *timings, const char *name);
      Scope(const Scope &) = delete;
      ~Scope();

    private:
      Timings *const                              timings;
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

    /** Seconds since construction, and those of before if the run is one that goes on. */
    double
    elapsed() const;
    void
    add_before(double seconds);

    /** All parts, in the order of their first use. */
    const std::vector<Part> &
    parts() const;

    /** Seconds in that part, 0 if there is none of that name. */
    double
    seconds(const std::string &name) const;

    /** Seconds in that part outside its pieces. */
    double
    rest(const std::string &name) const;

    /** Table of all parts: calls, seconds and share of the time since construction. Below the pieces of a part a row says what they have left. */
    std::string
    table() const;

  private:
    /** Index of the part, or the number of parts. */
    std::size_t
    find(const std::string &name) const;
    std::size_t
    find_or_add(const std::string &name);

    std::chrono::steady_clock::time_point start;
    double                                before = 0.;
    std::vector<Part>                     all_parts;
  };
} // namespace tanktread

#endif
