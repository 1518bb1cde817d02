// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one run from the initial shape to the end time.

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/output_folder.h>
#include <tanktread/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tanktread
{
  namespace
  {
    Derivatives
    derivatives_needed(const Parameters &parameters)
    {
      return parameters.scene.bending_modulus() > 0. ? Derivatives::second : Derivatives::first;
    }


    RunDescription
    description(const Parameters &parameters, const unsigned int n_ranks)
    {
      RunDescription run;
      run.parameter_file = parameters.file;
      run.n_ranks        = n_ranks;
      run.shear          = parameters.scene.flow == Flow::shear;
      run.G              = parameters.scene.shear_number;
      run.khat           = parameters.scene.reduced_bending_modulus;
      run.box_side       = parameters.scene.box_side;
      run.left_out       = {"inertia (Re = 0)", "variable viscosity (ratio 1: one scalar matrix for all velocity components)", "shell thickness (0)"};
      if (parameters.scene.bending_modulus() == 0.)
        run.left_out.push_back("bending and second derivatives of the surface (khat = 0)");
      return run;
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
    , shell_(surface_, parameters.shell, {parameters.scene.surface_young_modulus(), parameters.scene.bending_modulus()}, shape_.control_points)
    , coupling_surface_(shape_.topology,
                        triangle_quadrature(3, coupling_subdivisions(shape_.topology, shape_.control_points, 3, parameters.fluid_mesh.finest_cell)),
                        Derivatives::first)
    , coupling_(coupling_surface_, area_weights(coupling_surface_, shape_.control_points))
    , view_{shape_.topology, surface_, shell_, enclosed_volume(surface_, shape_.control_points)}
    , flow_{parameters.scene.flow == Flow::shear ? 1. : 0.}
    , fluid_(communicator, parameters.scene.box_side, parameters.fluid_mesh)
    , solver_(parameters.solver, shell_, surface_, coupling_, view_.initial_volume, flow_, timings_)
    , next_length_(parameters.time.step)
  {}


  void
  Simulation::refine_around_shell()
  {
    const Timings::Scope scope(timings_, "Fluid mesh and matrices");
    fluid_.adapt(coupling_.points(state_.x));
    solver_.attach(fluid_);
    coupling_.move(state_.x);
    previous_state_.reset();
    fluid_.space().reinit(state_.fluid);
  }


  void
  Simulation::start()
  {
    const std::string folder = parameters_.output.directory;
    std::string       moved_to;
    on_first_rank(communicator_, [&] {
      moved_to = prepare_output_folder(folder);
      log_.open(folder + "/log.txt");
      std::ofstream(folder + "/used_parameters.prm") << parameters_.used;
    });
    log_.header(description(parameters_, dealii::Utilities::MPI::n_mpi_processes(communicator_)));
    if (!moved_to.empty())
      log_.line("The folder held a former run, now in " + moved_to + ".");
    results_ = std::make_unique<Results>(folder, first_rank_);

    state_.x = shape_.control_points;
    refine_around_shell();
    StepResult first;
    solver_.solve_flow(state_, first.linear_iterations);

    std::ostringstream text;
    text << "Shell: " << surface_.n_control_points() << " control points, " << surface_.n_points() << " quadrature points, " << coupling_surface_.n_points()
         << " coupling points. Fluid: cells from " << fluid_.mesh().cell_size(0) << " a to " << fluid_.mesh().cell_size(fluid_.mesh().finest_level()) << " a, "
         << fluid_.mesh().triangulation().n_global_active_cells() << " now, with " << 3 * fluid_.space().velocity.dofs().n_dofs() << " velocity and "
         << fluid_.space().pressure.dofs().n_dofs() << " pressure unknowns.";
    log_.line(text.str());
    record(first, false);
  }


  ControlPoints
  Simulation::shell_velocity() const
  {
    return coupling_.interpolate(state_.fluid) + flow_.velocity(state_.x);
  }


  State
  Simulation::extrapolated(const double length) const
  {
    State guess = state_;
    if (!previous_state_)
      return guess;
    const double ratio = length / previous_length_;
    guess.x += ratio * (state_.x - previous_state_->x);
    guess.force += ratio * (state_.force - previous_state_->force);
    guess.pressure_jump += ratio * (state_.pressure_jump - previous_state_->pressure_jump);
    guess.fluid.sadd(1. + ratio, -ratio, previous_state_->fluid);
    return guess;
  }


  Simulation::StepResult
  Simulation::implicit_step()
  {
    StepResult   result;
    const double wanted   = std::min(next_length_, parameters_.scene.end_time - time_);
    const bool   bdf2     = parameters_.time.scheme == TimeScheme::bdf2 && previous_x_.size() > 0;
    bool         rejected = false;
    for (result.length = wanted; result.length > 1e-3 * std::min(wanted, parameters_.time.step); result.length *= 0.5)
      {
        State              guess = rejected ? state_ : extrapolated(result.length);
        const ImplicitStep step =
          bdf2 ? bdf2_step(state_.x, previous_x_, result.length, previous_length_) : backward_euler_step(state_.x, result.length);
        const NewtonReport report = solver_.solve(guess, step.xhat, step.tau);
        result.newton_iterations += report.newton_iterations;
        result.linear_iterations += report.linear_iterations;
        if (report.converged)
          {
            previous_state_  = std::make_unique<State>(std::move(state_));
            previous_x_      = previous_state_->x;
            previous_length_ = result.length;
            state_           = std::move(guess);
            next_length_     = rejected ? result.length : std::min(parameters_.time.step, 1.5 * next_length_);
            return result;
          }
        rejected = true;
        std::ostringstream text;
        text << "Step of length " << result.length << " rejected: " << report.message << " (residuals";
        for (const double residual : report.residuals)
          text << ' ' << residual;
        log_.line(text.str() + ").");
      }
    throw NumericalError("The time step has been halved ten times without success.");
  }


  void
  Simulation::check_explicit_step(const ControlPoints &displacement) const
  {
    const double largest = std::sqrt(displacement.rowwise().squaredNorm().maxCoeff());
    if (!(largest < 1.))
      {
        std::ostringstream message;
        message << "The explicit coupling is unstable at this step: a control point would move by " << largest
                << " a in one step of " << next_length_ << ". Take a smaller Time/Step or Solver/Coupling = implicit.";
        throw NumericalError(message.str());
      }
  }


  Simulation::StepResult
  Simulation::explicit_step()
  {
    StepResult result;
    result.length              = std::min(parameters_.time.step, parameters_.scene.end_time - time_);
    const ControlPoints change = result.length * shell_velocity();
    check_explicit_step(change);
    State next = state_;
    next.x += change;
    try
      {
        solver_.solve_flow(next, result.linear_iterations);
      }
    catch (const NumericalError &error)
      {
        coupling_.move(state_.x);
        throw NumericalError(std::string("The explicit coupling failed at this step: ") + error.what() + " Take a smaller Time/Step or Solver/Coupling = implicit.");
      }
    state_ = std::move(next);
    return result;
  }


  bool
  Simulation::is_steady(const InertiaEllipsoid &before, const InertiaEllipsoid &after, const double length) const
  {
    return rate_of_change(before, after, length) < parameters_.time.steady_tolerance;
  }


  void
  Simulation::record(const StepResult &step, const bool last)
  {
    const Timings::Scope scope(timings_, "Output");
    Observables          o = observe(view_, fluid_, state_);
    ellipsoid_             = o.ellipsoid;
    o.time                 = time_;
    o.step                 = step.length;
    o.newton_iterations    = step.newton_iterations;
    o.linear_iterations    = step.linear_iterations;
    o.wall_time            = timings_.elapsed();
    const double rounding  = 1e-9 * parameters_.scene.end_time;
    if (last || time_ >= next_history_ - rounding)
      {
        results_->add_history(o);
        next_history_ = time_ + parameters_.output.history_interval;
      }
    if (last || time_ >= next_fields_ - rounding)
      {
        results_->add_fields(time_, view_, shell_velocity(), fluid_, state_, flow_.shear_rate);
        const double interval = parameters_.output.field_interval;
        next_fields_          = interval > 0. ? next_fields_ + interval : std::numeric_limits<double>::max();
      }
    const double remaining = n_steps_ == 0 ? -1. : o.wall_time * (parameters_.scene.end_time - time_) / time_;
    log_.step({n_steps_,
               time_,
               step.length,
               step.newton_iterations,
               step.linear_iterations,
               o.ellipsoid.taylor_parameter,
               o.ellipsoid.inclination / dealii::numbers::PI,
               o.volume_error,
               remaining});
  }


  void
  Simulation::run()
  {
    start();
    const double rounding = 1e-9 * parameters_.scene.end_time;
    try
      {
        for (bool last = false; !last;)
          {
            const InertiaEllipsoid before = ellipsoid_;
            const StepResult       step   = parameters_.solver.coupling == TimeCoupling::explicit_euler ? explicit_step() : implicit_step();
            time_ += step.length;
            ++n_steps_;
            const bool steady = is_steady(before, inertia_ellipsoid(surface_, state_.x), step.length);
            last              = steady || time_ >= parameters_.scene.end_time - rounding;
            record(step, last);
            if (steady)
              log_.line("Steady: axes and inclination change slower than Time/Steady tolerance.");
            if (!last && !fluid_.mesh().covers(coupling_.points(state_.x)))
              {
                refine_around_shell();
                unsigned int iterations;
                solver_.solve_flow(state_, iterations);
              }
          }
      }
    catch (const NumericalError &error)
      {
        const std::string file = results_->write_failed(view_, state_);
        log_.line(std::string("FAILED at time ") + std::to_string(time_) + ": " + error.what() + " Last good state: " + file + ".");
        log_.timings(timings_);
        throw;
      }
    log_.timings(timings_);
  }
} // namespace tanktread
