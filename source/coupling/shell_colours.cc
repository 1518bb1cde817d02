// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: classes of shells that are far from each other.

#include <tanktread/coupling/shell_colours.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace tanktread
{
  namespace
  {
    /** Shells by the place of their boxes' centres: bins so large that shells that are near to each other are in the same one or in neighbours. */
    class Bins
    {
    public:
      Bins(const std::vector<ShellBox> &shells, const Box &box, const double margin)
        : shells_(shells)
        , box_(box)
        , margin_(margin)
      {
        for (unsigned int d = 0; d < 3; ++d)
          {
            size_[d] = margin;
            for (const ShellBox &shell : shells)
              size_[d] = std::max(size_[d], margin + shell.upper[d] - shell.lower[d]);
            n_[d] = std::max<std::int64_t>(1, std::floor(box.side[d] / size_[d]));
            if (box.is_periodic(d))
              size_[d] = box.side[d] / n_[d];
          }
      }

      void
      insert(const unsigned int shell)
      {
        bins_[bin(shell)].push_back(shell);
      }

      /** Calls visit(other) for each shell inserted that is near to this one. */
      template <typename Visit>
      void
      for_near(const unsigned int shell, const Visit &visit) const
      {
        const Place                              home = bin(shell);
        std::array<std::vector<std::int64_t>, 3> places;
        for (unsigned int d = 0; d < 3; ++d)
          {
            for (std::int64_t i = home[d] - 1; i <= home[d] + 1; ++i)
              places[d].push_back(wrapped(i, d));
            std::sort(places[d].begin(), places[d].end());
            places[d].erase(std::unique(places[d].begin(), places[d].end()), places[d].end());
          }
        for (const std::int64_t x : places[0])
          for (const std::int64_t y : places[1])
            for (const std::int64_t z : places[2])
              if (const auto found = bins_.find({{x, y, z}}); found != bins_.end())
                for (const unsigned int other : found->second)
                  if (are_near(shells_[shell], shells_[other]))
                    visit(other);
      }

    private:
      using Place = std::array<std::int64_t, 3>;

      std::int64_t
      wrapped(const std::int64_t i, const unsigned int d) const
      {
        return box_.is_periodic(d) ? (i % n_[d] + n_[d]) % n_[d] : i;
      }

      Place
      bin(const unsigned int shell) const
      {
        Place result;
        for (unsigned int d = 0; d < 3; ++d)
          result[d] = wrapped(std::floor(0.5 * (shells_[shell].lower[d] + shells_[shell].upper[d]) / size_[d]), d);
        return result;
      }

      bool
      are_near(const ShellBox &first, const ShellBox &second) const
      {
        for (unsigned int d = 0; d < 3; ++d)
          {
            double distance = 0.5 * (first.lower[d] + first.upper[d] - second.lower[d] - second.upper[d]);
            if (box_.is_periodic(d))
              distance -= box_.side[d] * std::round(distance / box_.side[d]);
            if (std::abs(distance) >= 0.5 * (first.upper[d] - first.lower[d] + second.upper[d] - second.lower[d]) + margin_)
              return false;
          }
        return true;
      }

      const std::vector<ShellBox>               &shells_;
      const Box                                 &box_;
      const double                               margin_;
      std::array<double, 3>                      size_; // of the bins
      Place                                      n_;    // along periodic axes
      std::map<Place, std::vector<unsigned int>> bins_;
    };
  } // namespace


  std::vector<unsigned int>
  shell_colours(const std::vector<ShellBox> &shells, const Box &box, const double margin)
  {
    std::vector<unsigned int> result(shells.size());
    std::vector<char>         taken;
    Bins                      bins(shells, box, margin);
    for (unsigned int c = 0; c < shells.size(); ++c)
      {
        taken.clear();
        bins.for_near(c, [&](const unsigned int other) {
          taken.resize(std::max<std::size_t>(taken.size(), result[other] + 1), 0);
          taken[result[other]] = 1;
        });
        result[c] = std::find(taken.begin(), taken.end(), 0) - taken.begin();
        bins.insert(c);
      }
    return result;
  }
} // namespace tanktread
