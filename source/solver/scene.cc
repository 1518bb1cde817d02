// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules in a box of liquid, put together.

#include <deal.II/base/mpi.h>

#include <tanktread/solver/scene.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    CapsuleQuadrature
    quadrature(const SceneDescription &scene, const FluidMesh &mesh)
    {
      CapsuleQuadrature result =
        capsule_quadrature(scene.shape, scene.shell_quadrature, scene.solver.interface, mesh.cell_size(mesh.finest_level()), scene.liquids.viscosity_ratio);
      if (scene.coupling_quadrature)
        result.coupling = *scene.coupling_quadrature;
      return result;
    }
  } // namespace


  Scene::Scene(SceneDescription description, const MPI_Comm communicator)
    : description_(std::move(description))
    , communicator_(communicator)
    , fluid_(communicator, description_.box, description_.fluid_mesh, description_.solver.method)
    , capsule_(description_.shape, quadrature(description_, fluid_.mesh()), description_.shell, description_.moduli, description_.stress_free)
    , elasticity_(capsule_.shell(), capsule_.topology(), communicator)
    , coupling_(capsule_, description_.places.size(), description_.solver.interface)
    , level_(description_.liquids, elasticity_, coupling_, memory_, timings_)
    , solver_(description_.solver, level_, memory_, timings_)
  {}


  State
  Scene::initial_state() const
  {
    State result;
    for (const Place &place : description_.places)
      {
        result.capsules.emplace_back();
        result.capsules.back().x     = placed(capsule_.initial(), place);
        result.capsules.back().force = ControlPoints::Zero(capsule_.n_control_points(), 3);
      }
    return result;
  }


  void
  Scene::refine_around(const State &state, const std::vector<ShellFields> &others)
  {
    const Timings::Scope          scope(timings_, "Fluid mesh and multigrid");
    std::vector<dealii::Point<3>> points = coupling_.points(level_.shells(state));
    for (const ShellFields &x : others)
      {
        const std::vector<dealii::Point<3>> further = coupling_.points(shell_configurations(capsule_, x));
        points.insert(points.end(), further.begin(), further.end());
      }
    fluid_.adapt(points);
    level_.attach(fluid_);
  }


  bool
  Scene::covers(const State &state)
  {
    return fluid_.mesh().covers(coupling_.points(level_.shells(state)), coupling_.knows_motion() ? 0.5 : 1.);
  }


  std::array<double, 3>
  Scene::periods() const
  {
    std::array<double, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      result[d] = description_.box.is_periodic(d) ? description_.box.side[d] : std::numeric_limits<double>::infinity();
    return result;
  }


  ShellGap
  Scene::gap(const State &state)
  {
    return smallest_gap(level_.shells(state), periods(), 4. * level_.finest_cell());
  }


  double
  Scene::distance_from_faces(const State &state)
  {
    std::array<double, 3> half_sides;
    for (unsigned int d = 0; d < 3; ++d)
      half_sides[d] = description_.box.is_periodic(d) ? std::numeric_limits<double>::infinity() : 0.5 * description_.box.side[d];
    return smallest_distance_from_faces(level_.shells(state), half_sides);
  }


  std::string
  Scene::refusal(const State &state)
  {
    const ShellGap     smallest = gap(state);
    std::ostringstream message;
    if (dealii::Utilities::MPI::broadcast(communicator_, smallest.gap, 0) <= 0.)
      message << "capsules " << smallest.first + 1 << " and " << smallest.second + 1 << " overlap by " << std::abs(smallest.gap) << " a";
    else if (description_.liquids.unbounded)
      {
        const double distance = dealii::Utilities::MPI::broadcast(communicator_, distance_from_faces(state), 0);
        if (distance < UnboundedLiquid::least_distance)
          message << "a capsule is " << distance << " a from a face of the box, less than the " << UnboundedLiquid::least_distance
                  << " a that unbounded liquid needs (Scene/Box side)";
      }
    return message.str();
  }
} // namespace tanktread
