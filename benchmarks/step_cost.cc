// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what solves and time steps cost, mesh by mesh.
//
// Usage: mpirun -np N step_cost [--cells 32,64,128] [--dt 0.1] [--ml | --steps [--viscosity-ratio 1]]. Markdown tables on the standard output, progress on the standard error. A neo-Hookean
// sphere with
// bending (G = 0.2, khat = 0.04) in shear, box 10 a, h = 10 a/cells, shell of level log2(cells/8). With --ml the Stokes solves alone, compared with assembled
// matrices and
// algebraic multigrid; with --steps the steps with the enriched interface alone.

#include <deal.II/base/mpi.h>

#include <tanktread/base/mpi_errors.h>

#include "algebraic_base_line.h"
#include "capsule_scene.h"
#include "measurement.h"
#include "step_cost_options.h"

#include <iostream>
#include <memory>
#include <numeric>

using namespace tanktread;

namespace
{
  constexpr double       relative_tolerance = 1e-6;
  constexpr unsigned int max_iterations     = 200;

  /** Iterations and time of a linear solve. */
  Entry
  solve(const std::string &name, const LinearReport &report, const double time)
  {
    const std::string iterations = (report.converged ? "" : "failed after ") + std::to_string(report.iterations);
    return {name, iterations + ", " + formatted("%.3g", time), report.converged ? time : 0.};
  }


  /** One capsule of that shape with a shell of these moduli. */
  Capsules
  same_shape(const Capsule &capsule, const ShellModuli &moduli)
  {
    const CapsuleQuadrature                     rule{triangle_quadrature(3), triangle_quadrature(3)};
    std::vector<std::unique_ptr<const Capsule>> kinds;
    kinds.push_back(std::make_unique<Capsule>(FittedShape{capsule.topology(), capsule.initial()}, rule, ShellParameters(), moduli));
    return {std::move(kinds), {0}};
  }


  /** All shells deformed, at their places. */
  State
  deformed_state(const Scene &scene)
  {
    State result = scene.initial_state();
    for (CapsuleState &capsule : result.capsules)
      capsule.x += deformed(scene.capsule()) - scene.capsule().initial();
    return result;
  }


  /**
   * What is to be compared with a step: the Stokes equations from zero with one viscosity and the forces of the deformed shells, on the scene's mesh. Collective,
   * like all that follows.
   */
  struct StokesSolve
  {
    LinearReport report;
    double       time = 0.;
  };
  StokesSolve
  measure_stokes_solve(Scene &scene, FluidBlockVector &load)
  {
    const Fluid &fluid = scene.fluid();
    const State  state = deformed_state(scene);
    scene.coupling().move(scene.level().shells(state));
    ShellFields forces;
    for (const CapsuleState &capsule : state.capsules)
      forces.push_back(scene.capsule().shell().force(capsule.x));
    fluid.space().reinit(load);
    scene.coupling().spread(forces, load);
    StokesSolve      result;
    FluidBlockVector flow;
    result.time = median_time(5, [&] {
      fluid.space().reinit(flow);
      result.report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), flow, load, relative_tolerance, max_iterations);
    });
    return result;
  }


  /** Mesh and multigrid, and the Stokes equations. */
  void
  measure_stokes(Scene &scene, const bool ml, Measurement &result)
  {
    const Capsule   &capsule = scene.capsule();
    State            state;
    FluidBlockVector load;
    const double     set_up = median_time(1, [&] { state = refine_around(scene, deformed(capsule)); });
    const auto      &space  = scene.fluid().space();
    result.n_cells          = scene.fluid().mesh().triangulation().n_global_active_cells();

    const StokesSolve stokes = measure_stokes_solve(scene, load);
    result.problem           = {count("cells", result.n_cells),
                                count("velocity unknowns", space.velocity->partitioner()->size()),
                                count("pressure unknowns", space.pressure->partitioner()->size()),
                                count("control points", capsule.n_control_points()),
                                count("coupling points", capsule.coupling_surface().n_points()),
                                seconds("mesh and multigrid", set_up),
                                solve("Stokes solve, iterations and s", stokes.report, stokes.time)};
    if (ml)
      result.algebraic = compare_with_algebraic(scene, state, load, relative_tolerance);
  }


  /** Right-hand side with all blocks: forces of the shell on the fluid, divergence, flux, and the forces again as missing ones. */
  FluidBlockVector
  loads(const Fluid &fluid, const LinearisedShells &shells, const ShellLayout &layout, const ControlPoints &force)
  {
    FluidBlockVector result = layout.vector(fluid.space()), flow(result), product(result);
    shells.coupling().spread({force}, result);
    fluid.preconditioner().vmult(flow, result);
    fluid.stokes().vmult(product, flow);
    result.block(pressure_block) = product.block(pressure_block);
    layout.set(result, 0, 1., shells.damped(0, force));
    return result;
  }


  struct Stiffness
  {
    double stretching, bending; // tau E_s/(mu a) and tau kappa_B/(mu a^3)
  };


  /**
   * A linear solve of Newton's method for the shell x, around which the mesh is, in the undisturbed flow; the loads are those of the deformed shell. Points are
   * frozen, as
   * the solver does it so far from a solution. Returns the set-up of LinearisedShells (s).
   */
  double
  measure_implicit(Scene               &scene,
                   const std::string   &name,
                   const ControlPoints &x,
                   const Tangent        tangent,
                   const Stiffness     &stiffness,
                   const double         tau,
                   Entries             &entries)
  {
    const Capsule         &capsule  = scene.capsule();
    const Fluid           &fluid    = scene.fluid();
    const Capsules         with_law = same_shape(capsule, {stiffness.stretching / tau, stiffness.bending / tau});
    const Shell           &shell    = with_law[0].shell();
    const ShellLayout      layout_with_law(with_law, MPI_COMM_WORLD);
    const DistributedShell distributed(layout_with_law);
    const ShellLayout     &layout = scene.layout();
    SolverMemory           memory;
    ImplicitShells         implicit(layout, memory);
    State                  state                 = scene.initial_state();
    state.capsules[0].x                          = x;
    state.capsules[0].force                      = shell.force(x);
    const ShellFields                 velocities = scene.coupling().undisturbed_velocity(scene.level().flow(), shell_configurations(capsule, {x}));
    std::unique_ptr<LinearisedShells> linear;
    const double                      set_up = median_time(1, [&] {
      linear =
        std::make_unique<LinearisedShells>(distributed,
                                           scene.coupling(),
                                           state,
                                           shell_configurations(capsule, {x}),
                                           velocities,
                                           Linearisation{tau, scene.level().finest_cell(), 1e-8, PointDerivatives::frozen, tangent, scene.level().flow()},
                                           implicit);
    });
    const MonolithicOperator          matrix(fluid.stokes(), *linear, layout);
    KrylovBasis                       basis;
    const PressureJumpResponse        jumps({fluid.stokes()}, fluid.preconditioner(), scene.coupling(), 1., basis);
    const MonolithicPreconditioner    preconditioner(fluid.preconditioner(), *linear, layout, jumps);
    const FluidBlockVector            rhs = loads(fluid, *linear, layout, shell.force(deformed(capsule)));
    LinearReport                      report;
    const auto                        solve_once = [&] {
      FluidBlockVector solution = layout.vector(fluid.space());
      report                    = solve_fgmres(matrix, preconditioner, solution, rhs, relative_tolerance, max_iterations);
    };
    double time = median_time(1, solve_once);
    if (report.converged)
      time = median_time(3, solve_once);
    entries.push_back(solve(name + formatted(" (%g, ", stiffness.stretching) + formatted("%g)", stiffness.bending), report, time));
    return set_up;
  }


  Entries
  measure_implicit_solves(Scene &scene, const std::string &name, const ControlPoints &x, const Tangent tangent, const double tau)
  {
    const Stiffness stiffnesses[] = {{1., 0.}, {10., 0.}, {0., 0.1}, {0., 10.}, {10., 1.}, {10., 10.}};
    double          set_up        = 0.;
    Entries         result(1);
    for (const Stiffness &stiffness : stiffnesses)
      set_up += measure_implicit(scene, name, x, tangent, stiffness, tau, result);
    result[0] = seconds(name + " LinearisedShell", set_up / std::size(stiffnesses));
    return result;
  }


  /** Shares of the time that the steps have taken. */
  Entries
  shares(const Timings &timings, const double total)
  {
    const auto        share = [&](const std::string &name, const double time) { return Entry{name, formatted("%.1f%%", 100. * time / total), 0.}; };
    Entries           result;
    double            sum    = 0.;
    const std::string solver = "Linear solver";
    for (const char *name : {"- Stokes operator", "- V-cycle", "- pressure mass and gradient", "- coupling", "- shell", "- pressure jumps"})
      result.push_back(share(std::string(name).substr(2), timings.seconds(name)));
    result.push_back(share("orthogonalisation", timings.rest(solver)));
    for (const char *name : {"Shell tangent and factorisation", "Residual"})
      {
        result.push_back(share(name, timings.seconds(name)));
        sum += timings.seconds(name);
      }
    result.push_back(share("other", total - sum - timings.seconds(solver)));
    return result;
  }


  /** Steps of the program from rest; what is measured are those between the times 0.5 and 3. */
  Entries
  measure_steps(SceneDescription description, const double dt, const std::string &name)
  {
    forget_peak_memory();
    Scene scene(std::move(description), MPI_COMM_WORLD);
    scene.refine_around(deformed_state(scene));
    FluidBlockVector    load;
    const StokesSolve   stokes = measure_stokes_solve(scene, load);
    Stepping            stepping(scene, dt);
    std::vector<double> times, newton, linear;
    while (stepping.time() < 3. - 1e-9)
      {
        if (times.empty())
          scene.timings() = Timings();
        StepResult   result;
        const bool   is_measured = stepping.time() > 0.5 - 1e-9;
        const double time        = median_time(1, [&] { result = stepping.step(); });
        if (!is_measured)
          continue;
        times.push_back(time);
        newton.push_back(result.newton_iterations);
        linear.push_back(result.linear_iterations);
      }
    const double step = median(times), memory = peak_memory();
    Entries      result = {{"Newton iterations", formatted("%.0f", median(newton)), 0.},
                           {"linear iterations", formatted("%.0f", median(linear)), 0.},
                           seconds(name + "step", step),
                           {"over a Stokes solve", formatted("%.1f", step / stokes.time), 0.}};
    for (const Entry &share : shares(scene.timings(), std::accumulate(times.begin(), times.end(), 0.)))
      result.push_back(share);
    result.push_back({name + "peak memory, GB", formatted("%.2f", memory), memory});
    return result;
  }


  /** Stokes solves and implicit solves with the plain interface. The scene goes before steps are measured: their memory is their own. */
  template <typename Progress>
  void
  measure_solves(const unsigned int cells, const StepCostOptions &options, const Progress &progress, Measurement &result)
  {
    forget_peak_memory();
    Scene          scene(sheared_sphere(cells), MPI_COMM_WORLD);
    const Capsule &capsule = scene.capsule();
    measure_stokes(scene, options.ml, result);
    progress(result.problem);
    if (options.ml)
      progress(result.algebraic);
    if (options.ml || options.steps)
      return;
    result.solves = measure_implicit_solves(scene, "deformed", deformed(capsule), Tangent::positive, options.dt);
    progress(result.solves);
    refine_around(scene, capsule.initial());
    result.solves_at_sphere = measure_implicit_solves(scene, "sphere", capsule.initial(), Tangent::exact, options.dt);
    progress(result.solves_at_sphere);
  }


  Measurement
  measure(const unsigned int cells, const StepCostOptions &options)
  {
    Measurement result;
    result.mesh         = "10a/" + std::to_string(cells);
    const auto progress = [&](const Entries &entries) {
      if (is_first_rank())
        std::cerr << line(result.mesh, entries, &Entry::name) << line(result.mesh, entries, &Entry::text) << std::flush;
    };
    measure_solves(cells, options, progress, result);
    if (options.ml)
      return result;
    const SceneDescription enriched = sheared_sphere(cells, Interface::enriched);
    const auto             steps    = [&](const SceneDescription &description, const std::string &name, Entries &entries) {
      entries = measure_steps(description, options.dt, name);
      progress(entries);
    };
    if (options.steps)
      {
        steps(with_viscosity_ratio(enriched, options.ratio), "", result.steps);
        return result;
      }
    steps(sheared_sphere(cells), "plain ", result.plain_steps);
    steps(enriched, "", result.steps);
    steps(with_viscosity_ratio(enriched, 5.), "viscous ", result.viscous_steps);
    steps(pair(enriched), "pair's ", result.pair_steps);
    return result;
  }


  void
  work(const std::vector<std::string> &words)
  {
    const StepCostOptions    options = parse(words);
    std::vector<Measurement> all;
    for (const unsigned int cells : options.cells)
      all.push_back(measure(cells, options));
    if (!is_first_rank())
      return;
    const std::string dt = formatted("%g", options.dt);
    std::cout << "Ranks: " << dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) << "; relative tolerance of the linear solves: " << relative_tolerance
              << ".\n\n"
              << table("The mesh, and a Stokes solve from zero with the forces of a deformed shell:", all, &Measurement::problem);
    if (options.ml)
      std::cout << table("That solve, and the same with assembled matrices and algebraic multigrid (ML); set-up without what the mesh takes alone:",
                         all,
                         &Measurement::algebraic);
    else if (options.steps)
      std::cout << table("Steps of the program from rest, enriched interface:", all, &Measurement::steps);
    else
      std::cout
        << table("Implicit solves at the sphere with (dt E_s/(mu a), dt kappa_B/(mu a^3)), dt = " + dt + ", iterations and s:",
                 all,
                 &Measurement::solves_at_sphere)
        << table(
             "The same at the deformed shell, compressed in two directions, with the positive tangent, to which Newton's method resorts where the exact one is indefinite:",
             all,
             &Measurement::solves)
        << table("Steps of the program from rest, dt = " + dt +
                   ", medians between the times 0.5 and 3, and the shares of their time, the first five within the linear solver. Enriched interface:",
                 all,
                 &Measurement::steps)
        << table("Plain interface:", all, &Measurement::plain_steps) << table("Enriched, viscosity ratio 5:", all, &Measurement::viscous_steps)
        << table("Enriched, two capsules:", all, &Measurement::pair_steps);
    if (all.size() > 1 && !options.steps)
      std::cout << table_of_exponents(all);
  }
} // namespace


int
main(int argc, char *argv[])
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  argc = 1; // PETSc would take our options for its own.
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return exit_code_of(MPI_COMM_WORLD, [&words] { work(words); });
}
