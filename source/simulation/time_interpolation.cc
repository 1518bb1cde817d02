// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: values of a run between its steps.

#include <tanktread/simulation/time_interpolation.h>

#include <algorithm>

namespace tanktread
{
  using Eigen::Index;

  Index
  last_before(const std::vector<double> &times, const double time)
  {
    return std::max<Index>(0, std::upper_bound(times.begin(), times.end(), time) - times.begin() - 1);
  }


  Eigen::RowVectorXd
  interpolated(const std::vector<double> &times, const Eigen::MatrixXd &values, const double time)
  {
    const Index        first  = std::min(std::max<Index>(last_before(times, time) - 1, 0), values.rows() - 4);
    Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(values.cols());
    for (Index i = first; i < first + 4; ++i)
      {
        double weight = 1.;
        for (Index j = first; j < first + 4; ++j)
          if (j != i)
            weight *= (time - times[j]) / (times[i] - times[j]);
        result += weight * values.row(i);
      }
    return result;
  }
} // namespace tanktread
