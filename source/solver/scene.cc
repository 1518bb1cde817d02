// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules in a box of liquid, put together.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/coupling/shell_neighbours.h>
#include <tanktread/solver/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    CapsuleQuadrature
    quadrature(const SceneDescription &scene, const CapsuleKind &kind, const double finest_cell)
    {
      CapsuleQuadrature result = capsule_quadrature(kind.shape, kind.shell_quadrature, scene.solver.interface, finest_cell, scene.liquids.viscosity_ratio);
      if (kind.coupling_quadrature)
        result.coupling = *kind.coupling_quadrature;
      return result;
    }


    Capsules
    make_capsules(const SceneDescription &scene, const FluidMesh &mesh)
    {
      const double                                finest_cell = mesh.cell_size(mesh.film_level()); // that there may be
      std::vector<std::unique_ptr<const Capsule>> kinds;
      for (const CapsuleKind &kind : scene.kinds)
        kinds.push_back(std::make_unique<Capsule>(kind.shape, quadrature(scene, kind, finest_cell), kind.shell, kind.moduli, kind.stress_free));
      return {std::move(kinds), scene.kind_of.empty() ? std::vector<unsigned int>(scene.places.size(), 0) : scene.kind_of};
    }
  } // namespace


  Scene::Scene(SceneDescription description, const MPI_Comm communicator)
    : description_(std::move(description))
    , communicator_(communicator)
    , fluid_(communicator, description_.box, description_.fluid_mesh, description_.solver.method)
    , capsules_(make_capsules(description_, fluid_.mesh()))
    , layout_(capsules_, communicator, description_.n_teams)
    , elasticity_(layout_)
    , coupling_(layout_, description_.solver.interface)
    , level_(description_.liquids, elasticity_, coupling_, memory_, timings_)
    , solver_(description_.solver, level_, memory_, timings_)
  {
    // In a Krylov iteration the cells that a shell cuts are, with the jumps, about as much work as all others, of which there are three times as many (doc/performance.md, "Many capsules on one rank").
    fluid_.set_work_of_cells_with_points(description_.solver.interface == Interface::enriched ? 3. : 1.);
  }


  State
  Scene::initial_state() const
  {
    State result;
    for (const unsigned int c : layout_.own())
      {
        result.capsules.emplace_back();
        result.capsules.back().x     = placed(capsules_[c].initial(), description_.places[c]);
        result.capsules.back().force = ControlPoints::Zero(capsules_[c].n_control_points(), 3);
      }
    return result;
  }


  Scene::Surroundings
  Scene::surroundings(const State &state, const std::vector<ShellFields> &others)
  {
    Surroundings result;
    result.film = thinnest_film(level_.shells(state));
    on_all_ranks(communicator_, [&] {
      if (layout_.leads())
        result.points = Coupling::points(level_.shells(state));
    });
    for (const ShellFields &x : others)
      {
        ShellConfigurations shells;
        for (unsigned int i = 0; i < x.size(); ++i)
          shells.push_back(std::make_shared<ShellConfiguration>(capsule(i), x[i]));
        if (const double film = thinnest_film(shells); film > 0.) // predicted ones may overlap
          result.film = std::min(result.film, film);
        on_all_ranks(communicator_, [&] {
          if (!layout_.leads())
            return;
          const std::vector<dealii::Point<3>> further = Coupling::points(shells);
          result.points.insert(result.points.end(), further.begin(), further.end());
        });
      }
    return result;
  }


  void
  Scene::refine_around(const State &state, const std::vector<ShellFields> &others)
  {
    const Timings::Scope scope(timings_, "Fluid mesh and multigrid");
    const Surroundings   near = surroundings(state, others);
    if (fluid_.adapt(near.points, near.film))
      {
        mesh_shells_ = {positions(state)};
        mesh_shells_.insert(mesh_shells_.end(), others.begin(), others.end());
      }
    level_.attach(fluid_);
  }


  void
  Scene::restore_mesh(std::vector<ShellFields> shells, const unsigned int finest_level)
  {
    const Timings::Scope scope(timings_, "Fluid mesh and multigrid");
    State                first;
    for (const ControlPoints &x : shells.at(0))
      {
        first.capsules.emplace_back();
        first.capsules.back().x = x;
      }
    fluid_.adapt_to_level(surroundings(first, {shells.begin() + 1, shells.end()}).points, finest_level);
    level_.attach(fluid_);
    mesh_shells_ = std::move(shells);
  }


  void
  Scene::reassign(const std::vector<unsigned int> &team_of)
  {
    layout_.assign(team_of);
    coupling_.reassign();
    level_.reassign();
    solver_.reassign();
  }


  bool
  Scene::covers(const State &state, const std::vector<ShellFields> &others)
  {
    const Surroundings near = surroundings(state, others);
    return fluid_.mesh().suits(near.film) && fluid_.mesh().covers(near.points, coupling_.knows_motion() ? 0.5 : 1.);
  }


  bool
  Scene::contains(const ShellFields &x) const
  {
    ShellConfigurations shells;
    for (unsigned int i = 0; i < x.size(); ++i)
      shells.push_back(std::make_shared<ShellConfiguration>(capsule(i), x[i]));
    return distance_from_faces(shells) > 0.;
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
    return smallest_gap(layout_, level_.shells(state), periods(), 4. * level_.finest_cell());
  }


  double
  Scene::distance_from_faces(const State &state)
  {
    return distance_from_faces(level_.shells(state));
  }


  double
  Scene::distance_from_faces(const ShellConfigurations &shells) const
  {
    std::array<double, 3> half_sides;
    for (unsigned int d = 0; d < 3; ++d)
      half_sides[d] = description_.box.is_periodic(d) ? std::numeric_limits<double>::infinity() : 0.5 * description_.box.side[d];
    return -layout_.max(-smallest_distance_from_faces(shells, half_sides));
  }


  double
  Scene::thinnest_film(const ShellConfigurations &shells) const
  {
    const FluidMesh &mesh = fluid_.mesh();
    if (!mesh.follows_films())
      return std::numeric_limits<double>::infinity();
    double result = smallest_gap(layout_, shells, periods(), 4. * description_.fluid_mesh.finest_cell).gap;
    if (!description_.liquids.unbounded) // there the faces are no walls
      result = std::min(result, distance_from_faces(shells));
    return result; // the same on all ranks
  }


  std::string
  Scene::refusal(const State &state)
  {
    const ShellGap     smallest = gap(state);
    std::ostringstream message;
    if (smallest.gap <= 0.)
      message << "capsules " << smallest.first + 1 << " and " << smallest.second + 1 << " overlap by " << std::abs(smallest.gap) << " a";
    else if (description_.liquids.unbounded)
      {
        const double distance = distance_from_faces(state);
        if (distance < UnboundedLiquid::least_distance)
          message << "a capsule is " << distance << " a from a face of the box, less than the " << UnboundedLiquid::least_distance
                  << " a that unbounded liquid needs (Scene/Box side)";
      }
    return message.str();
  }
} // namespace tanktread
