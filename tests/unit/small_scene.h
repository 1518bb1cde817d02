// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: small scenes for tests.

#ifndef tanktread_tests_small_scene_h
#define tanktread_tests_small_scene_h

#include <deal.II/base/mpi.h>

#include <tanktread/solver/scene.h>

#include <algorithm>
#include <utility>

namespace tanktread
{
  inline bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }


  inline CapsuleShapeParameters
  ellipsoid(const double x, const double y, const double z)
  {
    CapsuleShapeParameters capsule;
    capsule.shape       = Shape::ellipsoid;
    capsule.axes        = {{x, y, z}};
    capsule.inclination = 0.1;
    return capsule;
  }


  inline SolverParameters
  tight(const double newton, const double linear, const Interface interface = Interface::plain)
  {
    SolverParameters p;
    p.interface        = interface;
    p.newton_tolerance = newton;
    p.linear_tolerance = linear;
    return p;
  }


  /**
   * One capsule of 162 control points in shear, off the planes of symmetry, so that no quadrature point lies on a face of a fluid cell, where velocity
   * gradients jump. Finest cell 10a/32, box 5a or 10a.
   */
  inline SceneDescription
  small_scene(const ShellModuli            &moduli,
              const double                  shear_rate,
              const CapsuleShapeParameters &capsule,
              const SolverParameters       &solver,
              const double                  side        = 5.,
              const double                  finest_cell = 0.3125)
  {
    SceneDescription result;
    result.box                      = side;
    result.liquids.flow.amplitude   = simple_shear(shear_rate);
    result.kinds[0].shape           = make_capsule(capsule, 2);
    result.places                   = {Eigen::RowVector3d(0.0137, 0.0271, 0.0314)};
    result.kinds[0].moduli          = moduli;
    result.fluid_mesh.coarsest_cell = 1.25;
    result.fluid_mesh.finest_cell   = finest_cell;
    result.solver                   = solver;
    return result;
  }


  /** The same control mesh with the vertices of a face listed from another one on, so that it does not tell any more of which mesh it is a refinement. */
  inline SceneDescription
  without_coarser_control_meshes(SceneDescription scene)
  {
    auto &face = scene.kinds[0].shape.topology.faces.front();
    std::rotate(face.begin(), face.begin() + 1, face.end());
    return scene;
  }


  /** A scene on a mesh around its capsules, and its state: a liquid at rest. */
  struct StartedScene : Scene
  {
    explicit StartedScene(SceneDescription description)
      : Scene(std::move(description), MPI_COMM_WORLD)
      , state(initial_state())
    {
      refine();
    }

    /** New mesh around the present shells, with a zero flow. */
    void
    refine()
    {
      refine_around(state);
      fluid().space().reinit(state.fluid);
    }

    /** Control points of the first capsule. */
    ControlPoints &
    x()
    {
      return state.capsules[0].x;
    }

    void
    move_points()
    {
      coupling().move(level().shells(state));
    }

    State state;
  };
} // namespace tanktread

#endif
