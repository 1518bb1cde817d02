// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: flexible GMRES with a report instead of an exception.

#include <tanktread/fluid/linear_solver.h>

namespace tanktread
{
  void
  HessenbergLeastSquares::append(std::vector<double> entries, const double below)
  {
    const std::size_t n = columns_.size();
    for (std::size_t i = 0; i < n; ++i)
      {
        const double upper = cosines_[i] * entries[i] + sines_[i] * entries[i + 1];
        entries[i + 1]     = -sines_[i] * entries[i] + cosines_[i] * entries[i + 1];
        entries[i]         = upper;
      }
    const double length = std::hypot(entries[n], below);
    cosines_.push_back(length > 0. ? entries[n] / length : 1.);
    sines_.push_back(length > 0. ? below / length : 0.);
    entries[n] = length;
    columns_.push_back(std::move(entries));
    rhs_.push_back(-sines_[n] * rhs_[n]);
    rhs_[n] *= cosines_[n];
  }


  std::vector<double>
  HessenbergLeastSquares::solution() const
  {
    std::vector<double> y(rhs_.begin(), rhs_.end() - 1);
    for (std::size_t i = y.size(); i-- > 0;)
      {
        y[i] = columns_[i][i] > 0. ? y[i] / columns_[i][i] : 0.;
        for (std::size_t j = 0; j < i; ++j)
          y[j] -= columns_[i][j] * y[i];
      }
    return y;
  }
} // namespace tanktread
