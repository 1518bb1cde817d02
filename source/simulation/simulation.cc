// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one run from the initial shapes to the end time.

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/number_text.h>
#include <tanktread/base/output_file.h>
#include <tanktread/base/output_folder.h>
#include <tanktread/base/version.h>
#include <tanktread/simulation/scene_description.h>
#include <tanktread/simulation/simulation.h>
#include <tanktread/solver/team_choice.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** Which capsules are of which kind; empty if all are of one. */
    std::string
    kinds_text(const Parameters &parameters)
    {
      std::string text;
      std::size_t last = 0;
      for (const KindParameters &kind : parameters.kinds)
        {
          const std::size_t first = last + 1, n = kind.placement.centres.size();
          last += n;
          text += (text.empty() ? "" : "; ") + (n == 1 ? std::to_string(first) : std::to_string(first) + " to " + std::to_string(last)) + ": " + kind.section;
          if (!kind.is_first())
            text += ", size " + number_text(kind.shape.size) + " a, E h times " + number_text(kind.young_modulus_factor) + ", kappa_B times " +
              number_text(kind.bending_modulus_factor);
        }
      return parameters.kinds.size() > 1 ? text : "";
    }


    RunDescription
    description(const Parameters &parameters, const unsigned int n_ranks)
    {
      RunDescription run;
      run.parameter_file = parameters.file;
      run.n_ranks        = n_ranks;
      run.flow           = word(parameters.scene.flow);
      run.has_rate       = parameters.scene.flow != Flow::quiescent;
      run.G              = 1. / parameters.scene.surface_young_modulus();
      run.khat           = parameters.scene.bending_modulus() / parameters.scene.surface_young_modulus();
      const Box box      = parameters.scene.box();
      for (unsigned int d = 0; d < 3; ++d)
        run.box += (d == 0 ? "" : " x ") + number_text(box.side[d]) + (box.is_periodic(d) ? " periodic" : "");
      if (parameters.scene.boundary == Boundary::unbounded)
        {
          run.box += " in unbounded liquid";
          run.included.push_back("the unbounded liquid beyond the box (Boundary unbounded: its flow of the shells' forces holds on all faces)");
          run.left_out.push_back("means over the box in suspension.csv (unbounded liquid has no volume: nan)");
        }
      run.n_capsules = parameters.n_capsules();
      run.kinds      = kinds_text(parameters);
      run.Re         = parameters.scene.reynolds_number;
      if (run.Re == 0.)
        run.left_out.push_back("inertia (Re = 0)");
      if (parameters.scene.viscosity_ratio == 1.)
        run.left_out.push_back("variable viscosity (ratio 1: Laplace form, each velocity component by itself)");
      else
        run.included.push_back("variable viscosity (ratio " + number_text(parameters.scene.viscosity_ratio) +
                               ": strain form, cells that the shell cuts integrated part by part)");
      if (parameters.solver.method == StokesMethod::assembled)
        run.included.push_back("assembled matrices and algebraic multigrid (Method assembled), in place of matrix-free operators and geometric multigrid");
      const auto any = [&parameters](const auto &condition) { return std::any_of(parameters.kinds.begin(), parameters.kinds.end(), condition); };
      for (const KindParameters &kind : parameters.kinds)
        if (kind.shape.prestress != 0.)
          run.included.push_back("prestress (inflation by " + number_text(kind.shape.prestress) + (kind.is_first() ? ")" : ", " + kind.section + ")"));
      if (any([](const KindParameters &kind) { return kind.shape.stress_free != StressFreeShape::initial; }))
        run.included.push_back("a stress-free shape other than the initial one");
      const bool is_thin = !any([](const KindParameters &kind) { return kind.shell.thickness > 0.; });
      if (is_thin)
        run.left_out.push_back("shell thickness (0)");
      if (parameters.solver.interface == Interface::plain)
        run.left_out.push_back("the kink of the velocity and the jump of the pressure inside the cells that the shell cuts (Interface plain)");
      if (parameters.control_mesh_stays_even())
        run.included.push_back("control points that move along the shell to stay evenly spread (Even control mesh), not with the material; steps of at most " +
                               number_text(PointsAlong::longest_step_factor) + " mu a^2 R / kappa_B, R the smallest radius of curvature");
      if (!any([](const KindParameters &kind) { return kind.shell.law != MembraneLaw::none; }))
        run.left_out.push_back("the membrane: the shell bends only (Membrane law none)");
      if (!parameters.bends())
        run.left_out.push_back(is_thin ? "bending and second derivatives of the surface (khat = 0)" : "Helfrich bending (khat = 0)");
      return run;
    }


    /** How fast axes (a) and inclination (radians) change; the latter counts where the section has one. */
    double
    rate_of_change(const InertiaEllipsoid &before, const InertiaEllipsoid &after, const double length)
    {
      const bool   is_round = before.taylor_parameter < 1e-4 && after.taylor_parameter < 1e-4;
      const double turn     = is_round ? 0. : std::remainder(after.inclination - before.inclination, dealii::numbers::PI);
      const double change   = std::max({std::abs(after.L - before.L), std::abs(after.B - before.B), std::abs(after.W - before.W), std::abs(turn)});
      return change / length;
    }
  } // namespace


  Simulation::Simulation(const Parameters &parameters, const MPI_Comm communicator, std::ostream &screen)
    : parameters_(parameters)
    , communicator_(communicator)
    , log_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0, screen)
    , scene_(scene_description(parameters), communicator)
    , memory_(parameters.time)
    , stepper_(parameters.time, parameters.solver.coupling, parameters.scene.end_time, scene_, memory_.steps, log_, parameters.control_mesh_stays_even())
    , state_(scene_.initial_state())
    , resolution_(parameters, scene_, memory_.warnings, log_)
    , checkpoints_(parameters, communicator, log_)
  {
    memory_.next_fields     = parameters.output.field_interval;
    memory_.next_checkpoint = parameters.output.checkpoint_interval;
    stepper_.start(memory_.time, positions(state_));
  }


  unsigned int
  Simulation::refine_around_shells(const std::vector<ShellFields> &others)
  {
    stepper_.refine_around(state_, others);
    // The explicit coupling moves the shells with this flow; implicit steps only begin with it.
    return parameters_.solver.coupling == TimeCoupling::explicit_euler ? scene_.solver().solve_flow(state_, memory_.time) : 0;
  }


  void
  Simulation::settle_owners()
  {
    const std::vector<unsigned int> team_of = chosen_teams(scene_.coupling());
    bool                            same    = true;
    for (unsigned int c = 0; c < team_of.size(); ++c)
      same = same && team_of[c] == scene_.layout().team_of(c);
    if (same)
      return;
    const CapsuleMoves moves(scene_.layout(), team_of);
    stepper_.reassign(moves, state_);
    for (ShellFields &x : scene_.mesh_shells())
      x = moves.moved(x);
    memory_.capsules = moves.moved(memory_.capsules);
    scene_.reassign(team_of);
    scene_.level().move_points(state_);
  }


  unsigned int
  Simulation::first_flow()
  {
    scene_.refine_around(state_);
    scene_.fluid().space().reinit(state_.fluid);
    if (!scene_.level().has_inertia())
      return scene_.solver().solve_flow(state_, memory_.time);
    scene_.solver().start_undisturbed(state_);
    return 0;
  }


  void
  Simulation::make_folder()
  {
    const std::string folder = parameters_.output.directory;
    std::string       moved_to;
    on_first_rank(communicator_, [&] {
      moved_to = prepare_output_folder(folder);
      log_.open(folder + "/log.txt");
      replace_file(folder + "/used_parameters.prm", parameters_.used);
    });
    log_.header(description(parameters_, dealii::Utilities::MPI::n_mpi_processes(communicator_)));
    if (parameters_.accuracy.target_error > 0.)
      log_.line(accuracy_text(parameters_));
    if (!moved_to.empty())
      log_.line("The folder held a former run, now in " + moved_to + ".");
    results_ = std::make_unique<Results>(folder, scene_.layout(), parameters_.output.surface_subdivisions);
  }


  void
  Simulation::start()
  {
    StepResult first;
    first.linear_iterations = first_flow();

    const FluidMesh   &mesh = scene_.fluid().mesh();
    std::ostringstream text;
    for (unsigned int k = 0; k < scene_.capsules().n_kinds(); ++k)
      {
        const Capsule &kind = scene_.capsules().kind(k);
        text << "Shell" << (k == 0 ? "" : " of kind " + std::to_string(k + 1)) << ": " << kind.n_control_points() << " control points, "
             << kind.surface().n_points() << " quadrature points, " << kind.coupling_surface().n_points() << " coupling points. ";
      }
    text << "Fluid: cells from " << mesh.cell_size(mesh.coarsest_level()) << " a to " << mesh.cell_size(mesh.finest_level()) << " a, "
         << mesh.triangulation().n_global_active_cells() << " now, with " << scene_.fluid().space().velocity->partitioner()->size() << " velocity and "
         << scene_.fluid().space().pressure->partitioner()->size() << " pressure unknowns.";
    log_.line(text.str());
    record(first, observe_capsules(), false);
    settle_owners();
  }


  bool
  Simulation::is_steady(const double length)
  {
    double fastest = 0.;
    for (std::size_t c = 0; c < state_.capsules.size(); ++c)
      fastest = std::max(fastest, rate_of_change(memory_.capsules[c].ellipsoid, inertia_ellipsoid(scene_.capsule(c).surface(), state_.capsules[c].x), length));
    fastest = scene_.layout().max(fastest);
    // Three steps in a row: at an extremum of the shape one alone may be quiet.
    memory_.n_quiet_steps = fastest < parameters_.time.steady_tolerance ? memory_.n_quiet_steps + 1 : 0;
    return memory_.n_quiet_steps == 3;
  }


  bool
  Simulation::limits_are_known()
  {
    if (parameters_.time.limit_tolerance == 0.)
      return false;
    double error = 0.;
    for (const CapsuleMemory &capsule : memory_.capsules)
      error = std::max(error, motion_limits(capsule.motion).largest_error());
    error = scene_.layout().max(error);
    // Three steps in a row: one bar alone may be small by chance.
    memory_.n_known_steps = error < parameters_.time.limit_tolerance ? memory_.n_known_steps + 1 : 0;
    return memory_.n_known_steps == 3;
  }


  bool
  Simulation::is_due(double &next, const double interval) const
  {
    if (memory_.time < next - rounding())
      return false;
    if (interval == 0.)
      return true;
    while (next <= memory_.time + rounding())
      next += interval;
    return true;
  }


  StepResult
  Simulation::step()
  {
    constexpr std::size_t max_meshes = 4; // three stages that end apart, and one that first was not where it is on finer cells
    unsigned int          remeshing  = 0;
    if (const std::vector<ShellFields> predicted = stepper_.predicted(state_, memory_.time); !scene_.covers(state_, predicted))
      {
        remeshing = refine_around_shells(predicted);
        settle_owners();
      }
    std::vector<ShellFields> ends;
    StepResult               result = stepper_.step(state_, memory_.time, false);
    result.linear_iterations += remeshing;
    while (result.beyond_mesh)
      {
        ends.push_back(*result.beyond_mesh);
        log_.line("Step of length " + number_text(result.length) + " repeated on a mesh around its " + (ends.size() == 1 ? "end" : "stages and its end") +
                  " too: the shells have left the finest cells.");
        remeshing        = refine_around_shells(ends);
        StepResult again = stepper_.step(state_, memory_.time, ends.size() == max_meshes);
        again.newton_iterations += result.newton_iterations;
        again.linear_iterations += result.linear_iterations + remeshing;
        result = std::move(again);
      }
    return result;
  }


  void
  Simulation::go_on(Checkpoints::Found found)
  {
    const std::string folder = parameters_.output.directory;
    checkpoints_.forget_after(found.step);
    on_first_rank(communicator_, [&] {
      std::error_code ignored;
      std::filesystem::remove(folder + "/stop", ignored);
      log_.reopen(folder + "/log.txt", found.log_size);
      replace_file(folder + "/used_parameters.prm", parameters_.used);
    });
    log_.line("Resumed at time " + number_text(found.time) + ", step " + std::to_string(found.step) + ", from " + folder + "/checkpoints/" + found.name +
              " on " + std::to_string(dealii::Utilities::MPI::n_mpi_processes(communicator_)) + " rank(s), " + program_version() + ".");
    results_ = std::make_unique<Results>(folder, scene_.layout(), parameters_.output.surface_subdivisions, &found.progress);
    restore({scene_, memory_, state_}, std::move(found.snapshot));
  }


  bool
  Simulation::save(const bool last)
  {
    const Request request  = checkpoints_.wanted();
    const double  interval = parameters_.output.checkpoint_interval;
    const bool    due      = interval > 0. && (is_due(memory_.next_checkpoint, interval) || last); // a run that has ended can be made longer
    if (request == Request::none && !due)
      return false;
    return checkpoints_.write({scene_, memory_, state_}, results_->progress()) && request == Request::stop;
  }


  std::string
  Simulation::advance()
  {
    bool steady = false, known = false;
    for (bool last = memory_.time >= parameters_.scene.end_time - rounding(); !last;)
      {
        StepResult result = step();
        memory_.time += result.length;
        ++memory_.n_steps;
        steady                  = is_steady(result.length);
        const Observed observed = observe_capsules();
        known                   = limits_are_known();
        last                    = steady || known || memory_.time >= parameters_.scene.end_time - rounding();
        record(result, observed, last);
        if (steady)
          log_.line("Steady: axes and inclination have changed slower than Time/Steady tolerance in three steps.");
        if (known)
          log_.line("Steady: what the shape relaxes to has been known to Time/Limit tolerance in three steps.");
        if (save(last) && !last)
          {
            log_.line("Stopped as asked for; --resume goes on from here.");
            return "stopped";
          }
      }
    return steady || known ? "steady" : "done";
  }


  std::string
  Simulation::run(const bool resume)
  {
    const Meeting meeting(communicator_);
    std::string   outcome;
    auto          found = resume ? checkpoints_.find() : std::nullopt;
    if (!found)
      {
        if (resume)
          log_.line("There is no checkpoint to resume from in " + parameters_.output.directory + ": the run starts from the beginning.");
        make_folder();
      }
    try
      {
        if (found)
          go_on(std::move(*found));
        else
          start();
        outcome = advance();
        summarise(outcome);
      }
    catch (const NumericalError &error)
      {
        if (!meeting.all_come())
          throw; // the other ranks have not failed, and wait for this one elsewhere: nothing can be written together
        const std::string reason = error.what() + warnings_before_failure(memory_.warnings);
        log_.line("FAILED at time " + std::to_string(memory_.time) + ": " + reason);
        log_.line("Last good state: " + results_->write_failed(state_) + ".");
        summarise("failed");
        log_.timings(scene_.timings());
        throw NumericalError(reason);
      }
    log_.timings(scene_.timings());
    return outcome;
  }
} // namespace tanktread
