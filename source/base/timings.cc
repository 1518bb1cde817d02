// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: wall time spent in named parts of the program.

#include <tanktread/base/timings.h>

#include <cstdio>

namespace tanktread
{
  namespace
  {
    using Clock = std::chrono::steady_clock;

    double
    seconds_since(const Clock::time_point start)
    {
      return std::chrono::duration<double>(Clock::now() - start).count();
    }
  } // namespace

  Timings::Scope::Scope(Timings &timings, const std::string &name)
    : timings(timings)
    , part(timings.find_or_add(name))
    , start(Clock::now())
  {}

  Timings::Scope::~Scope()
  {
    timings.all_parts[part].seconds += seconds_since(start);
    ++timings.all_parts[part].calls;
  }

  Timings::Timings()
    : start(Clock::now())
  {}

  double
  Timings::elapsed() const
  {
    return seconds_since(start);
  }

  const std::vector<Timings::Part> &
  Timings::parts() const
  {
    return all_parts;
  }

  std::string
  Timings::table() const
  {
    const double total = elapsed();
    char         line[160];
    std::snprintf(line, sizeof(line), "%-36s %8s %10s %7s\n", "part", "calls", "seconds", "share");
    std::string text = line;
    for (const Part &part : all_parts)
      {
        std::snprintf(line, sizeof(line), "%-36.60s %8u %10.2f %6.1f%%\n", part.name.c_str(), part.calls, part.seconds, 100 * part.seconds / total);
        text += line;
      }
    std::snprintf(line, sizeof(line), "%-36s %8s %10.2f\n", "total", "", total);
    return text + line;
  }

  std::size_t
  Timings::find_or_add(const std::string &name)
  {
    for (std::size_t i = 0; i < all_parts.size(); ++i)
      if (all_parts[i].name == name)
        return i;
    all_parts.push_back({name});
    return all_parts.size() - 1;
  }
} // namespace tanktread
