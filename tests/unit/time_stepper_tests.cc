// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of single time steps: rejections, lengths, meshes that are too small, shells that would overlap.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/time_stepper.h>
#include <tanktread/surface/mesh_quality.h>
#include <tanktread/surface/surface_geometry.h>

#include "small_scene.h"

#include <memory>
#include <sstream>

using namespace tanktread;

namespace
{
  /** A scene with its flow, and a stepper at its first level, time 0. */
  struct SteppedScene
  {
    SteppedScene(SceneDescription      description,
                 const TimeParameters &time,
                 const double          end_time = 100.,
                 const TimeCoupling    coupling = TimeCoupling::implicit_newton,
                 const bool            even     = false)
      : scene(std::move(description))
      , memory(time)
      , log(is_root(), screen)
      , stepper(time, coupling, end_time, scene, memory, log, even)
    {
      scene.solver().solve_flow(scene.state);
    }

    void
    start()
    {
      stepper.start(0., positions(scene.state));
    }

    /** Whether the log has that text, on all ranks. */
    bool
    says(const std::string &text) const
    {
      return dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, screen.str().find(text) != std::string::npos, 0);
    }

    StartedScene       scene;
    StepMemory         memory;
    std::ostringstream screen;
    Log                log;
    TimeStepper        stepper;
  };

  TimeParameters
  steps(const double length, const TimeScheme scheme = TimeScheme::bdf2)
  {
    TimeParameters result;
    result.scheme = scheme;
    result.step   = length;
    return result;
  }

  double
  largest_difference(const ShellFields &a, const ShellFields &b)
  {
    double result = 0.;
    for (std::size_t c = 0; c < a.size(); ++c)
      result = std::max(result, (a[c] - b[c]).cwiseAbs().maxCoeff());
    return result;
  }

  /** Two spheres with that gap between them along x, in shear, no bending. */
  SceneDescription
  two_spheres(const double gap, const double shear_rate, const Interface interface)
  {
    SceneDescription result = small_scene({5., 0.}, shear_rate, {}, tight(1e-5, 1e-2, interface), 10., 0.3125);
    const double     middle = 1. + 0.5 * gap;
    result.places           = {Eigen::RowVector3d(-middle, 0.03, 0.02), Eigen::RowVector3d(middle, 0.03, 0.02)};
    return result;
  }
} // namespace


TEST(TimeStepper, RejectedStepsAreHalvedAndGrowBack)
{
  SceneDescription description             = small_scene({5., 0.2}, 1., {}, tight(1e-7, 0.1));
  description.solver.max_newton_iterations = 2;
  SteppedScene run(std::move(description), steps(0.2));
  run.start();
  double       time = 0., length = 0.2;
  unsigned int n_rejected = 0, n_grown = 0;
  for (unsigned int i = 0; i < 4; ++i)
    {
      // What was allowed, as often halved as necessary.
      const double     before   = run.memory.next_length;
      const StepResult result   = run.stepper.step(run.scene.state, time, false);
      const double     halvings = std::log2(before / result.length);
      EXPECT_NEAR(halvings, std::round(halvings), 1e-12);
      EXPECT_GE(halvings, -1e-12);
      EXPECT_FALSE(result.beyond_mesh);
      EXPECT_EQ(run.memory.next_length, std::min(0.2, 1.5 * result.length));
      EXPECT_EQ(run.memory.previous.front().time, time);
      n_rejected += halvings > 0.5;
      n_grown += result.length > length;
      length = result.length;
      time += length;
      EXPECT_EQ(largest_difference(run.stepper.position(time), positions(run.scene.state)), 0.);
    }
  EXPECT_GT(n_rejected, 0u);
  EXPECT_GT(n_grown, 0u);
  EXPECT_TRUE(run.says("Step of length 0.2 failed from the last state: no convergence in 2 Newton iterations (residuals"));
}


TEST(TimeStepper, AStepThatCannotBeDoneLeavesTheStateAsItWas)
{
  SceneDescription description             = small_scene({5., 0.2}, 1., {}, tight(1e-12, 0.1));
  description.solver.max_newton_iterations = 1;
  SteppedScene run(std::move(description), steps(0.2));
  run.start();
  const State before = run.scene.state;
  try
    {
      run.stepper.step(run.scene.state, 0., false);
      ADD_FAILURE();
    }
  catch (const NumericalError &error)
    {
      EXPECT_STREQ(
        error.what(),
        "No time step between 0.0002 and 0.2 could be solved (none is tried below 0.0002); the last attempt: no convergence in 1 Newton iterations.");
    }
  EXPECT_EQ(run.scene.x(), before.capsules[0].x);
  EXPECT_EQ(run.scene.state.capsules[0].force, before.capsules[0].force);
  EXPECT_EQ(run.scene.state.capsules[0].pressure_jump, before.capsules[0].pressure_jump);
}


TEST(TimeStepper, TheFirstStepIsOfSecondOrder)
{
  // Against eight steps over the same time: the error of a step goes with the third power of its length, and is far below that of backward Euler.
  const SceneDescription description = small_scene({1., 0.02}, 1., {}, tight(1e-9, 1e-3));
  const auto             result      = [&](const double end, const unsigned int n, const TimeScheme scheme) {
    SteppedScene run(description, steps(end / n, scheme));
    run.start();
    for (unsigned int i = 0; i < n; ++i)
      run.stepper.step(run.scene.state, end / n * i, false);
    return positions(run.scene.state);
  };
  std::vector<double> errors;
  for (const double length : {0.2, 0.1})
    {
      const ShellFields fine = result(length, 8, TimeScheme::bdf2);
      errors.push_back(largest_difference(result(length, 1, TimeScheme::bdf2), fine));
      const double euler = largest_difference(result(length, 1, TimeScheme::backward_euler), fine);
      if (is_root())
        std::cout << "error of a step of " << length << ": " << errors.back() << ", of backward Euler " << euler << std::endl;
      EXPECT_LT(errors.back(), 0.1 * euler);
    }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 2.5);
}


namespace
{
  /** An ellipsoid without membrane in a liquid at rest. */
  SceneDescription
  bending_alone(const BendingForm form)
  {
    SceneDescription result    = small_scene({1., 1.}, 0., ellipsoid(1.4, 1.2, 1.), tight(1e-8, 1e-2));
    result.kinds[0].shell.law  = MembraneLaw::none;
    result.kinds[0].shell.form = form;
    return result;
  }

  struct Relaxed
  {
    Eigen::Vector3d axes; // L, B, W
    ShellFields     x;
    double          volume_error;
  };

  Relaxed
  relax(const BendingForm form, const double end, const unsigned int n, const TimeScheme scheme, const bool even)
  {
    SteppedScene run(bending_alone(form), steps(end / std::max(n, 1u), scheme), 100., TimeCoupling::implicit_newton, even);
    run.start();
    for (unsigned int i = 0; i < n; ++i)
      EXPECT_EQ(run.stepper.step(run.scene.state, end / n * i, false).length, end / n);
    const Capsule         &capsule = run.scene.capsule();
    const InertiaEllipsoid shape   = inertia_ellipsoid(capsule.surface(), run.scene.x());
    return {{shape.L, shape.B, shape.W}, positions(run.scene.state), enclosed_volume(capsule.surface(), run.scene.x()) / capsule.volume() - 1.};
  }
} // namespace


TEST(TimeStepper, ShapesMoveTheSameWhereverTheirPointsAre)
{
  // Control points that are material and others: different places on the same shapes.
  for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
    {
      const Relaxed start = relax(form, 0., 0, TimeScheme::bdf3, false), material = relax(form, 0.1, 5, TimeScheme::bdf3, false),
                    even  = relax(form, 0.1, 5, TimeScheme::bdf3, true);
      const double change = (material.axes - start.axes).norm(), difference = (even.axes - material.axes).norm(),
                   places = largest_difference(even.x, material.x);
      if (is_root())
        std::cout << "axes change by " << change << ", differ by " << difference << ", points by " << places << "; volume error " << even.volume_error
                  << std::endl;
      EXPECT_GT(change, 0.05);
      EXPECT_LT(difference, 0.01 * change);
      EXPECT_GT(places, 10. * difference);
      EXPECT_LT(std::abs(even.volume_error), 1e-7);
    }
}


TEST(TimeStepper, ShapesNearASphereRelaxAsTheoryHasIt)
{
  // Either form of the bending forces: w falls with exp(-96/35 t) for l = 2, theory (16c).
  for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
    {
      SceneDescription description = bending_alone(form);
      description.kinds[0].shape   = make_capsule(ellipsoid(1.03, 1., 0.97), 2);
      description.box              = 7.5;
      description.box.faces.fill(Faces::prescribed);
      description.liquids.unbounded = true;
      description.solver            = tight(1e-9, 1e-2, Interface::enriched);
      SteppedScene run(std::move(description), steps(0.05, TimeScheme::sdirk3), 100., TimeCoupling::implicit_newton, true);
      run.start();
      const auto   size   = [&] { return inertia_ellipsoid(run.scene.capsule().surface(), run.scene.x()).taylor_parameter; };
      const double before = size();
      for (unsigned int i = 0; i < 4; ++i)
        run.stepper.step(run.scene.state, 0.05 * i, false);
      const double rate = std::log(before / size()) / 0.2;
      if (is_root())
        std::cout << "rate " << rate << ", theory " << 96. / 35. << std::endl;
      EXPECT_NEAR(rate, 96. / 35., 0.02 * 96. / 35.);
    }
}


TEST(TimeStepper, StepsOfPointsThatMoveAlongAreShort)
{
  for (const bool even : {false, true})
    {
      SteppedScene run(bending_alone(BendingForm::moment_only), steps(0.08), 100., TimeCoupling::implicit_newton, even);
      run.start();
      const double longest = PointsAlong::longest_step_factor * smallest_radius_of_curvature(run.scene.capsule().surface(), run.scene.x());
      EXPECT_LT(longest, 0.075);
      EXPECT_EQ(run.stepper.step(run.scene.state, 0., false).length, even ? longest : 0.08);
    }
}


TEST(TimeStepper, StepsAreAsAccurateWithPointsThatMoveAlong)
{
  // Differences of the axes after 8 and 16 steps. Where the points are is of first order in the step, and shows in the shape by the error of the control mesh.
  for (const TimeScheme scheme : {TimeScheme::bdf2, TimeScheme::sdirk2, TimeScheme::bdf3})
    {
      const auto difference = [&](const bool even) {
        return (relax(BendingForm::moment_only, 0.16, 8, scheme, even).axes - relax(BendingForm::moment_only, 0.16, 16, scheme, even).axes).norm();
      };
      const double material = difference(false), along = difference(true);
      if (is_root())
        std::cout << "scheme of order " << order(scheme) << ": " << material << ", with points that move along " << along << std::endl;
      EXPECT_LT(along, 1.5 * material + 1e-5);
    }
}


TEST(TimeStepper, StepsEndAtTheEndTime)
{
  SteppedScene run(small_scene({5., 0.2}, 1., {}, tight(1e-5, 0.1)), steps(0.1), 0.14);
  run.start();
  EXPECT_EQ(run.stepper.step(run.scene.state, 0., false).length, 0.1);
  EXPECT_NEAR(run.stepper.step(run.scene.state, 0.1, false).length, 0.04, 1e-15);
}


TEST(TimeStepper, StepsWithALargeLocalErrorAreRepeated)
{
  // Two equal steps set the history; the third one may be judged.
  TimeParameters time = steps(0.2);
  time.tolerance      = 1e-4;
  SteppedScene run(small_scene({20., 0.2}, 1., ellipsoid(1.4, 1.2, 1.), tight(1e-6, 0.1)), time);
  EXPECT_NEAR(run.memory.next_length, std::sqrt(2e-4), 1e-15); // the first length
  run.memory.next_length = 0.2;
  run.start();
  double now = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    {
      const double     asked  = run.memory.next_length;
      const StepResult result = run.stepper.step(run.scene.state, now, false);
      EXPECT_LE(result.length, asked);
      EXPECT_LE(run.memory.next_length, 1.5 * result.length + 1e-15);
      now += result.length;
      if (i < 2)
        run.memory.next_length = 0.2; // too long on purpose
    }
  EXPECT_TRUE(run.says(" repeated: its local error is "));
  EXPECT_LT(now, 0.59);
}


TEST(TimeStepper, AStepBeyondTheFinestCellsIsReported)
{
  // The mesh has finest cells for a part of the way of this step only.
  SceneDescription description      = small_scene({2., 0.}, 1., {}, tight(1e-5, 1e-2, Interface::enriched), 5., 0.15625);
  description.fluid_mesh.band_width = 1.;
  const double length               = 1.5;
  SteppedScene run(description, steps(length));
  run.start();
  const State      before = run.scene.state;
  const StepResult beyond = run.stepper.step(run.scene.state, 0., false);
  ASSERT_TRUE(beyond.beyond_mesh);
  EXPECT_EQ(beyond.length, length);
  EXPECT_EQ(largest_difference(positions(run.scene.state), positions(before)), 0.);
  EXPECT_GT(beyond.newton_iterations, 0u);

  // On a mesh around both ends the same step is made...
  run.stepper.refine_around(run.scene.state, {*beyond.beyond_mesh});
  const StepResult again = run.stepper.step(run.scene.state, 0., false);
  EXPECT_FALSE(again.beyond_mesh);
  EXPECT_EQ(again.length, length);
  // ... and ends where the first attempt did, but for the coarser cells there.
  const double difference = largest_difference(positions(run.scene.state), *beyond.beyond_mesh);
  if (is_root())
    std::cout << "difference of the two attempts " << difference << std::endl;
  EXPECT_LT(difference, 0.05);

  // With a mesh that cannot be better it is shortened.
  SteppedScene other(description, steps(length));
  other.start();
  const StepResult shorter = other.stepper.step(other.scene.state, 0., true);
  EXPECT_FALSE(shorter.beyond_mesh);
  EXPECT_LT(shorter.length, length);
  EXPECT_TRUE(other.says("rejected: the shells leave the finest cells of the fluid."));
  EXPECT_EQ(other.scene.coupling().jumps().n_coarse_cut_cells(), 0u);
}


TEST(TimeStepper, AStepThatMakesShellsOverlapIsRejected)
{
  // Pushed together: by the last two levels each of the spheres has come 0.3 a nearer to the other in 0.1, which BDF2 goes on with. (A step of backward Euler cannot make shells pass through each other: it
  // traces them back along one velocity.)
  for (const Interface interface : {Interface::plain, Interface::enriched})
    {
      SteppedScene run(two_spheres(0.1, 0., interface), steps(0.1));
      ShellFields  before = positions(run.scene.state);
      for (unsigned int i = 0; i < before.size(); ++i) // the rank's own ones
        before[i].col(0).array() += run.scene.layout().own()[i] == 0 ? -0.3 : 0.3;
      run.stepper.start(-0.1, before);
      run.start();
      const double     gap     = run.scene.gap(run.scene.state).gap;
      const StepResult result  = run.stepper.step(run.scene.state, 0., false);
      const double     gap_now = run.scene.gap(run.scene.state).gap;
      if (is_root())
        std::cout << "gap " << gap << ", then " << gap_now << " after a step of " << result.length << std::endl;
      EXPECT_NEAR(gap, 0.1, 0.01);
      EXPECT_LT(result.length, 0.06);
      EXPECT_GT(gap_now, 0.);
      EXPECT_LT(gap_now, gap);
      EXPECT_TRUE(run.says("Step of length 0.100000 rejected: capsules 1 and 2 overlap by "));
    }
}


TEST(TimeStepper, NoStepIsMadeOfShellsThatOverlap)
{
  for (const TimeCoupling coupling : {TimeCoupling::implicit_newton, TimeCoupling::explicit_euler})
    {
      SteppedScene run(two_spheres(-0.05, 0., Interface::plain), steps(0.1), 100., coupling);
      run.start();
      const State before = run.scene.state;
      try
        {
          run.stepper.step(run.scene.state, 0., false);
          ADD_FAILURE() << run.scene.gap(run.scene.state).gap;
        }
      catch (const NumericalError &error)
        {
          EXPECT_NE(std::string(error.what()).find("capsules 1 and 2 overlap by 0.0"), std::string::npos) << error.what();
        }
      EXPECT_EQ(largest_difference(positions(run.scene.state), positions(before)), 0.);
    }
}
