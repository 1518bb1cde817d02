// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where a relaxing motion goes to, before it is there.

#ifndef tanktread_simulation_relaxation_limit_h
#define tanktread_simulation_relaxation_limit_h

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace tanktread
{
  /** Limit of one quantity with an error bar; not numbers where the motion does not say. */
  struct RelaxationLimit
  {
    double value = std::numeric_limits<double>::quiet_NaN(), error = std::numeric_limits<double>::quiet_NaN();
  };

  /**
   * Reduced rank extrapolation by least squares (A. Sidi, Vector Extrapolation Methods with Applications, SIAM 2017, chapter 2). The weights gamma_0, ..., gamma_rank
   * with the sum one make
   *
   *     sum_n |sum_j gamma_j (y_{n+(j+1)q} - y_{n+jq})|^2
   *
   * smallest, the norm being that of the first `n_leading` columns; the limit as seen from sample n is sum_j gamma_j y_{n+jq}. It is the same for all n, and exact, if
   * y is a constant and `rank` exponentials of time, decaying or not, real or in complex pairs.
   *
   * @param samples at equal steps of time, one a row. @param stride q.
   * @return the limits seen from n = 0, 1, ..., one a row, `rank * stride` rows fewer than samples. Throws std::invalid_argument if there are too few samples.
   */
  Eigen::MatrixXd
  reduced_rank_extrapolation(const Eigen::MatrixXd &samples, Eigen::Index n_leading, unsigned int rank, unsigned int stride);

  /**
   * Limits of the columns of `values`, one row a time, by the rule of doc/theory.md, section 8.5. The leading columns, all of one size (a length in units of a, an
   * angle in units of pi), decide about the weights of time, and whether the motion relaxes: if it swings, turns, grows or has hardly begun, nothing is a number.
   * A column that is not finite at all times that count has no limit, and no part in the weights.
   *
   * @param times ascending, at any distances.
   */
  std::vector<RelaxationLimit>
  relaxation_limits(const std::vector<double> &times, const Eigen::MatrixXd &values, Eigen::Index n_leading);
} // namespace tanktread

#endif
