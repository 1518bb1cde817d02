// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the particle stress, known motions for the motion mode and its periods.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/observables.h>
#include <tanktread/simulation/step_history.h>
#include <tanktread/surface/surface_geometry.h>

#include "small_scene.h"

#include <cmath>
#include <iostream>

using namespace tanktread;

namespace
{
  /** An ellipsoid that has been sheared, with membrane and bending. */
  struct ShearedCapsule
  {
    ShearedCapsule()
      : shape(make_capsule(ellipsoid(1.3, 1.1, 1.), 2))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::second)
      , shell(surface, {}, {5., 0.2}, shape.control_points)
      , x(shape.control_points)
    {
      x.col(0) += 0.3 * x.col(2);
      x.col(1) += 0.1 * x.col(0);
      x.rowwise() += Eigen::RowVector3d(0.0137, 0.0271, 0.0314);
    }

    FittedShape        shape;
    SubdivisionSurface surface;
    Shell              shell;
    ControlPoints      x;
  };

  using Samples = std::vector<MotionSample>;

  /** Samples at steps that vary by half, of angles and deformation given as functions of time. */
  template <typename Theta, typename Delta, typename D>
  Samples
  motion(const double end, const Theta &theta, const Delta &delta, const D &deformation)
  {
    Samples samples;
    for (double t = 0., step = 0.07; t <= end; t += step)
      {
        samples.push_back({t, deformation(t), theta(t), theta(t) + delta(t) + 0.25, delta(t)});
        step = 0.07 + 0.035 * std::sin(7. * t);
      }
    return samples;
  }
} // namespace


TEST(ParticleStress, IsTheRateOfWorkAgainstTheShell)
{
  // S : E is the rate at which the elastic energy grows in a straining flow E x that carries the shell along.
  const ShearedCapsule  capsule;
  const Eigen::Matrix3d S = particle_stress(capsule.x, capsule.shell.force(capsule.x));
  EXPECT_LT((S - S.transpose()).norm(), 1e-14);
  EXPECT_NEAR(S.trace(), 0., 1e-13);
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero(), extension = Eigen::Vector3d(1., -0.7, -0.3).asDiagonal();
  shear(0, 2) = shear(2, 0) = 0.5;
  shear(0, 1) = shear(1, 0) = -0.2;
  for (const Eigen::Matrix3d &E : {shear, extension})
    {
      const double eps    = 1e-5;
      const auto   energy = [&](const double s) {
        const Shell::Energy e = capsule.shell.energy(capsule.x + s * capsule.x * E);
        return e.membrane + e.bending;
      };
      const double work = (S.cwiseProduct(E)).sum(), rate = (energy(eps) - energy(-eps)) / (2. * eps);
      EXPECT_GT(std::abs(rate), 0.1);
      EXPECT_NEAR(work, rate, 1e-7 * std::abs(rate));
    }
}


TEST(ParticleStress, APressureJumpHasNoPartInIt)
{
  const ShearedCapsule capsule;
  EXPECT_LT(particle_stress(capsule.x, volume_gradient(capsule.surface, capsule.x)).norm(), 1e-12);
}


TEST(ParticleStress, IsWhatTheWallsFeel)
{
  // Tested with the velocity (g(z), 0, 0), g = z near the capsule and linear from there to zero at the walls, the discrete momentum balance says what the mean
  // velocity of the disturbance in two planes
  // on either side of the capsule is: -S_xz (1 - 2 z_1 / l) / (mu l^2 l) above, the opposite below. It is the slope of the mean flow to the walls, the stress
  // on these.
  const ShearedCapsule capsule;
  const double         side = 5., z_1 = 1.25, cell = 0.3125;
  SceneDescription     description = small_scene({5., 0.2}, 1., {}, tight(1e-9, 1e-9), side, cell);
  description.kinds[0].shape       = {capsule.shape.topology, capsule.x};
  description.kinds[0].stress_free = capsule.shape.control_points;
  description.places               = {Place()};
  StartedScene scene(std::move(description));
  ASSERT_LT(scene.x().col(2).cwiseAbs().maxCoeff(), z_1);
  scene.solver().solve_flow(scene.state);

  PointInterpolation interpolation(scene.fluid().space());
  const auto         mean_velocity = [&](const double z) {
    const dealii::QGauss<1>       rule(3); // exact for the quadratic functions
    std::vector<dealii::Point<3>> points;
    std::vector<double>           weights, values;
    const unsigned int            n = std::lround(side / cell);
    for (unsigned int i = 0; i < 3 * n; ++i)
      for (unsigned int j = 0; j < 3 * n; ++j)
        {
          points.emplace_back(-0.5 * side + cell * (i / 3 + rule.point(i % 3)[0]), -0.5 * side + cell * (j / 3 + rule.point(j % 3)[0]), z);
          weights.push_back(rule.weight(i % 3) * rule.weight(j % 3) / (n * n));
        }
    interpolation.reinit(points);
    interpolation.values(scene.state.fluid, values);
    double sum = 0.;
    for (unsigned int r = 0; r < interpolation.local_points().size(); ++r)
      sum += weights[interpolation.local_points()[r]] * values[3 * r];
    return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  };
  const double difference = mean_velocity(z_1) - mean_velocity(-z_1), at_walls = -side * side * side * difference / (side - 2. * z_1);
  const double S_xz = particle_stress(scene.x(), scene.state.capsules[0].force)(0, 2);
  std::cout << "S_xz " << S_xz << ", of the walls " << at_walls << std::endl;
  EXPECT_GT(S_xz, 0.1);
  EXPECT_NEAR(at_walls, S_xz, 1e-6 * S_xz);
}


TEST(Rheology, HasTheSignsOfTheFlow)
{
  Eigen::Matrix3d S = Eigen::Vector3d(5., -4., -1.).asDiagonal();
  S(0, 2) = S(2, 0) = 7.;
  const Rheology r  = rheology(S, 2., 1.);
  EXPECT_EQ(r.intrinsic_viscosity, 3.5);
  EXPECT_EQ(r.normal_difference_1, 3.);
  EXPECT_EQ(r.normal_difference_2, 1.5);
  EXPECT_TRUE(std::isnan(rheology(S, 2., 0.).intrinsic_viscosity));
}


TEST(Motion, Swinging)
{
  // The material goes round once in 14, so D oscillates with period 7.
  const auto D = [](const double t) { return 0.2 + 0.05 * std::cos(2. * M_PI * t / 7.); };
  const auto s = motion_summary(motion(
    40.,
    [](double t) { return 0.15 + 0.1 * std::cos(2. * M_PI * t / 7.); },
    [](double t) { return -t / 7.; },
    D));
  EXPECT_EQ(s.mode, MotionMode::swinging);
  EXPECT_NEAR(s.tank_treading_frequency, 1. / 14., 1e-10);
  EXPECT_TRUE(std::isnan(s.tumbling_frequency));
  EXPECT_NEAR(s.D_period, 7., 1e-4);
  EXPECT_NEAR(s.D_minimum, 0.15, 1e-5);
  EXPECT_NEAR(s.D_maximum, 0.25, 1e-5);
  EXPECT_NEAR(s.theta_minimum, 0.05, 1e-4);
  EXPECT_NEAR(s.theta_maximum, 0.25, 1e-4);
  EXPECT_NEAR(s.means.D, 0.2, 1e-5); // over four whole periods
  EXPECT_NEAR(s.means.theta, 0.15, 1e-5);
  EXPECT_TRUE(std::isnan(s.means.N1));
}


TEST(Motion, Tumbling)
{
  const auto D = [](const double t) { return 0.05 + 0.03 * std::cos(4. * M_PI * t / 13.); };
  const auto s = motion_summary(motion(
    40.,
    [](double t) { return 0.25 - 2. * t / 13.; },
    [](double t) { return 0.1 * std::sin(4. * M_PI * t / 13.); },
    D));
  EXPECT_EQ(s.mode, MotionMode::tumbling);
  EXPECT_NEAR(s.tumbling_frequency, 1. / 13., 1e-10);
  EXPECT_TRUE(std::isnan(s.tank_treading_frequency));
  EXPECT_NEAR(s.D_period, 6.5, 1e-4);
}


TEST(Motion, TransitionSteadyAndTooShort)
{
  const auto at_rest = [](double) { return 0.1; };
  const auto wave    = [](double t) { return 0.1 + 0.01 * std::sin(t); };
  const auto both    = motion_summary(motion(
    40.,
    [](double t) { return -t / 20.; },
    [](double t) { return -t / 10.; },
    wave));
  EXPECT_EQ(both.mode, MotionMode::transition);
  EXPECT_NEAR(both.tumbling_frequency, 1. / 40., 1e-10);
  EXPECT_NEAR(both.tank_treading_frequency, 1. / 20., 1e-10);

  // A first swing of more than half a turn on the way to a steady inclination is not tumbling.
  const auto settling = [](double t) { return 0.17 - 0.6 * (1. - std::exp(-t)); };
  const auto steady   = motion_summary(motion(
    40.,
    settling,
    [](double t) { return -t / 10.; },
    at_rest));
  EXPECT_EQ(steady.mode, MotionMode::steady);
  EXPECT_NEAR(steady.tank_treading_frequency, 1. / 20., 1e-10);
  EXPECT_TRUE(std::isnan(steady.D_period));
  EXPECT_EQ(motion_summary(motion(
                             40.,
                             settling,
                             [](double t) { return -t / 10.; },
                             wave))
              .mode,
            MotionMode::swinging);

  // Less than a turn of the material; a shape that has no inclination.
  EXPECT_EQ(motion_summary(motion(
                             9.,
                             at_rest,
                             [](double t) { return -t / 10.; },
                             wave))
              .mode,
            MotionMode::undetermined);
  const auto nothing = [](double) { return std::nan(""); };
  EXPECT_EQ(motion_summary(motion(5., nothing, nothing, [](double t) { return 0.2 * std::exp(-8. * t); })).mode, MotionMode::steady);
  EXPECT_EQ(motion_summary({}).mode, MotionMode::undetermined);
}


TEST(Motion, ARunThatEndsSteadyIsSteady)
{
  // Of this run alone one would say that it is too short: D still changes in its last fifth, and less than half a turn of the marker is over.
  const auto samples = motion(
    3.,
    [](double t) { return 0.25 - 0.1 * (1. - std::exp(-t)); },
    [](double t) { return -t / 10.; },
    [](double t) { return 0.3 * (1. - std::exp(-t)); });
  EXPECT_EQ(motion_summary(samples).mode, MotionMode::undetermined);
  EXPECT_EQ(motion_summary(samples, false).mode, MotionMode::undetermined);
  const MotionSummary steady = motion_summary(samples, true);
  EXPECT_EQ(steady.mode, MotionMode::steady);
  EXPECT_EQ(motion_text(steady).rfind("Motion: steady.\n", 0), 0u) << motion_text(steady);
  // All else is as it is without that word.
  EXPECT_EQ(steady.D_last, samples.back().D);
  EXPECT_EQ(steady.D_maximum, motion_summary(samples).D_maximum);
  EXPECT_EQ(steady.end, samples.back().time);
  EXPECT_EQ(motion_summary({}, true).mode, MotionMode::undetermined);
}


TEST(StepHistory, PositionsBetweenLevelsAreThoseOfThePolynomial)
{
  TimeParameters time;
  for (const TimeScheme scheme : {TimeScheme::bdf2, TimeScheme::bdf3})
    {
      time.scheme       = scheme;
      const double cube = scheme == TimeScheme::bdf3 ? 5. : 0.;
      const auto   x    = [&](const double t) -> ShellFields {
        return {ControlPoints::Constant(2, 3, 1. + 2. * t - 3. * t * t + cube * t * t * t), ControlPoints::Constant(2, 3, t * t)};
      };
      StepHistory history(time);
      for (const double t : {-1., 0.1, 0.25, 0.3})
        history.add(t, x(t));
      for (const double t : {0.25, 0.27, 0.3})
        for (const unsigned int c : {0, 1})
          EXPECT_LT((history.at(t)[c] - x(t)[c]).norm(), 1e-13);
    }
  const auto  square = [](const double t) -> ShellFields { return {ControlPoints::Constant(2, 3, t * t)}; };
  StepHistory one{TimeParameters()};
  one.add(0.5, square(0.5));
  EXPECT_EQ(one.at(0.5), square(0.5));
  one.add(0.7, square(0.7));
  EXPECT_LT((one.at(0.6)[0] - 0.5 * (square(0.5)[0] + square(0.7)[0])).norm(), 1e-14);
}
