// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes solve by assembled matrices and algebraic multigrid, what it costs beside ours.

#ifndef tanktread_benchmarks_algebraic_base_line_h
#define tanktread_benchmarks_algebraic_base_line_h

#include <tanktread/fluid/algebraic_preconditioner.h>
#include <tanktread/fluid/linear_solver.h>

#include "capsule_scene.h"
#include "measurement.h"

#include <memory>

namespace tanktread
{
  /** Set-up and one solve. */
  struct SolverCost
  {
    double       set_up, solve; // s
    LinearReport report;

    /** What a mesh costs that lasts for `n` solves (s). */
    double
    total(const unsigned int n) const
    {
      return set_up + n * solve;
    }
  };


  /**
   * Spaces, operator and multigrid on the mesh of the scene, made anew, and a solve from zero. The mesh grows together with the multigrid; what p4est and
   * deal.II take to make
   * the same mesh alone is `mesh` (s), and not part of the set-up. Collective, like all that follows.
   */
  inline SolverCost
  cost_of_geometric(Scene &scene, const State &state, const FluidBlockVector &load, const double tolerance, double &mesh)
  {
    const auto  points     = scene.coupling().points(scene.level().shells(state));
    const auto &parameters = scene.description().fluid_mesh;
    const auto &fluid      = scene.fluid();
    mesh                   = median_time(5, [&] { FluidMesh(MPI_COMM_WORLD, box_side, parameters).adapt(points); });
    SolverCost cost;
    cost.set_up = median_time(5, [&] { Fluid(MPI_COMM_WORLD, box_side, parameters).adapt(points); }) - mesh;
    FluidBlockVector flow;
    cost.solve = median_time(5, [&] {
      fluid.space().reinit(flow);
      cost.report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), flow, load, tolerance, 200);
    });
    return cost;
  }


  /** The same with degrees of freedom, assembled matrices and the hierarchy of Trilinos ML on the mesh that is there. */
  inline SolverCost
  cost_of_algebraic(const Fluid &fluid, const FluidBlockVector &load, const double tolerance)
  {
    std::unique_ptr<AssembledStokes>         stokes;
    std::unique_ptr<AlgebraicPreconditioner> preconditioner;
    SolverCost                               cost;
    cost.set_up = median_time(1, [&] {
      stokes         = std::make_unique<AssembledStokes>(fluid.space());
      preconditioner = std::make_unique<AlgebraicPreconditioner>(*stokes);
    });
    ComponentVector loads, flow;
    stokes->reinit(loads);
    stokes->to_components(load, loads);
    cost.solve = median_time(3, [&] {
      stokes->reinit(flow);
      cost.report = solve_fgmres(*stokes, *preconditioner, flow, loads, tolerance, 200);
    });
    return cost;
  }


  /** Both, and the ratio for a mesh that lasts for ten solves. */
  inline Entries
  compare_with_algebraic(Scene &scene, const State &state, const FluidBlockVector &load, const double tolerance)
  {
    double           mesh;
    const SolverCost ours = cost_of_geometric(scene, state, load, tolerance, mesh), ml = cost_of_algebraic(scene.fluid(), load, tolerance);
    const auto       iterations = [](const std::string &name, const LinearReport &report) {
      return Entry{name, (report.converged ? "" : "failed after ") + std::to_string(report.iterations), 0.};
    };
    return {seconds("mesh alone", mesh),
            seconds("set-up", ours.set_up),
            iterations("iterations", ours.report),
            seconds("solve", ours.solve),
            seconds("ML set-up", ml.set_up),
            iterations("ML iterations", ml.report),
            seconds("ML solve", ml.solve),
            {"ML / ours, set-up and ten solves", formatted("%.1f", ml.total(10) / ours.total(10)), 0.}};
  }
} // namespace tanktread

#endif
