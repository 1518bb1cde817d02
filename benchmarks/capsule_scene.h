// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the capsule whose computation is measured.

#ifndef tanktread_benchmarks_capsule_scene_h
#define tanktread_benchmarks_capsule_scene_h

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/scene.h>
#include <tanktread/surface/capsule_shape.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tanktread
{
  constexpr double shear_number = 0.2, reduced_bending = 0.04, box_side = 10.;


  /** What the program makes of such parameters. */
  inline SceneDescription
  sheared_sphere(const unsigned int cells, const Interface interface = Interface::plain)
  {
    SceneDescription result;
    result.box                    = box_side;
    result.liquids.flow.amplitude = simple_shear();
    result.shape                  = make_capsule({}, std::max(1l, std::lround(std::log2(cells / 8.))));
    result.moduli                 = {1. / shear_number, reduced_bending / shear_number};
    result.fluid_mesh             = {box_side / cells, 2.5, 1.5};
    result.solver.interface       = interface;
    return result;
  }


  /** The capsule, stretched along a direction between x and z and compressed along two others. */
  inline ControlPoints
  deformed(const Capsule &capsule)
  {
    const double    c = std::cos(dealii::numbers::PI / 6.), s = std::sin(dealii::numbers::PI / 6.);
    Eigen::Matrix3d turn; // from +x towards +z
    turn << c, 0., s, 0., 1., 0., -s, 0., c;
    return capsule.initial() * Eigen::Vector3d(1.3, 0.9, 1. / 1.17).asDiagonal() * turn;
  }


  /** The capsule with control points x and a new mesh around it, with a zero flow. */
  inline State
  refine_around(Scene &scene, const ControlPoints &x)
  {
    State state         = scene.initial_state();
    state.capsules[0].x = x;
    scene.refine_around(state);
    scene.coupling().move(scene.level().shells(state));
    scene.fluid().space().reinit(state.fluid);
    return state;
  }


  /** Backward Euler from the sphere at rest, with guesses and new meshes as TimeStepper and Simulation have them. */
  class Stepping
  {
  public:
    Stepping(Scene &scene, const double dt)
      : scene_(scene)
      , dt_(dt)
      , x_(scene.capsule().initial())
    {
      start_flow();
    }

    /** Whether the step to come can be extrapolated to. */
    bool
    has_previous() const
    {
      return !previous_.capsules.empty();
    }

    /** New mesh if the shell has left the fine cells; but at least every other step is extrapolated. */
    void
    refine_if_necessary()
    {
      if (has_previous() && !scene_.covers(state_))
        start_flow();
    }

    const ControlPoints &
    x() const
    {
      return x_;
    }

    NewtonReport
    step()
    {
      State guess = state_;
      if (has_previous())
        {
          scene_.level().carry_pressure(previous_);
          guess = combination({2., -1.}, {&state_, &previous_});
        }
      const NewtonReport report = scene_.solver().solve(guess, {{x_}, dt_});
      if (!report.converged)
        throw NumericalError("A time step failed: " + report.message);
      previous_ = std::exchange(state_, guess);
      x_        = state_.capsules[0].x;
      return report;
    }

  private:
    void
    start_flow()
    {
      state_ = refine_around(scene_, x_);
      scene_.solver().solve_flow(state_);
      previous_ = State();
    }

    Scene        &scene_;
    const double  dt_;
    ControlPoints x_;
    State         state_, previous_;
  };
} // namespace tanktread

#endif
