// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what kind of motion a run shows, its periods and frequencies.

#ifndef tanktread_simulation_motion_h
#define tanktread_simulation_motion_h

#include <tanktread/simulation/motion_limits.h>

#include <limits>
#include <string>
#include <vector>

namespace tanktread
{
  /**
   * Shape, angles and rheology at one time. Angles in units of pi and continuous over many turns; not a number where they are not defined, as the rheology is outside
   * simple shear.
   */
  struct MotionSample
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double time;
    double D;                                     // Taylor parameter
    double theta;                                 // inclination of the long axis
    double alpha;                                 // of a marker on the shell
    double delta;                                 // alpha - theta, from its start
    double L = unknown, B = unknown, W = unknown; // semi-axes
    double intrinsic_viscosity = unknown, N1 = unknown, N2 = unknown;
    double stored_energy = unknown, power = unknown; // of the shell, and what it gives to the liquid
  };

  enum class MotionMode
  {
    steady,      // the shape has stopped changing; the shell may go round it
    swinging,    // the shell goes round, the long axis swings about a direction
    tumbling,    // the long axis goes round with the shell
    transition,  // both: the long axis goes round, the shell faster or slower
    undetermined // the run is too short to say
  };

  /** Over as many whole periods of D as there are since the motion can be judged, without a period until the end. */
  struct MotionMeans
  {
    double D = MotionSample::unknown, theta = MotionSample::unknown, intrinsic_viscosity = MotionSample::unknown, N1 = MotionSample::unknown,
           N2 = MotionSample::unknown;
  };

  /**
   * Result of motion_summary(). Times in the scene's unit, frequencies in turns per unit of time: a period of the material or of the shape is the inverse. The
   * shape comes back to
   * itself after half a turn, so D has twice the frequency. A number that the run is too short for is not a number.
   */
  struct MotionSummary
  {
    MotionMode   mode = MotionMode::undetermined;
    double       from = MotionSample::unknown, end = MotionSample::unknown;            // times between which the motion was judged
    double       tank_treading_frequency = MotionSample::unknown;                      // of the material against the shape, from delta
    double       tumbling_frequency      = MotionSample::unknown;                      // of the shape, from theta
    double       D_period                = MotionSample::unknown;                      // mean time between the maxima of D
    double       D_minimum = MotionSample::unknown, D_maximum = MotionSample::unknown; // of its last oscillation; of the last fifth of the run when it has none
    double       theta_minimum = MotionSample::unknown, theta_maximum = MotionSample::unknown; // between `from` and `end`
    MotionMeans  means;
    double       D_last = MotionSample::unknown, theta_last = MotionSample::unknown;
    MotionLimits limits;
    double       energy_defect = MotionSample::unknown; // what the steps have left over, relative to the shell's work
  };

  /**
   * Judges a series of samples in order of time by the rule of doc/theory.md, section 8.2: over the time after the first half turn of the marker, the shape
   * turns if
   * theta covers half a turn or more, the material if delta does; swinging, tumbling and transition are material alone, shape alone and both. Steady means that
   * D and theta / pi have
   * changed by less than 0.001 in the last fifth of the run, or that the run has ended because the shape had stopped changing (`ended_steady`).
   */
  MotionSummary
  motion_summary(const std::vector<MotionSample> &samples, bool ended_steady = false);

  /** energy_residual() of the last samples. */
  double
  last_energy_residual(const std::vector<MotionSample> &samples);

  /** The word for a mode. */
  std::string
  word(MotionMode mode);

  /** The summary in a few lines for the log. */
  std::string
  motion_text(const MotionSummary &summary);
} // namespace tanktread

#endif
