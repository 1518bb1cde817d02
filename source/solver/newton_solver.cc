// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the nonlinear system of a time level.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    State
    moved(const State &state, const State &increment, const double length)
    {
      State result(state);
      result.x += length * increment.x;
      result.force += length * increment.force;
      result.pressure_jump += length * increment.pressure_jump;
      result.volume_shift += length * increment.volume_shift;
      for (unsigned int b = 0; b <= pressure_block; ++b)
        result.fluid.block(b).add(length, increment.fluid.block(b));
      return result;
    }
  } // namespace


  NewtonSolver::NewtonSolver(const SolverParameters   &parameters,
                             const DistributedShell   &shell,
                             const SubdivisionSurface &surface,
                             Coupling                 &coupling,
                             const double              volume,
                             const ShearFlow           flow,
                             Timings                  &timings,
                             const double              viscosity_ratio,
                             const double              reynolds_number)
    : parameters_(parameters)
    , shell_(shell)
    , surface_(surface)
    , coupling_(coupling)
    , volume_(volume)
    , flow_(flow)
    , timings_(timings)
    , implicit_shell_(shell.communicator())
    , viscosity_ratio_(viscosity_ratio)
    , reynolds_number_(reynolds_number)
  {
    coupling.set_viscosity_contrast({viscosity_ratio, flow.gradient()});
  }


  void
  NewtonSolver::attach(Fluid &fluid)
  {
    fluid_ = &fluid;
    coupling_.attach(fluid.space());
    viscosity_x_.resize(0, 3);
    if (reynolds_number_ > 0.)
      inertia_ = std::make_unique<Inertia>(fluid.space(), reynolds_number_, flow_.in_fluid());
  }


  void
  NewtonSolver::set_viscosity(const ControlPoints &x)
  {
    if (viscosity_ratio_ == 1. || (viscosity_x_.rows() == x.rows() && viscosity_x_ == x))
      return;
    const Timings::Scope scope(timings_, "Viscosity");
    viscosity_x_ = x;
    fluid_->set_viscosity(coupling_.viscosity(x));
    undisturbed_load_.reinit(fluid_->space().velocity->partitioner());
    fluid_->viscosity()->add_excess_stress(fluid_->space(), flow_.in_fluid(), undisturbed_load_);
  }


  double
  NewtonSolver::dissipation(const State &state) const
  {
    double result = state.force.cwiseProduct(shell_velocity(state) - flow_.velocity(state.x)).sum() - inertial_power(state);
    if (viscosity_ratio_ == 1.)
      return result;
    const Eigen::Matrix3d strain_rate = 0.5 * (flow_.gradient() + flow_.gradient().transpose());
    return result + undisturbed_load_ * state.fluid.block(velocity_block) + coupling_.undisturbed_work(state.force) +
      2. * strain_rate.squaredNorm() * (viscosity_ratio_ - 1.) * volume_;
  }


  Residual
  NewtonSolver::residual(State &state, const ControlPoints &xhat, const double tau, const Points points)
  {
    const Timings::Scope scope(timings_, "Residual");
    Residual             r;
    r.force               = state.force - shell_.force(state.x);
    r.volume              = enclosed_volume(surface_, state.x) - volume_;
    const ControlPoints v = volume_gradient(surface_, state.x);
    if (points == Points::follow)
      move_points(state);

    fluid_->space().reinit(r.fluid);
    fluid_->stokes().vmult(r.fluid, state.fluid);
    if (viscosity_ratio_ != 1.)
      r.fluid.block(velocity_block) += undisturbed_load_;
    if (inertia_ && tau > 0.)
      inertia_->add_residual(state.fluid, r.fluid);
    ExtendedForces forces;
    coupling_.extend_whole(state.force, forces);
    const ControlPoints velocity = coupling_.interpolate(state.fluid, forces) + flow_.velocity(state.x);
    coupling_.spread(-1., state.force + state.pressure_jump * v, forces, r.fluid);
    r.shell_speed = shell_speed(r.fluid);
    r.flux        = v.cwiseProduct(velocity).sum();
    r.x           = state.x - xhat - tau * velocity - state.volume_shift * coupling_.density(v);
    return r;
  }


  void
  NewtonSolver::move_points(State &state)
  {
    coupling_.move(state.x, volume_gradient(surface_, state.x));
    carry_pressure(state);
  }


  void
  NewtonSolver::carry_pressure(State &state) const
  {
    coupling_.carry_pressure(state.force, state.sides, state.fluid);
  }


  ControlPoints
  NewtonSolver::shell_velocity(const State &state) const
  {
    ExtendedForces forces;
    coupling_.extend_whole(state.force, forces);
    return coupling_.interpolate(state.fluid, forces) + flow_.velocity(state.x);
  }


  double
  NewtonSolver::speed(const Residual &r, const double tau) const
  {
    return std::sqrt(r.shell_speed * r.shell_speed + r.x.squaredNorm() / (r.x.rows() * tau * tau) +
                     (std::pow(r.flux, 2) + std::pow(r.volume / tau, 2)) / std::pow(3. * volume_, 2));
  }


  double
  NewtonSolver::norm(const Residual &r, const double tau) const
  {
    const double from_forces = std::sqrt(implicit_shell_.velocity(r.force).squaredNorm() / r.x.rows());
    return dealii::Utilities::MPI::broadcast(fluid_->mesh().communicator(), std::hypot(speed(r, tau), from_forces), 0);
  }


  double
  NewtonSolver::shell_speed(const FluidBlockVector &load) const
  {
    FluidBlockVector flow;
    fluid_->space().reinit(flow);
    fluid_->preconditioner().vmult(flow, load);
    const ControlPoints velocity = coupling_.interpolate(flow);
    return std::sqrt(velocity.squaredNorm() / velocity.rows());
  }


  bool
  NewtonSolver::is_solved(const Residual &r, const double norm) const
  {
    return norm <= parameters_.newton_tolerance && std::abs(r.volume) <= parameters_.volume_tolerance * volume_;
  }


  double
  NewtonSolver::finest_cell() const
  {
    return fluid_->mesh().cell_size(fluid_->mesh().finest_level());
  }


  LinearisedShell
  NewtonSolver::linearised(const State &state, const Linearisation &choice)
  {
    const Timings::Scope scope(timings_, "Shell tangent and factorisation");
    VelocityGradients    gradients = VelocityGradients::Zero(coupling_.n_local_points(), 9);
    if (choice.derivatives == PointDerivatives::complete)
      gradients = coupling_.velocity_gradients(state.fluid);
    gradients.col(2).array() += flow_.shear_rate; // du_x/dz
    if (inertia_)
      inertia_->linearise(state.fluid);
    return {shell_, surface_, coupling_, state, shell_velocity(state), gradients, choice, implicit_shell_};
  }


  double
  NewtonSolver::forcing_term(const double norm) const
  {
    // As accurate as the second order of the iteration deserves, but no more than the tolerance asks for.
    return std::min(parameters_.linear_tolerance, std::max(0.3 * norm, 0.3 * parameters_.newton_tolerance / norm));
  }


  double
  NewtonSolver::motion_accuracy(const double norm) const
  {
    // What is left of the residual after an iteration is to be small against its square, and against the tolerance.
    return std::min(0.01, 0.01 * std::max(norm, parameters_.newton_tolerance));
  }


  LinearReport
  NewtonSolver::linear_solve(const Residual &r, const LinearisedShell &shell, const double tolerance, State &increment)
  {
    const Timings::Scope           scope(timings_, "Linear solver");
    const unsigned int             n_points = r.x.rows();
    const MonolithicOperator       matrix(fluid_->stokes(), shell, &timings_, shell.tau() > 0. ? inertia_.get() : nullptr);
    const MonolithicPreconditioner preconditioner(fluid_->preconditioner(), shell, volume_ / (0.5 * (1. + viscosity_ratio_)), &timings_);

    const ControlPoints dx0 = shell.displacement_of_residual(r.x, r.volume);
    FluidBlockVector    rhs = monolithic_vector(fluid_->space(), n_points), solution(rhs);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      rhs.block(b).equ(-1., r.fluid.block(b));
    if (shell.points_move())
      coupling_.spread_with_motion(ControlPoints::Zero(n_points, 3), dx0, shell.density(), rhs);
    set_shell_unknowns(rhs, {r.flux + shell.flux(ControlPoints::Zero(n_points, 3), dx0), shell.damped(-r.force - shell.stiffness_times(dx0))});

    // With an exact tangent that is indefinite the solver gets nowhere; a definite one needs a few dozen iterations, more with viscosities that differ much.
    const double       contrast = std::sqrt(std::max(viscosity_ratio_, 1. / viscosity_ratio_));
    const unsigned int max_iterations =
      contrast * (tangent_ == Tangent::exact && shell.tau() > 0. ? std::min(100u, parameters_.max_linear_iterations) : parameters_.max_linear_iterations);
    const LinearReport report = solve_fgmres(matrix, preconditioner, solution, rhs, tolerance, max_iterations, krylov_basis_);

    fluid_->space().reinit(increment.fluid);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      increment.fluid.block(b) = solution.block(b);
    const ShellUnknowns unknowns = shell_unknowns(solution, fluid_->mesh().communicator());
    increment.pressure_jump      = unknowns.pressure_jump;
    ExtendedForces forces;
    coupling_.extend(unknowns.force, forces);
    const ControlPoints moments = coupling_.velocity_moments(solution, forces);
    increment.x                 = dx0 + shell.displacement(moments);
    increment.volume_shift      = shell.volume_shift(moments, r.x, increment.x);
    increment.force             = shell.force_change(unknowns.force, increment.x);
    // All ranks have computed this alike up to rounding, which differs between kinds of processors: one answer for all, so that they take the same decisions.
    const MPI_Comm communicator = fluid_->mesh().communicator();
    MPI_Bcast(increment.x.data(), increment.x.size(), MPI_DOUBLE, 0, communicator);
    MPI_Bcast(increment.force.data(), increment.force.size(), MPI_DOUBLE, 0, communicator);
    MPI_Bcast(&increment.volume_shift, 1, MPI_DOUBLE, 0, communicator);
    return report;
  }


  double
  NewtonSolver::line_search(State &state, Residual &r, const State &increment, const ControlPoints &xhat, const double tau)
  {
    const double before = norm(r, tau);
    for (double length = 1.; length > 0.05; length *= 0.5)
      try
        {
          State        trial   = moved(state, increment, length);
          Residual     r_trial = residual(trial, xhat, tau, trial_points());
          const double after   = norm(r_trial, tau);
          if (after <= (1. - 1e-4 * length) * before || is_solved(r_trial, after))
            {
              state = std::move(trial);
              r     = std::move(r_trial);
              return length;
            }
        }
      catch (const NumericalError &)
        {
          // The trial shell is degenerate or out of the box: a shorter step.
        }
    return 0.;
  }


  std::string
  NewtonSolver::iterate(State &state, Residual &r, const LinearisedShell &shell, const ControlPoints &xhat, NewtonReport &report)
  {
    State              increment;
    const LinearReport linear = linear_solve(r, shell, forcing_term(report.residuals.back()), increment);
    implicit_shell_.watch(linear);
    ++report.newton_iterations;
    report.linear_iterations += linear.iterations;
    if (!linear.converged)
      return "the linear solver did not converge in " + std::to_string(linear.iterations) + " iterations";
    report.step_lengths.push_back(line_search(state, r, increment, xhat, shell.tau()));
    report.residuals.push_back(norm(r, shell.tau()));
    return report.step_lengths.back() == 0. ? "Newton's direction does not reduce the residual" : "";
  }


  NewtonSolver::Points
  NewtonSolver::trial_points() const
  {
    return coupling_.interface() == Interface::enriched ? Points::stay : Points::follow;
  }


  bool
  NewtonSolver::follow_shell(State &state, unsigned int &n_moves, const bool with_jumps)
  {
    // Positions within a small part of a cell, which shrinks with the solver's tolerance, are as good as any. A node of the fluid that changes sides makes the residual jump, and now and
    // then shell and node would chase each other for ever: then a larger part has to do.
    constexpr unsigned int patience  = 8;
    const double           tolerance = n_moves < patience ? std::min(0.002 * finest_cell(), 100. * parameters_.newton_tolerance) : 0.02 * finest_cell();
    const bool             moves     = trial_points() == Points::stay && coupling_.distance(state.x) > tolerance;
    const bool             mixes     = viscosity_ratio_ != 1. && (state.x - viscosity_x_).rowwise().norm().maxCoeff() > tolerance;
    if (moves)
      move_points(state);
    if (mixes)
      set_viscosity(state.x);
    n_moves += moves || mixes;
    const bool sweeps = with_jumps && viscosity_ratio_ != 1. && trial_points() == Points::stay;
    if (sweeps)
      coupling_.update_viscous_forces(state.fluid, state.force);
    return moves || mixes || sweeps;
  }


  void
  NewtonSolver::use(const Tangent tangent)
  {
    tangent_ = tangent;
    implicit_shell_.discard();
  }


  NewtonReport
  NewtonSolver::solve(State &state, const ControlPoints &xhat, const double tau, const FluidVector *const uhat)
  {
    NewtonReport report;
    State        trial = state;
    if (inertia_)
      {
        if (uhat == nullptr)
          throw std::logic_error("NewtonSolver::solve: a step with inertia needs uhat.");
        inertia_->begin_step(*uhat, tau);
        fluid_->set_shift(inertia_->mass());
      }
    try
      {
        if (viscosity_ratio_ != 1.)
          {
            set_viscosity(trial.x);
            move_points(trial);
            coupling_.update_viscous_forces(trial.fluid, trial.force);
          }
        Residual     r        = residual(trial, xhat, tau, viscosity_ratio_ == 1. ? Points::follow : Points::stay);
        double       length   = dealii::Utilities::MPI::broadcast(fluid_->mesh().communicator(), tau * speed(r, tau), 0); // about that of the next displacement
        bool         cautious = false;
        unsigned int n_moves  = 1;
        bool         settled  = false; // the viscous part of the jumps: what a further sweep would change is small, or too many of them have been done already
        for (bool solved = false; !solved;)
          {
            if (report.newton_iterations == parameters_.max_newton_iterations)
              throw NumericalError("no convergence in " + std::to_string(report.newton_iterations) + " Newton iterations");
            if (trial_points() == Points::follow && !report.step_lengths.empty() && report.step_lengths.back() < 1.)
              move_points(trial); // where a rejected trial has left it
            const bool near = length < 0.25 * finest_cell();
            if (near && !cautious && tangent_ == Tangent::positive)
              use(Tangent::exact);
            const unsigned int    renewals = implicit_shell_.n_renewals();
            const bool            complete = near && !cautious && coupling_.interface() == Interface::plain;
            const LinearisedShell shell    = linearised(trial,
                                                     {tau,
                                                         finest_cell(),
                                                         motion_accuracy(length / tau),
                                                      complete ? PointDerivatives::complete : PointDerivatives::frozen,
                                                         tangent_,
                                                         flow_.gradient(),
                                                         0.5 * (1. + viscosity_ratio_)});
            if (report.residuals.empty())
              report.residuals.push_back(norm(r, tau));
            const std::string failure = iterate(trial, r, shell, xhat, report);
            if (!failure.empty())
              {
                if (implicit_shell_.n_renewals() == renewals)
                  implicit_shell_.discard(); // perhaps it was too old: the same iteration again, with a new one
                else if (tangent_ == Tangent::exact)
                  use(Tangent::positive);
                else
                  throw NumericalError(failure);
                cautious = tangent_ == Tangent::positive;
              }
            if (follow_shell(trial, n_moves, !settled))
              {
                r                       = residual(trial, xhat, tau, trial_points());
                report.residuals.back() = norm(r, tau);
                settled =
                  settled || report.residuals.back() <= 10. * parameters_.newton_tolerance || 2 * report.newton_iterations >= parameters_.max_newton_iterations;
              }
            solved = is_solved(r, report.residuals.back());
            length = tau * report.residuals.back();
          }
        report.converged = true;
        state            = std::move(trial);
      }
    catch (const NumericalError &error)
      {
        report.message = error.what();
      }
    return report;
  }


  void
  NewtonSolver::start_undisturbed(State &state)
  {
    fluid_->space().reinit(state.fluid);
    state.pressure_jump = 0.;
    state.force         = shell_.force(state.x);
    coupling_.move(state.x, volume_gradient(surface_, state.x));
  }


  double
  NewtonSolver::inertial_power(const State &state) const
  {
    return inertia_ && inertia_->mass() > 0. ? inertia_->power(state.fluid) : 0.;
  }


  unsigned int
  NewtonSolver::solve_flow(State &state)
  {
    constexpr unsigned int n_sweeps = 3; // for the viscous part of the jumps
    fluid_->set_shift(0.);
    state.force = shell_.force(state.x);
    set_viscosity(state.x);
    unsigned int iterations = solve_with_fixed_jumps(state, Points::follow);
    for (unsigned int i = 0; i < n_sweeps && viscosity_ratio_ != 1. && coupling_.interface() == Interface::enriched; ++i)
      {
        coupling_.update_viscous_forces(state.fluid, state.force);
        iterations += solve_with_fixed_jumps(state, Points::stay);
      }
    return iterations;
  }


  unsigned int
  NewtonSolver::solve_with_fixed_jumps(State &state, const Points points)
  {
    State          increment;
    const Residual r = residual(state, state.x, 0., points);
    // Relative to the loads of the shell and of unit pressure, not to what the initial guess has left of them.
    FluidBlockVector load;
    fluid_->space().reinit(load);
    coupling_.spread(state.force, load);
    coupling_.spread(volume_gradient(surface_, state.x), load);
    if (viscosity_ratio_ != 1.)
      load.block(velocity_block) += undisturbed_load_;
    const double wanted = std::max(1e-10, 1e-2 * parameters_.newton_tolerance) * load.l2_norm(), given = std::hypot(r.fluid.l2_norm(), r.flux);
    if (given <= wanted)
      return 0;
    const LinearReport report = linear_solve(r, linearised(state, {0., finest_cell(), 0., PointDerivatives::frozen}), wanted / given, increment);
    if (!report.converged)
      {
        std::ostringstream message;
        message << "The Stokes solver did not converge: residual " << report.final_residual << " after " << report.iterations << " iterations, from "
                << report.initial_residual << '.';
        throw NumericalError(message.str());
      }
    state = moved(state, increment, 1.);
    return report.iterations;
  }
} // namespace tanktread
