// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the positions that a time scheme looks back to, the error of a step and the length of the next.

#include <tanktread/simulation/step_history.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace tanktread
{
  void
  StepHistory::add(const double time, const ShellFields &x)
  {
    levels_.push_front({time, x});
    if (levels_.size() > 3)
      levels_.pop_back();
  }


  template <typename Formula>
  ShellSteps
  StepHistory::each_capsule(const Formula &formula) const
  {
    ShellSteps result;
    for (std::size_t c = 0; c < levels_[0].x.size(); ++c)
      {
        const ImplicitStep of_capsule = formula(c);
        result.xhat.push_back(of_capsule.xhat);
        result.tau = of_capsule.tau;
      }
    return result;
  }


  ShellSteps
  StepHistory::step(const double length) const
  {
    if (starts())
      throw std::logic_error("StepHistory: a step of BDF2 looks back to two levels.");
    return each_capsule([&](const std::size_t c) {
      return is_second_order() ? bdf2_step(levels_[0].x[c], levels_[1].x[c], length, levels_[0].time - levels_[1].time)
                               : backward_euler_step(levels_[0].x[c], length);
    });
  }


  ShellSteps
  StepHistory::first_stage(const double length) const
  {
    return each_capsule([&](const std::size_t c) { return sdirk2_stage(levels_[0].x[c], length); });
  }


  ShellSteps
  StepHistory::second_stage(const double length, const ShellFields &displacement) const
  {
    return each_capsule([&](const std::size_t c) { return sdirk2_step(levels_[0].x[c], displacement[c], length); });
  }


  std::array<double, 2>
  StepHistory::second_stage_weights()
  {
    const double stage = (1. - sdirk2_gamma) / sdirk2_gamma;
    return {{stage, 1. - stage}};
  }


  std::array<double, 2>
  StepHistory::weights(const double length) const
  {
    if (!is_second_order())
      return {{1., 0.}};
    const double omega = length / (levels_[0].time - levels_[1].time);
    return {{(1. + omega) * (1. + omega) / (1. + 2. * omega), -omega * omega / (1. + 2. * omega)}};
  }


  double
  StepHistory::local_error(const double length, const ShellFields &x) const
  {
    const std::size_t order = is_second_order() ? 2 : 1;
    if (levels_.size() < order + 1)
      return 0.;

    std::vector<double> times = {levels_[0].time + length};
    for (std::size_t i = 0; i <= order; ++i)
      times.push_back(levels_[i].time);
    double       sum = 0.;
    Eigen::Index n   = 0;
    for (std::size_t c = 0; c < x.size(); ++c)
      {
        // Divided difference of order + 2 positions, the new one first: derivative of that order over its factorial.
        std::vector<ControlPoints> differences = {x[c]};
        for (std::size_t i = 0; i <= order; ++i)
          differences.push_back(levels_[i].x[c]);
        for (std::size_t k = 1; k <= order + 1; ++k)
          for (std::size_t i = 0; i + k <= order + 1; ++i)
            differences[i] = (differences[i] - differences[i + 1]) / (times[i] - times[i + k]);
        sum += differences[0].squaredNorm();
        n += x[c].rows();
      }
    const double omega  = length / (times[1] - times[2]);
    const double weight = order == 1 ? length * length : (1. + omega) * (1. + omega) / (omega * (1. + 2. * omega)) * length * length * length;
    return weight * std::sqrt(sum / n);
  }


  ShellFields
  StepHistory::at(const double time) const
  {
    ShellFields x;
    for (const ControlPoints &last : levels_[0].x)
      x.push_back(ControlPoints::Zero(last.rows(), 3));
    for (const Level &level : levels_)
      {
        double weight = 1.;
        for (const Level &other : levels_)
          if (other.time != level.time)
            weight *= (time - other.time) / (level.time - other.time);
        for (std::size_t c = 0; c < x.size(); ++c)
          x[c] += weight * level.x[c];
      }
    return x;
  }


  double
  StepHistory::length_factor(const double local_error) const
  {
    if (parameters_.tolerance == 0.)
      return 1.5;
    const double order = is_second_order() ? 2. : 1.;
    return std::clamp(0.9 * std::pow(parameters_.tolerance / (local_error + 1e-300), 1. / (order + 1.)), 0.3, 1.5);
  }


  double
  StepHistory::first_length() const
  {
    return parameters_.tolerance == 0. ? parameters_.step : std::min(parameters_.step, std::sqrt(2. * parameters_.tolerance));
  }
} // namespace tanktread
