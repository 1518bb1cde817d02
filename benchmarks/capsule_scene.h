// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the capsule whose computation is measured.

#ifndef tanktread_benchmarks_capsule_scene_h
#define tanktread_benchmarks_capsule_scene_h

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tanktread
{
  constexpr double shear_number = 0.2, reduced_bending = 0.04, box_side = 10.;


  /** What Simulation makes of the parameters, and a deformed shape. */
  struct Scene
  {
    explicit Scene(const unsigned int cells, const Interface interface = Interface::plain)
      : shape(make_capsule({}, std::max(1l, std::lround(std::log2(cells / 8.)))))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::second)
      , shell(surface, {}, {1. / shear_number, reduced_bending / shear_number}, shape.control_points)
      , mesh_parameters{box_side / cells, 2.5, 1.5}
      , fluid(MPI_COMM_WORLD, box_side, mesh_parameters)
      , coupling_surface(shape.topology,
                         coupling_quadrature(shape.topology, shape.control_points, interface, box_side / cells),
                         interface == Interface::plain ? Derivatives::first : Derivatives::second)
      , coupling(coupling_surface, area_weights(coupling_surface, shape.control_points), interface)
      , volume(enclosed_volume(surface, shape.control_points))
      , distributed_shell(shell, shape.topology, MPI_COMM_WORLD)
      , solver(parameters, distributed_shell, surface, coupling, volume, flow, timings)
    {
      const double    c = std::cos(dealii::numbers::PI / 6.), s = std::sin(dealii::numbers::PI / 6.);
      Eigen::Matrix3d turn; // from +x towards +z
      turn << c, 0., s, 0., 1., 0., -s, 0., c;
      deformed = shape.control_points * Eigen::Vector3d(1.3, 0.9, 1. / 1.17).asDiagonal() * turn;
    }

    /** New mesh around that shell, with a zero flow. */
    void
    refine_around(const ControlPoints &x)
    {
      fluid.adapt(coupling.points(x));
      solver.attach(fluid);
      coupling.move(x, volume_gradient(surface, x));
    }

    SolverParameters    parameters;
    const ShearFlow     flow{1.};
    FittedShape         shape;
    SubdivisionSurface  surface;
    Shell               shell;
    FluidMeshParameters mesh_parameters;
    Fluid               fluid;
    SubdivisionSurface  coupling_surface;
    Coupling            coupling;
    double              volume;
    DistributedShell    distributed_shell;
    Timings             timings;
    NewtonSolver        solver;
    ControlPoints       deformed;
  };


  /** Backward Euler from the sphere at rest, with guesses and new meshes as TimeStepper and Simulation have them. */
  class Stepping
  {
  public:
    Stepping(Scene &scene, const double dt)
      : scene_(scene)
      , dt_(dt)
    {
      state_.x = scene.shape.control_points;
      start_flow();
    }

    /** Whether the step to come can be extrapolated to. */
    bool
    has_previous() const
    {
      return previous_.x.size() > 0;
    }

    /** New mesh if the shell has left the fine cells; but at least every other step is extrapolated. */
    void
    refine_if_necessary()
    {
      if (has_previous() && !scene_.fluid.mesh().covers(scene_.coupling.points(state_.x)))
        start_flow();
    }

    const State &
    state() const
    {
      return state_;
    }

    NewtonReport
    step()
    {
      State guess = state_;
      if (has_previous())
        {
          scene_.solver.carry_pressure(previous_);
          guess.x += state_.x - previous_.x;
          guess.force += state_.force - previous_.force;
          guess.pressure_jump += state_.pressure_jump - previous_.pressure_jump;
          guess.fluid.sadd(2., -1., previous_.fluid);
        }
      const NewtonReport report = scene_.solver.solve(guess, state_.x, dt_);
      if (!report.converged)
        throw NumericalError("A time step failed: " + report.message);
      previous_ = std::exchange(state_, guess);
      return report;
    }

  private:
    void
    start_flow()
    {
      scene_.refine_around(state_.x);
      scene_.fluid.space().reinit(state_.fluid);
      scene_.solver.solve_flow(state_);
      previous_ = State();
    }

    Scene       &scene_;
    const double dt_;
    State        state_, previous_;
  };
} // namespace tanktread

#endif
