// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the known name that a misspelt one probably meant.

#include <tanktread/base/nearest_name.h>

#include <algorithm>
#include <cctype>

namespace tanktread
{
  namespace
  {
    bool
    equal_letters(const char a, const char b)
    {
      return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    }
  } // namespace

  unsigned int
  edit_distance(const std::string &a, const std::string &b)
  {
    // distance[i][j]: first i characters of a against first j characters of b
    std::vector<std::vector<unsigned int>> distance(a.size() + 1, std::vector<unsigned int>(b.size() + 1));
    for (unsigned int i = 0; i <= a.size(); ++i)
      for (unsigned int j = 0; j <= b.size(); ++j)
        {
          if (i == 0 || j == 0)
            {
              distance[i][j] = i + j;
              continue;
            }
          const unsigned int replaced = distance[i - 1][j - 1] + (equal_letters(a[i - 1], b[j - 1]) ? 0 : 1);
          distance[i][j]              = std::min({replaced, distance[i - 1][j] + 1, distance[i][j - 1] + 1});
          if (i > 1 && j > 1 && equal_letters(a[i - 1], b[j - 2]) && equal_letters(a[i - 2], b[j - 1]))
            distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
        }
    return distance[a.size()][b.size()];
  }

  std::string
  nearest_name(const std::string &name, const std::vector<std::string> &known)
  {
    std::string  nearest;
    unsigned int least = std::max<unsigned int>(2, name.size() / 3) + 1;
    for (const std::string &candidate : known)
      {
        const unsigned int distance = edit_distance(name, candidate);
        if (distance < least && distance < candidate.size())
          {
            least   = distance;
            nearest = candidate;
          }
      }
    return nearest;
  }

  std::string
  did_you_mean(const std::string &name, const std::vector<std::string> &known)
  {
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
  }
} // namespace tanktread
