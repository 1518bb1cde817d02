// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one run from the initial shape to the end time.

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/output_folder.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    Derivatives
    derivatives_needed(const Parameters &parameters)
    {
      return parameters.scene.bending_modulus() > 0. || parameters.shell.thickness > 0. ? Derivatives::second : Derivatives::first;
    }


    std::string
    number(const double value)
    {
      std::ostringstream text;
      text << value;
      return text.str();
    }


    RunDescription
    description(const Parameters &parameters, const unsigned int n_ranks)
    {
      RunDescription run;
      run.parameter_file = parameters.file;
      run.n_ranks        = n_ranks;
      run.shear          = parameters.scene.flow == Flow::shear;
      run.G              = 1. / parameters.scene.surface_young_modulus();
      run.khat           = parameters.scene.bending_modulus() / parameters.scene.surface_young_modulus();
      run.box_side       = parameters.scene.box_side;
      run.Re             = parameters.scene.reynolds_number;
      if (run.Re == 0.)
        run.left_out.push_back("inertia (Re = 0)");
      if (parameters.scene.viscosity_ratio == 1.)
        run.left_out.push_back("variable viscosity (ratio 1: Laplace form, each velocity component by itself)");
      else
        run.included.push_back("variable viscosity (ratio " + number(parameters.scene.viscosity_ratio) +
                               ": strain form, cells that the shell cuts integrated part by part)");
      if (parameters.shell.thickness == 0.)
        run.left_out.push_back("shell thickness (0)");
      if (parameters.solver.interface == Interface::plain)
        run.left_out.push_back("the kink of the velocity and the jump of the pressure inside the cells that the shell cuts (Interface plain)");
      if (parameters.shell.law == MembraneLaw::none)
        run.left_out.push_back("the membrane: the shell bends only (Membrane law none)");
      if (parameters.scene.bending_modulus() == 0.)
        run.left_out.push_back(parameters.shell.thickness == 0. ? "bending and second derivatives of the surface (khat = 0)" : "Helfrich bending (khat = 0)");
      return run;
    }


    SubdivisionSurface
    make_coupling_surface(const FittedShape &shape, const Interface interface, const double viscosity_ratio, const FluidMesh &mesh)
    {
      return {shape.topology,
              coupling_quadrature(shape.topology, shape.control_points, interface, mesh.cell_size(mesh.finest_level())),
              interface == Interface::enriched || viscosity_ratio != 1. ? Derivatives::second : Derivatives::first};
    }


    /** How fast axes (a) and inclination (radians) change. */
    double
    rate_of_change(const InertiaEllipsoid &before, const InertiaEllipsoid &after, const double length)
    {
      const double turn   = std::remainder(after.inclination - before.inclination, dealii::numbers::PI);
      const double change = std::max({std::abs(after.L - before.L), std::abs(after.B - before.B), std::abs(after.W - before.W), std::abs(turn)});
      return change / length;
    }
  } // namespace


  Simulation::Simulation(const Parameters &parameters, const MPI_Comm communicator)
    : parameters_(parameters)
    , communicator_(communicator)
    , first_rank_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , log_(first_rank_)
    , shape_(make_capsule(parameters.capsule, parameters.shell_mesh.level))
    , surface_(shape_.topology, triangle_quadrature(parameters.shell_mesh.quadrature), derivatives_needed(parameters))
    , shell_(surface_,
             parameters.shell,
             {parameters.scene.surface_young_modulus(), parameters.scene.bending_modulus()},
             make_stress_free_shape(parameters.capsule, shape_),
             shape_.control_points)
    , distributed_shell_(shell_, shape_.topology, communicator)
    , fluid_(communicator, parameters.scene.box_side, parameters.fluid_mesh, parameters.scene.reynolds_number > 0.)
    , coupling_surface_(make_coupling_surface(shape_, parameters.solver.interface, parameters.scene.viscosity_ratio, fluid_.mesh()))
    , coupling_(coupling_surface_, area_weights(coupling_surface_, shape_.control_points), parameters.solver.interface)
    , view_{shape_.topology, surface_, shell_, enclosed_volume(surface_, shape_.control_points)}
    , flow_{parameters.scene.flow == Flow::shear ? 1. : 0.}
    , solver_(parameters.solver,
              distributed_shell_,
              surface_,
              coupling_,
              view_.initial_volume,
              flow_,
              timings_,
              parameters.scene.viscosity_ratio,
              parameters.scene.reynolds_number)
    , stepper_(parameters.time, parameters.solver.coupling, parameters.scene.end_time, solver_, log_)
    , next_fields_(parameters.output.field_interval)
  {
    state_.x = shape_.control_points;
    stepper_.start(time_, state_.x);
    const Eigen::RowVector3d extent = 2. * state_.x.cwiseAbs().colwise().maxCoeff();
    if (extent.maxCoeff() >= parameters.scene.box_side)
      {
        std::ostringstream message;
        message << "Scene/Box side is " << parameters.scene.box_side << "; allowed: more than the capsule's extent, " << extent.maxCoeff() << '.';
        throw InputError(message.str());
      }
  }


  void
  Simulation::refine_around_shell()
  {
    const Timings::Scope                 scope(timings_, "Fluid mesh and multigrid");
    std::unique_ptr<const FieldTransfer> transfer;
    std::vector<FluidBlockVector *>      flows;
    for (State *const level : stepper_.levels(state_))
      {
        level->sides.clear(); // of the old mesh's vertices
        flows.push_back(&level->fluid);
      }
    if (solver_.has_inertia() && n_steps_ > 0)
      transfer = std::make_unique<FieldTransfer>(fluid_.space(), flows);
    fluid_.adapt(coupling_.points(state_.x));
    solver_.attach(fluid_);
    if (transfer)
      return transfer->interpolate(fluid_.space(), flows);
    stepper_.forget_flow();
    fluid_.space().reinit(state_.fluid);
  }


  unsigned int
  Simulation::flow_on_new_mesh()
  {
    if (!solver_.has_inertia())
      return solver_.solve_flow(state_);
    if (n_steps_ == 0)
      solver_.start_undisturbed(state_);
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
      std::ofstream file(folder + "/used_parameters.prm");
      if (!(file << parameters_.used << std::flush))
        throw InputError("Output/Directory: cannot write '" + folder + "/used_parameters.prm'.");
    });
    log_.header(description(parameters_, dealii::Utilities::MPI::n_mpi_processes(communicator_)));
    if (!moved_to.empty())
      log_.line("The folder held a former run, now in " + moved_to + ".");
    results_ = std::make_unique<Results>(folder, communicator_);
  }


  void
  Simulation::start()
  {
    StepResult first;
    refine_around_shell();
    first.linear_iterations = flow_on_new_mesh();

    std::ostringstream text;
    text << "Shell: " << surface_.n_control_points() << " control points, " << surface_.n_points() << " quadrature points, " << coupling_surface_.n_points()
         << " coupling points. Fluid: cells from " << fluid_.mesh().cell_size(fluid_.mesh().coarsest_level()) << " a to "
         << fluid_.mesh().cell_size(fluid_.mesh().finest_level()) << " a, " << fluid_.mesh().triangulation().n_global_active_cells() << " now, with "
         << fluid_.space().velocity->partitioner()->size() << " velocity and " << fluid_.space().pressure->partitioner()->size() << " pressure unknowns.";
    log_.line(text.str());
    record(first, false);
  }


  bool
  Simulation::is_steady(const InertiaEllipsoid &before, const InertiaEllipsoid &after, const double length)
  {
    // Three steps in a row: at an extremum of the shape one alone may be quiet.
    n_quiet_steps_ = rate_of_change(before, after, length) < parameters_.time.steady_tolerance ? n_quiet_steps_ + 1 : 0;
    return n_quiet_steps_ == 3;
  }


  bool
  Simulation::is_due(double &next, const double interval) const
  {
    const double rounding = 1e-9 * parameters_.scene.end_time;
    if (time_ < next - rounding)
      return false;
    if (interval == 0.)
      return true;
    while (next <= time_ + rounding)
      next += interval;
    return true;
  }


  void
  Simulation::record(const StepResult &step, const bool last)
  {
    const Timings::Scope scope(timings_, "Output");
    Observables          o        = observe(view_, fluid_, state_);
    const ControlPoints  velocity = solver_.shell_velocity(state_);
    o.dissipation                 = solver_.dissipation(state_);
    ellipsoid_                    = o.ellipsoid;
    if (!phase_)
      phase_ = std::make_unique<PhaseAngles>(shape_.topology, state_.x, o.ellipsoid, o.theta_over_pi);
    phase_->update(state_.x, o.ellipsoid, o.theta_over_pi);
    o.alpha            = phase_->alpha();
    o.delta            = phase_->delta();
    o.theta_continuous = phase_->theta();
    o.stress           = particle_stress(state_.x, state_.force); // with one viscosity the forces are all of it
    if (parameters_.scene.viscosity_ratio != 1.)
      o.stress += viscous_stress(surface_, state_.x, velocity, parameters_.scene.viscosity_ratio);
    o.rheology          = rheology(o.stress, o.volume, flow_.shear_rate);
    o.time              = time_;
    o.step              = step.length;
    o.newton_iterations = step.newton_iterations;
    o.linear_iterations = step.linear_iterations;
    o.wall_time         = timings_.elapsed();
    const bool first = n_steps_ == 0, fields_wanted = parameters_.output.field_interval > 0.;
    if (is_due(next_history_, parameters_.output.history_interval) || last)
      results_->add_history(o);
    motion_.push_back({time_, o.ellipsoid.taylor_parameter, o.theta_continuous, o.alpha, o.delta});
    const bool fields = first || last || (fields_wanted && is_due(next_fields_, parameters_.output.field_interval));
    add_contours(step.length, fields);
    if (fields)
      results_->add_fields(time_, view_, velocity, fluid_, state_, flow_.shear_rate);
    const double remaining = n_steps_ == 0 ? -1. : o.wall_time * (parameters_.scene.end_time - time_) / time_;
    log_.step(
      {n_steps_, time_, step.length, step.newton_iterations, step.linear_iterations, o.ellipsoid.taylor_parameter, o.theta_over_pi, o.volume_error, remaining});
  }


  void
  Simulation::add_contours(const double length, const bool but_now)
  {
    const double rounding = 1e-9 * parameters_.scene.end_time;
    for (const double time : parameters_.output.contour_times)
      if (time > time_ - length + rounding && time <= time_ + rounding && !(but_now && time > time_ - rounding))
        results_->add_contour(time, view_, stepper_.position(time));
  }


  void
  Simulation::summarise(const std::string &outcome)
  {
    const MotionSummary summary = motion_summary(motion_);
    log_.line("\n" + motion_text(summary));
    results_->write_summary(outcome, summary);
  }


  void
  Simulation::advance()
  {
    const double rounding = 1e-9 * parameters_.scene.end_time;
    start();
    for (bool last = parameters_.scene.end_time <= 0.; !last;)
      {
        const InertiaEllipsoid before = ellipsoid_;
        StepResult             step   = stepper_.step(state_, time_);
        step.linear_iterations += std::exchange(remeshing_iterations_, 0);
        time_ += step.length;
        ++n_steps_;
        const bool steady = is_steady(before, inertia_ellipsoid(surface_, state_.x), step.length);
        last              = steady || time_ >= parameters_.scene.end_time - rounding;
        record(step, last);
        if (steady)
          log_.line("Steady: axes and inclination have changed slower than Time/Steady tolerance in three steps.");
        if (!last && !fluid_.mesh().covers(coupling_.points(state_.x), coupling_.interface() == Interface::enriched ? 1. : 0.5))
          {
            refine_around_shell();
            remeshing_iterations_ = flow_on_new_mesh();
          }
      }
  }


  void
  Simulation::run()
  {
    make_folder();
    try
      {
        advance();
      }
    catch (const NumericalError &error)
      {
        log_.line("FAILED at time " + std::to_string(time_) + ": " + error.what());
        log_.line("Last good state: " + results_->write_failed(view_, state_) + ".");
        summarise("failed");
        log_.timings(timings_);
        throw;
      }
    summarise("done");
    log_.timings(timings_);
  }
} // namespace tanktread
