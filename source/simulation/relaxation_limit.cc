// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where a relaxing motion goes to, before it is there.

#include <Eigen/QR>
#include <tanktread/simulation/relaxation_limit.h>
#include <tanktread/simulation/time_interpolation.h>

#include <algorithm>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    using Eigen::Index;
    using Eigen::MatrixXd;

    constexpr unsigned int rank         = 4;
    constexpr double       window_start = 0.3; // of the time since the start; what was before is forgotten
    constexpr double       earlier      = 0.8; // of that time: where an earlier estimate is made
    constexpr double       safety       = 2.;
    constexpr Index        n_grid = 41, least_samples = 10;
    constexpr double       contraction    = 0.5;  // over the window
    constexpr double       at_rest        = 0.01; // of the run's range: what moves less than this has come to rest
    constexpr double       widest         = 0.1;  // bar, of the run's range
    constexpr double       rank_threshold = 1e-8; // columns of the least squares problem that depend on the others to this are left out


    /** At n_grid equal steps from window_start of the time up to `end` on. */
    MatrixXd
    window(const std::vector<double> &times, const MatrixXd &values, const double end)
    {
      const double start = times.front() + window_start * (end - times.front());
      MatrixXd     result(n_grid, values.cols());
      for (Index n = 0; n < n_grid; ++n)
        result.row(n) = interpolated(times, values, start + (end - start) * n / (n_grid - 1.));
      return result;
    }


    /** With the stride that shares the samples evenly between the lags and the residuals. */
    MatrixXd
    estimates(const MatrixXd &samples, const Index n_leading, const unsigned int of_rank)
    {
      return reduced_rank_extrapolation(samples, n_leading, of_rank, (n_grid - 1) / (2 * (of_rank + 1)));
    }


    /** Of the leading columns, over the window: whether they draw near to the limit, or have come to rest. */
    bool
    relaxes(const MatrixXd &deviations, const double range)
    {
      const Eigen::VectorXd size = deviations.rowwise().norm();
      return size.tail(n_grid / 3).maxCoeff() <= std::max(contraction * size.maxCoeff(), at_rest * range);
    }


    /** Largest less smallest value of each column. */
    Eigen::RowVectorXd
    ranges(const MatrixXd &values)
    {
      return values.colwise().maxCoeff() - values.colwise().minCoeff();
    }


    /** For columns that are finite at all times. */
    std::vector<RelaxationLimit>
    finite_limits(const std::vector<double> &times, const MatrixXd &values, const Index n_leading)
    {
      const double             T       = times.back() - times.front();
      const MatrixXd           samples = window(times, values, times.back()), seen = estimates(samples, n_leading, rank);
      const Eigen::RowVectorXd limit = seen.row(seen.rows() - 1), lower = estimates(samples, n_leading, rank - 1).bottomRows<1>(),
                               before = estimates(window(times, values, times.front() + earlier * T), n_leading, rank).bottomRows<1>();
      const Eigen::RowVectorXd drift  = (seen.bottomRows(seen.rows() - seen.rows() / 2).rowwise() - limit).cwiseAbs().colwise().maxCoeff();
      const Eigen::RowVectorXd own    = safety * drift.cwiseMax((lower - limit).cwiseAbs()).cwiseMax((before - limit).cwiseAbs());
      // Where estimates of one quantity cross by chance, those of the others tell: no bar has a smaller share of the motion in the window than all have together.
      const Eigen::RowVectorXd moved = ranges(samples);
      const double             size = own.head(n_leading).norm(), all_moved = moved.head(n_leading).norm(), range = ranges(values).head(n_leading).norm();
      const Eigen::RowVectorXd error = all_moved > 0. ? own.cwiseMax(size / all_moved * moved) : own;

      std::vector<RelaxationLimit> result(values.cols());
      if (!relaxes((samples.rowwise() - limit).leftCols(n_leading), range) || size > widest * range)
        return result;
      for (Index c = 0; c < values.cols(); ++c)
        result[c] = {limit[c], error[c]};
      return result;
    }
  } // namespace


  MatrixXd
  reduced_rank_extrapolation(const MatrixXd &samples, const Index n_leading, const unsigned int rank, const unsigned int stride)
  {
    const Index n_seen = samples.rows() - Index(rank) * stride, n_residuals = n_seen - Index(stride);
    if (n_residuals < 1)
      throw std::invalid_argument("Reduced rank extrapolation needs more than (rank + 1) * stride samples.");
    const auto residual = [&](const unsigned int j) -> Eigen::VectorXd {
      const MatrixXd difference =
        (samples.middleRows(Index(j + 1) * stride, n_residuals) - samples.middleRows(Index(j) * stride, n_residuals)).leftCols(n_leading);
      return Eigen::Map<const Eigen::VectorXd>(difference.data(), difference.size());
    };
    // The last weight is one less the others: that leaves a problem without a constraint.
    const Eigen::VectorXd last = residual(rank);
    MatrixXd              others(last.size(), rank);
    for (unsigned int j = 0; j < rank; ++j)
      others.col(j) = residual(j) - last;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
    decomposition.setThreshold(rank_threshold);
    const Eigen::VectorXd gamma = decomposition.compute(others).solve(-last);
    MatrixXd              limit = (1. - gamma.sum()) * samples.bottomRows(n_seen);
    for (unsigned int j = 0; j < rank; ++j)
      limit += gamma[j] * samples.middleRows(Index(j) * stride, n_seen);
    return limit;
  }


  std::vector<RelaxationLimit>
  relaxation_limits(const std::vector<double> &times, const MatrixXd &values, const Index n_leading)
  {
    std::vector<RelaxationLimit> result(values.cols());
    if (times.empty())
      return result;
    // The earlier estimate looks back furthest.
    const double       T     = times.back() - times.front();
    const Index        first = std::max<Index>(0, last_before(times, times.front() + window_start * earlier * T) - 1), n = values.rows() - first;
    std::vector<Index> columns;
    Index              n_finite_leading = 0;
    for (Index c = 0; c < values.cols(); ++c)
      if (values.col(c).tail(n).allFinite())
        {
          columns.push_back(c);
          n_finite_leading += c < n_leading ? 1 : 0;
        }
    const Index n_in_window = values.rows() - last_before(times, times.front() + window_start * T);
    if (n_in_window < least_samples || n_finite_leading == 0)
      return result;
    MatrixXd finite(values.rows(), columns.size());
    for (std::size_t c = 0; c < columns.size(); ++c)
      finite.col(c) =
        values.col(columns[c]).array().isFinite().select(values.col(columns[c]), values(values.rows() - 1, columns[c])); // the start is not looked at
    const std::vector<RelaxationLimit> limits = finite_limits(times, finite, n_finite_leading);
    for (std::size_t c = 0; c < columns.size(); ++c)
      result[columns[c]] = limits[c];
    return result;
  }
} // namespace tanktread
