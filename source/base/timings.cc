// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: wall time spent in named parts of the program.

#include <tanktread/base/timings.h>

#include <algorithm>
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

    bool
    is_piece(const Timings::Part &part)
    {
      return part.name.compare(0, 2, "- ") == 0;
    }

    std::string
    formatted(const char *const format, const double number)
    {
      char text[40];
      std::snprintf(text, sizeof(text), format, number);
      return text;
    }

    std::string
    table_row(const std::string &name, const std::string &calls, const std::string &seconds, const std::string &share)
    {
      char line[160];
      std::snprintf(line, sizeof(line), "%-36.60s %8s %10s %7s", name.c_str(), calls.c_str(), seconds.c_str(), share.c_str());
      std::string text = line;
      return text.erase(text.find_last_not_of(' ') + 1) + "\n";
    }
  } // namespace

  Timings::Scope::Scope(Timings &timings, const std::string &name)
    : timings(&timings)
    , part(timings.find_or_add(name))
    , start(Clock::now())
  {}

  Timings::Scope::Scope(Timings *const timings, const char *const name)
    : timings(timings)
    , part(timings ? timings->find_or_add(name) : 0)
    , start(Clock::now())
  {}

  Timings::Scope::~Scope()
  {
    if (!timings)
      return;
    timings->all_parts[part].seconds += seconds_since(start);
    ++timings->all_parts[part].calls;
  }

  Timings::Timings()
    : start(Clock::now())
  {}

  double
  Timings::elapsed() const
  {
    return before + seconds_since(start);
  }

  void
  Timings::add_before(const double seconds)
  {
    before += seconds;
  }

  const std::vector<Timings::Part> &
  Timings::parts() const
  {
    return all_parts;
  }

  double
  Timings::seconds(const std::string &name) const
  {
    const std::size_t i = find(name);
    return i < all_parts.size() ? all_parts[i].seconds : 0.;
  }

  double
  Timings::rest(const std::string &name) const
  {
    const std::size_t i      = find(name);
    double            result = seconds(name);
    for (std::size_t j = i + 1; j < all_parts.size() && is_piece(all_parts[j]); ++j)
      result -= all_parts[j].seconds;
    return result;
  }

  std::string
  Timings::table() const
  {
    const double total = seconds_since(start);
    std::string  text  = table_row("part", "calls", "seconds", "share");
    const auto   add   = [&](const std::string &name, const std::string &calls, const double seconds) {
      text += table_row(name, calls, formatted("%.2f", seconds), formatted("%.1f%%", 100 * seconds / total));
    };
    std::string whole;
    for (std::size_t i = 0; i < all_parts.size(); ++i)
      {
        const Part &part = all_parts[i];
        if (!is_piece(part))
          whole = part.name;
        add((is_piece(part) ? "  " : "") + part.name, std::to_string(part.calls), part.seconds);
        const bool is_last = i + 1 == all_parts.size() || !is_piece(all_parts[i + 1]);
        if (is_piece(part) && is_last)
          add("  - rest", "", rest(whole));
      }
    return text + table_row("total", "", formatted("%.2f", total), "");
  }

  std::size_t
  Timings::find(const std::string &name) const
  {
    return std::find_if(all_parts.begin(), all_parts.end(), [&](const Part &part) { return part.name == name; }) - all_parts.begin();
  }

  std::size_t
  Timings::find_or_add(const std::string &name)
  {
    const std::size_t i = find(name);
    if (i == all_parts.size())
      all_parts.push_back({name});
    return i;
  }
} // namespace tanktread
