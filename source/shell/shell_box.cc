// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: boxes about shells, by which it is told which of them may be near to each other.

#include <tanktread/shell/shell_box.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  ShellBox
  shell_box(const ControlPoints &X)
  {
    ShellBox result;
    for (unsigned int d = 0; d < 3; ++d)
      {
        result.lower[d] = X.col(d).minCoeff();
        result.upper[d] = X.col(d).maxCoeff();
      }
    return result;
  }


  ShellBox
  joined(const ShellBox &first, const ShellBox &second)
  {
    ShellBox result;
    for (unsigned int d = 0; d < 3; ++d)
      {
        result.lower[d] = std::min(first.lower[d], second.lower[d]);
        result.upper[d] = std::max(first.upper[d], second.upper[d]);
      }
    return result;
  }


  double
  box_distance(const ShellBox &first, const ShellBox &second, const std::array<double, 3> &periods)
  {
    double square = 0.;
    for (unsigned int d = 0; d < 3; ++d)
      {
        // Of the middles of the nearest images, less what of it lies inside of the boxes.
        double middles = 0.5 * (first.lower[d] + first.upper[d] - second.lower[d] - second.upper[d]);
        if (std::isfinite(periods[d]))
          middles -= periods[d] * std::round(middles / periods[d]);
        const double apart = std::max(0., std::abs(middles) - 0.5 * (first.upper[d] - first.lower[d] + second.upper[d] - second.lower[d]));
        square += apart * apart;
      }
    return std::sqrt(square);
  }
} // namespace tanktread
