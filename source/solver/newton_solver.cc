// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the nonlinear system of a time level.

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>

#include <cmath>

namespace tanktread
{
  namespace
  {
    double
    velocity_norm(const FluidBlockVector &vector)
    {
      double sum = 0.;
      for (unsigned int c = 0; c < 3; ++c)
        sum += vector.block(c).norm_sqr();
      return std::sqrt(sum);
    }


    State
    moved(const State &state, const State &increment, const double length)
    {
      State result(state);
      result.x += length * increment.x;
      result.pressure_jump += length * increment.pressure_jump;
      for (unsigned int b = 0; b <= pressure_block; ++b)
        result.fluid.block(b).add(length, increment.fluid.block(b));
      return result;
    }
  } // namespace


  NewtonSolver::NewtonSolver(const SolverParameters   &parameters,
                             const Shell              &shell,
                             const SubdivisionSurface &surface,
                             Coupling                 &coupling,
                             const double              volume,
                             const UndisturbedFlow     flow,
                             Timings                  &timings)
    : parameters_(parameters)
    , shell_(shell)
    , surface_(surface)
    , coupling_(coupling)
    , volume_(volume)
    , flow_(flow)
    , timings_(timings)
  {}


  void
  NewtonSolver::attach(const Fluid &fluid)
  {
    fluid_ = &fluid;
    coupling_.attach(fluid.space());
  }


  Residual
  NewtonSolver::residual(const State &state, const ControlPoints &xhat, const double tau)
  {
    const Timings::Scope scope(timings_, "Residual");
    Residual             r;
    const ShellForces    forces(shell_, surface_, state.x);
    coupling_.move(state.x);

    FluidBlockVector shell_load, unit_load;
    fluid_->space().reinit(r.fluid);
    fluid_->space().reinit(shell_load);
    fluid_->space().reinit(unit_load);
    coupling_.spread(forces.force, shell_load);
    coupling_.spread(forces.volume_gradient, unit_load);
    const double scale = velocity_norm(shell_load) + velocity_norm(unit_load);
    fluid_->stokes().vmult(r.fluid, state.fluid);
    r.fluid.add(-1., shell_load, -state.pressure_jump, unit_load);

    r.x      = state.x - xhat - tau * (coupling_.interpolate(state.fluid) + flow_.velocity(state.x));
    r.volume = forces.volume - volume_;
    r.norm   = std::sqrt(std::pow(velocity_norm(r.fluid) / scale, 2) + r.x.squaredNorm() / r.x.rows() + std::pow(r.volume / volume_, 2));
    return r;
  }


  bool
  NewtonSolver::is_solved(const Residual &r) const
  {
    return r.norm <= parameters_.newton_tolerance && std::abs(r.volume) <= parameters_.volume_tolerance * volume_;
  }


  LinearReport
  NewtonSolver::linear_solve(const Residual &r, const State &state, const double tau, const double tolerance, State &increment)
  {
    const unsigned int n_points = state.x.rows();
    PointVelocity      velocity = coupling_.velocity_and_gradient(state.fluid);
    velocity.gradient.col(2).array() += flow_.shear_rate;

    const auto linearise = [&]() {
      const Timings::Scope scope(timings_, "Shell tangent and factorisation");
      return std::make_unique<LinearisedShell>(
        shell_, surface_, coupling_, state.x, ShellForces(shell_, surface_, state.x), velocity, state.pressure_jump, tau);
    };
    const auto                     shell = linearise();
    const MonolithicOperator       matrix(fluid_->stokes(), *shell);
    const MonolithicPreconditioner preconditioner(fluid_->preconditioner(), *shell, surface_, state.x, fluid_->mesh().cell_size(fluid_->mesh().finest_level()));

    const ControlPoints dx0 = shell->displacement_of_residual(r.x);
    FluidBlockVector    rhs = monolithic_vector(fluid_->space(), n_points), solution(rhs);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      rhs.block(b).equ(-1., r.fluid.block(b));
    coupling_.spread_with_motion(ControlPoints::Zero(n_points, 3), dx0, shell->density(), rhs);
    const double volume_rate = tau == 0. ? 0. : (r.volume + shell->volume_gradient().cwiseProduct(dx0).sum()) / tau;
    set_shell_unknowns(rhs, {volume_rate, -shell->stiffness_times(dx0)});

    const Timings::Scope scope(timings_, "Linear solver");
    const LinearReport   report = solve_fgmres(matrix, preconditioner, solution, rhs, tolerance, parameters_.max_linear_iterations);

    fluid_->space().reinit(increment.fluid);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      increment.fluid.block(b) = solution.block(b);
    increment.pressure_jump = shell_unknowns(solution, fluid_->mesh().communicator()).pressure_jump;
    increment.x             = dx0 + tau * shell->velocity_response(coupling_.velocity_moments(solution));
    return report;
  }


  double
  NewtonSolver::line_search(State &state, Residual &r, const State &increment, const ControlPoints &xhat, const double tau)
  {
    for (double length = 1.; length > 0.05; length *= 0.5)
      try
        {
          State    trial   = moved(state, increment, length);
          Residual r_trial = residual(trial, xhat, tau);
          if (r_trial.norm <= (1. - 1e-4 * length) * r.norm || is_solved(r_trial))
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


  NewtonReport
  NewtonSolver::solve(State &state, const ControlPoints &xhat, const double tau)
  {
    NewtonReport report;
    State        trial = state, increment;
    try
      {
        Residual r = residual(trial, xhat, tau);
        report.residuals.push_back(r.norm);
        while (!is_solved(r))
          {
            if (report.newton_iterations == parameters_.max_newton_iterations)
              throw NumericalError("no convergence in " + std::to_string(report.newton_iterations) + " Newton iterations");
            coupling_.move(trial.x); // a rejected trial of the line search may have left it elsewhere
            const LinearReport linear = linear_solve(r, trial, tau, parameters_.linear_tolerance, increment);
            ++report.newton_iterations;
            report.linear_iterations += linear.iterations;
            if (!linear.converged)
              throw NumericalError("the linear solver did not converge in " + std::to_string(linear.iterations) + " iterations");
            report.step_lengths.push_back(line_search(trial, r, increment, xhat, tau));
            report.residuals.push_back(r.norm);
            if (report.step_lengths.back() == 0.)
              throw NumericalError("Newton's direction does not reduce the residual");
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


  ControlPoints
  NewtonSolver::solve_flow(State &state, unsigned int &linear_iterations)
  {
    State              increment;
    const Residual     r      = residual(state, state.x, 0.);
    const LinearReport report = linear_solve(r, state, 0., 1e-2 * parameters_.newton_tolerance, increment);
    linear_iterations         = report.iterations;
    if (!report.converged)
      throw NumericalError("The Stokes solver did not converge: residual " + std::to_string(report.final_residual) + " after " + std::to_string(report.iterations) +
                           " iterations, from " + std::to_string(report.initial_residual) + '.');
    increment.x.setZero();
    state = moved(state, increment, 1.);
    return coupling_.interpolate(state.fluid) + flow_.velocity(state.x);
  }
} // namespace tanktread
