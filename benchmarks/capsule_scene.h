// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the capsule whose computation is measured.

#ifndef tanktread_benchmarks_capsule_scene_h
#define tanktread_benchmarks_capsule_scene_h

#include <tanktread/simulation/time_stepper.h>
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
    result.kinds[0].shape         = make_capsule({}, std::max(1l, std::lround(std::log2(cells / 8.))));
    result.kinds[0].moduli        = {1. / shear_number, reduced_bending / shear_number};
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


  inline SceneDescription
  with_viscosity_ratio(SceneDescription scene, const double ratio)
  {
    scene.liquids.viscosity_ratio = ratio;
    return scene;
  }


  /** Two of its capsules, beside each other in the flow. */
  inline SceneDescription
  pair(SceneDescription scene)
  {
    scene.places = {Eigen::RowVector3d(-2.5, 0., 0.), Eigen::RowVector3d(2.5, 0., 0.)};
    return scene;
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


  /** Steps of the program from rest, BDF2, with its guesses and its meshes. */
  class Stepping
  {
  public:
    Stepping(Scene &scene, const double dt)
      : scene_(scene)
      , memory_(parameters(dt))
      , log_(false)
      , stepper_(parameters(dt), TimeCoupling::implicit_newton, 1e3, scene, memory_, log_)
      , state_(scene.initial_state())
    {
      scene.refine_around(state_);
      scene.fluid().space().reinit(state_.fluid);
      scene.solver().solve_flow(state_);
      stepper_.start(0., positions(state_));
    }

    double
    time() const
    {
      return time_;
    }
    const State &
    state() const
    {
      return state_;
    }

    /** With what a change of mesh before it, if there is one, and attempts on others take. */
    StepResult
    step()
    {
      if (!scene_.covers(state_))
        stepper_.refine_around(state_);
      StepResult result = stepper_.step(state_, time_, false);
      if (result.beyond_mesh)
        {
          stepper_.refine_around(state_, {*result.beyond_mesh});
          const StepResult first = std::exchange(result, stepper_.step(state_, time_, true));
          result.newton_iterations += first.newton_iterations;
          result.linear_iterations += first.linear_iterations;
        }
      time_ += result.length;
      return result;
    }

  private:
    static TimeParameters
    parameters(const double dt)
    {
      TimeParameters result;
      result.step = dt;
      return result;
    }

    Scene      &scene_;
    StepMemory  memory_;
    Log         log_;
    TimeStepper stepper_;
    State       state_;
    double      time_ = 0.;
  };
} // namespace tanktread

#endif
