// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what kind of motion a run shows, its periods and frequencies.

#include <tanktread/simulation/energy_balance.h>
#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/time_interpolation.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace tanktread
{
  namespace
  {
    const double nan = std::numeric_limits<double>::quiet_NaN();

    constexpr unsigned int n_of_mean = 2000; // intervals that a mean is taken over

    using Samples = std::vector<MotionSample>;
    using Member  = double MotionSample::*;

    struct Range
    {
      double low = nan, high = nan;

      double
      width() const
      {
        return high - low;
      }
    };

    /** Of the numbers among the values from index `first` on. */
    Range
    range(const Samples &samples, const std::size_t first, const Member member)
    {
      Range result;
      for (std::size_t i = first; i < samples.size(); ++i)
        {
          result.low  = std::fmin(result.low, samples[i].*member);
          result.high = std::fmax(result.high, samples[i].*member);
        }
      return result;
    }


    /** Index of the first sample after half a turn of the marker, or the number of samples. */
    std::size_t
    after_first_half_turn(const Samples &samples)
    {
      std::size_t i = 0;
      while (i < samples.size() && std::abs(samples[i].alpha - samples[0].alpha) < 1.)
        ++i;
      return i;
    }


    bool
    is_steady(const Samples &samples)
    {
      const double start = samples.back().time - 0.2 * (samples.back().time - samples.front().time);
      std::size_t  first = samples.size() - 1;
      while (first > 0 && samples[first - 1].time >= start)
        --first;
      const Range D = range(samples, first, &MotionSample::D), theta = range(samples, first, &MotionSample::theta);
      const bool  is_round = D.high < 1e-3; // then the long axis is noise
      return samples.size() - first >= 4 && D.width() < 1e-3 && (is_round || !(theta.width() >= 1e-3));
    }


    /** Turns per unit of time, from the whole half turns that `angle` makes from index `first` on. */
    double
    turning_frequency(const Samples &samples, const std::size_t first, const Member angle)
    {
      std::size_t begin = first;
      while (begin < samples.size() && std::isnan(samples[begin].*angle))
        ++begin;
      if (begin >= samples.size())
        return nan;
      const double start = samples[begin].*angle, turned = std::abs(samples.back().*angle - start), half_turns = std::floor(turned);
      if (half_turns < 1.)
        return nan;
      std::size_t i = begin;
      while (std::abs(samples[i].*angle - start) < half_turns)
        ++i;
      const double before = std::abs(samples[i - 1].*angle - start), after = std::abs(samples[i].*angle - start);
      const double time = samples[i - 1].time + (half_turns - before) / (after - before) * (samples[i].time - samples[i - 1].time);
      return 0.5 * half_turns / (time - samples[begin].time);
    }


    struct Point
    {
      double time, value;
    };

    /** Extremum of the parabola through three samples; the middle one at the ends of the series. */
    Point
    refined(const Samples &samples, const std::size_t i)
    {
      const MotionSample &b = samples[i];
      if (i == 0 || i + 1 == samples.size())
        return {b.time, b.D};
      const MotionSample &a = samples[i - 1], &c = samples[i + 1];
      const double        left = (b.D - a.D) / (b.time - a.time), right = (c.D - b.D) / (c.time - b.time), curvature = (right - left) / (c.time - a.time);
      if (curvature == 0.)
        return {b.time, b.D};
      const double slope = left + curvature * (b.time - a.time), time = b.time - slope / (2. * curvature); // slope at b
      return {time, b.D - slope * slope / (4. * curvature)};
    }


    struct Extrema
    {
      std::vector<Point> maxima, minima;
    };

    /** Maxima and minima of D by turns, each at least a fifth of the whole range away from the last; those that the series begins or ends with do not count. */
    Extrema
    extrema(const Samples &samples, const std::size_t first)
    {
      Extrema      result;
      const double least = 0.2 * range(samples, first, &MotionSample::D).width();
      if (!(least > 2e-5))
        return result;
      std::size_t highest = first, lowest = first;
      int         sought = 0; // 1: a maximum, -1: a minimum, 0: either
      for (std::size_t i = first; i < samples.size(); ++i)
        {
          const double D = samples[i].D;
          if (D > samples[highest].D)
            highest = i;
          if (D < samples[lowest].D)
            lowest = i;
          if (sought >= 0 && D < samples[highest].D - least)
            {
              if (highest > first)
                result.maxima.push_back(refined(samples, highest));
              sought = -1;
              lowest = i;
            }
          else if (sought <= 0 && D > samples[lowest].D + least)
            {
              if (lowest > first)
                result.minima.push_back(refined(samples, lowest));
              sought  = 1;
              highest = i;
            }
        }
      return result;
    }


    /** By cubics, since steps differ in length; not numbers where a sample is not, or for fewer than four samples. */
    MotionMeans
    means(const Samples &samples, const double from, const double end)
    {
      if (samples.size() < 4 || !(end > from))
        return {};
      std::vector<double> times;
      Eigen::MatrixXd     values(samples.size(), 5);
      for (const MotionSample &s : samples)
        {
          values.row(times.size()) << s.D, s.theta, s.intrinsic_viscosity, s.N1, s.N2;
          times.push_back(s.time);
        }
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(values.cols());
      for (unsigned int n = 0; n <= n_of_mean; ++n)
        sum += (n == 0 || n == n_of_mean ? 0.5 : 1.) * interpolated(times, values, from + (end - from) * n / n_of_mean);
      sum /= n_of_mean;
      return {sum[0], sum[1], sum[2], sum[3], sum[4]};
    }


    /** As many whole periods as there are in a time, or all of it. */
    double
    whole_periods(const double time, const double period)
    {
      return time >= period ? period * std::floor(time / period) : time;
    }


    /** "\n  In the limit D_xz 0.3802 +- 0.0002, ...", nothing without limits. */
    std::string
    limits_text(const MotionLimits &limits)
    {
      std::ostringstream text;
      for (const auto &[name, limit] : limits.named())
        if (!std::isnan(limit.value))
          text << (text.str().empty() ? "\n  In the limit " : ", ") << name << ' ' << limit.value << " +- " << std::setprecision(2) << limit.error
               << std::setprecision(6);
      return text.str().empty() ? "" : text.str() + '.';
    }


    /** What the balance of energy needs of the last `n` samples. */
    struct EnergySeries
    {
      EnergySeries(const Samples &samples, const std::size_t n)
      {
        for (std::size_t i = samples.size() - n; i < samples.size(); ++i)
          {
            times.push_back(samples[i].time);
            energies.push_back(samples[i].stored_energy);
            powers.push_back(samples[i].power);
          }
      }

      std::vector<double> times, energies, powers;
    };


    MotionMode
    mode(const Samples &samples, const std::size_t first)
    {
      if (is_steady(samples))
        return MotionMode::steady;
      const bool shape_turns    = range(samples, first, &MotionSample::theta).width() >= 1.,
                 material_turns = range(samples, first, &MotionSample::delta).width() >= 1.;
      if (shape_turns)
        return material_turns ? MotionMode::transition : MotionMode::tumbling;
      return material_turns ? MotionMode::swinging : MotionMode::undetermined;
    }
  } // namespace


  MotionSummary
  motion_summary(const std::vector<MotionSample> &samples, const bool ended_steady)
  {
    MotionSummary s;
    if (samples.empty())
      return s;
    const std::size_t first   = after_first_half_turn(samples);
    s.mode                    = ended_steady ? MotionMode::steady : mode(samples, first);
    s.end                     = samples.back().time;
    s.from                    = first < samples.size() ? samples[first].time : nan;
    s.tank_treading_frequency = turning_frequency(samples, first, &MotionSample::delta);
    s.tumbling_frequency      = turning_frequency(samples, first, &MotionSample::theta);
    const Extrema     D       = extrema(samples, first);
    const std::size_t n       = D.maxima.size();
    if (n >= 2)
      s.D_period = (D.maxima.back().time - D.maxima.front().time) / (n - 1.);
    const Range ends  = range(samples, samples.size() - 1 - (samples.size() - 1) / 5, &MotionSample::D);
    s.D_minimum       = D.minima.empty() ? ends.low : D.minima.back().value;
    s.D_maximum       = D.maxima.empty() ? ends.high : D.maxima.back().value;
    const Range theta = range(samples, first, &MotionSample::theta);
    s.theta_minimum   = theta.low;
    s.theta_maximum   = theta.high;
    s.means           = means(samples, s.from, s.from + whole_periods(s.end - s.from, s.D_period));
    s.D_last          = samples.back().D;
    s.theta_last      = samples.back().theta;
    s.limits          = motion_limits(samples);
    const EnergySeries series(samples, samples.size());
    s.energy_defect = energy_defect(series.times, series.energies, series.powers);
    return s;
  }


  double
  last_energy_residual(const std::vector<MotionSample> &samples)
  {
    const EnergySeries series(samples, std::min<std::size_t>(samples.size(), 4));
    return energy_residual(series.times, series.energies, series.powers);
  }


  std::string
  word(const MotionMode mode)
  {
    switch (mode)
      {
        case MotionMode::steady:
          return "steady";
        case MotionMode::swinging:
          return "swinging";
        case MotionMode::tumbling:
          return "tumbling";
        case MotionMode::transition:
          return "transition";
        default:
          return "undetermined";
      }
  }


  std::string
  motion_text(const MotionSummary &s)
  {
    std::ostringstream text;
    text << "Motion: " << word(s.mode);
    if (s.mode == MotionMode::undetermined)
      text << " (the run is too short: the marker must turn by half a turn, then shape or material by another one)";
    else if (!std::isnan(s.from))
      text << ", judged from time " << s.from << " to " << s.end;
    text << ".\n  D_xz between " << s.D_minimum << " and " << s.D_maximum;
    if (!std::isnan(s.D_period))
      text << " with period " << s.D_period;
    text << "; at the end " << s.D_last << '.' << limits_text(s.limits);
    if (!std::isnan(s.tank_treading_frequency))
      text << "\n  Tank-treading: " << s.tank_treading_frequency << " turns per unit of time (period " << 1. / s.tank_treading_frequency << ").";
    if (!std::isnan(s.tumbling_frequency))
      text << "\n  Tumbling: " << s.tumbling_frequency << " turns per unit of time (period " << 1. / s.tumbling_frequency << ").";
    if (!std::isnan(s.energy_defect))
      text << "\n  Balance of energy: the steps have left over " << std::setprecision(2) << s.energy_defect << " of the shell's work.";
    return text.str();
  }
} // namespace tanktread
