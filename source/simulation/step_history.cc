// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the positions that a time scheme looks back to, the error of a step and the length of the next.

#include <tanktread/simulation/step_history.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tanktread
{
  namespace
  {
    constexpr std::size_t max_levels = 4;
  }


  void
  StepHistory::add(const double time, const ShellFields &x)
  {
    levels_.push_front({time, x});
    if (levels_.size() > max_levels)
      levels_.pop_back();
  }


  const SdirkScheme *
  StepHistory::one_step_scheme() const
  {
    const unsigned int q = order(parameters_.scheme);
    return is_multistep(parameters_.scheme) && levels_.size() >= q ? nullptr : &sdirk(q);
  }


  std::vector<double>
  StepHistory::times(const double length, const std::size_t n) const
  {
    std::vector<double> result = {levels_[0].time + length};
    for (std::size_t i = 0; i < n; ++i)
      result.push_back(levels_[i].time);
    return result;
  }


  MultistepFormula
  StepHistory::multistep(const double length) const
  {
    return backward_differentiation(times(length, order(parameters_.scheme)));
  }


  unsigned int
  StepHistory::n_stages() const
  {
    const SdirkScheme *const scheme = one_step_scheme();
    return scheme == nullptr ? 1 : scheme->ends.size();
  }


  double
  StepHistory::stage_end(const unsigned int i) const
  {
    const SdirkScheme *const scheme = one_step_scheme();
    return scheme == nullptr ? 1. : scheme->ends[i];
  }


  ShellSteps
  StepHistory::stage(const unsigned int i, const double length, const std::vector<ShellFields> &displacements) const
  {
    if (const SdirkScheme *const scheme = one_step_scheme())
      {
        ShellSteps result{levels_[0].x, scheme->gamma * length};
        for (unsigned int j = 0; j < i; ++j)
          for (std::size_t c = 0; c < result.xhat.size(); ++c)
            result.xhat[c] += scheme->weights[i][j] * displacements[j][c];
        return result;
      }
    const MultistepFormula formula = multistep(length);
    ShellSteps             result{{}, formula.tau};
    for (std::size_t c = 0; c < levels_[0].x.size(); ++c)
      {
        result.xhat.push_back(formula.weights[0] * levels_[0].x[c]);
        for (std::size_t k = 1; k < formula.weights.size(); ++k)
          result.xhat[c] += formula.weights[k] * levels_[k].x[c];
      }
    return result;
  }


  StageWeights
  StepHistory::stage_weights(const unsigned int i, const double length) const
  {
    const SdirkScheme *const scheme = one_step_scheme();
    if (scheme == nullptr)
      return {{}, multistep(length).weights};
    // The displacement of stage j is what it has gained over its own explicit part.
    StageWeights result{std::vector<double>(i, 0.), {1.}};
    for (unsigned int j = 0; j < i; ++j)
      {
        const double       weight  = scheme->weights[i][j];
        const StageWeights earlier = stage_weights(j, length);
        result.stages[j] += weight;
        for (unsigned int k = 0; k < j; ++k)
          result.stages[k] -= weight * earlier.stages[k];
        result.levels[0] -= weight * earlier.levels[0];
      }
    return result;
  }


  double
  StepHistory::local_error(const double length, const ShellFields &x, const ShellFields &normals) const
  {
    Eigen::Index n = 0;
    for (const ControlPoints &of_shell : x)
      n += of_shell.rows();
    return std::sqrt(squared_error(length, x, normals) / n);
  }


  double
  StepHistory::squared_error(const double length, const ShellFields &x, const ShellFields &normals) const
  {
    const std::size_t q = order(parameters_.scheme);
    if (levels_.size() < q + 1)
      return 0.;

    const std::vector<double> times = this->times(length, q + 1);
    double                    sum   = 0.;
    for (std::size_t c = 0; c < x.size(); ++c)
      {
        // Divided difference of q + 2 positions, the new one first: derivative of order q + 1 over its factorial.
        std::vector<ControlPoints> differences = {x[c]};
        for (std::size_t i = 0; i <= q; ++i)
          differences.push_back(levels_[i].x[c]);
        for (std::size_t k = 1; k <= q + 1; ++k)
          for (std::size_t i = 0; i + k <= q + 1; ++i)
            differences[i] = (differences[i] - differences[i + 1]) / (times[i] - times[i + k]);
        sum += normals.empty() ? differences[0].squaredNorm() : differences[0].cwiseProduct(normals[c]).rowwise().sum().squaredNorm();
      }
    double weight;
    if (const SdirkScheme *const scheme = one_step_scheme())
      weight = std::abs(scheme->error_constant) * std::tgamma(q + 2.) * std::pow(length, q + 1.);
    else
      {
        weight = multistep(length).tau;
        for (std::size_t i = 1; i <= q; ++i)
          weight *= times[0] - times[i];
      }
    return weight * weight * sum;
  }


  ShellFields
  StepHistory::at(const double time) const
  {
    const std::size_t n = std::min<std::size_t>(levels_.size(), std::max(3u, order(parameters_.scheme) + 1));
    ShellFields       x;
    for (const ControlPoints &last : levels_[0].x)
      x.push_back(ControlPoints::Zero(last.rows(), 3));
    for (std::size_t i = 0; i < n; ++i)
      {
        double weight = 1.;
        for (std::size_t j = 0; j < n; ++j)
          if (j != i)
            weight *= (time - levels_[j].time) / (levels_[i].time - levels_[j].time);
        for (std::size_t c = 0; c < x.size(); ++c)
          x[c] += weight * levels_[i].x[c];
      }
    return x;
  }


  double
  StepHistory::length_factor(const double local_error) const
  {
    if (parameters_.tolerance == 0.)
      return 1.5;
    return std::clamp(0.9 * std::pow(parameters_.tolerance / (local_error + 1e-300), 1. / (order(parameters_.scheme) + 1.)), 0.3, 1.5);
  }


  double
  StepHistory::first_length() const
  {
    return parameters_.tolerance == 0. ? parameters_.step : std::min(parameters_.step, std::sqrt(2. * parameters_.tolerance));
  }
} // namespace tanktread
