// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Newton's method for a time level.

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tanktread
{
  namespace
  {
    constexpr unsigned int max_refinements = 4; // of a solution within the tolerance

    /** tau = 0. */
    Linearisation
    frozen_shells(const double h)
    {
      Linearisation result;
      result.h           = h;
      result.derivatives = PointDerivatives::frozen;
      return result;
    }
  } // namespace


  NewtonSolver::NewtonSolver(const SolverParameters &parameters, TimeLevel &level, SolverMemory &memory, Timings &timings)
    : parameters_(parameters)
    , level_(level)
    , memory_(memory)
    , timings_(timings)
    , layout_(level.coupling().layout())
    , volume_(layout_.capsules().volume() / layout_.n_capsules())
    , implicit_shells_(layout_, memory)
  {}


  double
  NewtonSolver::speed(const Residual &r, const double tau) const
  {
    double sum = 0., of_volumes = 0.;
    for (unsigned int i = 0; i < r.capsules.size(); ++i)
      {
        const Residual::OfCapsule &capsule = r.capsules[i];
        sum += capsule.velocity.squaredNorm() + capsule.x.squaredNorm() / (tau * tau);
        const double area = std::cbrt(36. * M_PI * std::pow(layout_.capsule(i).volume(), 2)); // of a sphere of that volume
        of_volumes += (std::pow(capsule.flux, 2) + std::pow(capsule.volume / tau, 2)) / std::pow(area, 2);
      }
    return std::sqrt(layout_.sum(sum / layout_.capsules().n_control_points() + of_volumes / layout_.n_capsules()));
  }


  double
  NewtonSolver::norm(const Residual &r, const double tau) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < r.capsules.size(); ++i)
      sum += implicit_shells_.velocity(i, r.capsules[i].force).squaredNorm();
    return std::hypot(speed(r, tau), std::sqrt(layout_.sum(sum) / layout_.capsules().n_control_points()));
  }


  bool
  NewtonSolver::is_solved(const Residual &r, const double norm) const
  {
    double largest = 0.; // error of a volume
    for (unsigned int i = 0; i < r.capsules.size(); ++i)
      largest = std::max(largest, std::abs(r.capsules[i].volume) / layout_.capsule(i).volume());
    return layout_.max(largest) <= parameters_.volume_tolerance && norm <= parameters_.newton_tolerance;
  }


  bool
  NewtonSolver::is_balanced(const State &state, const Residual &r, const TimeStep &step) const
  {
    if (!level_.flow().is_zero() || level_.has_inertia())
      return true;
    constexpr double part       = 0.1; // of what the step dissipates
    double           left_over  = 0.;
    double           dissipated = 0.;
    const auto      &shells     = level_.shells(state);
    for (std::size_t c = 0; c < shells.size(); ++c)
      {
        const CapsuleState        &capsule = state.capsules[c];
        const Residual::OfCapsule &missing = r.capsules[c];
        const ControlPoints        way     = capsule.x - step.xhat[c];
        const ControlPoints        load    = capsule.force + capsule.pressure_jump * shells[c]->volume_gradient();
        left_over += std::abs(missing.force.cwiseProduct(way).sum()) + std::abs(load.cwiseProduct(missing.x + step.tau * missing.velocity).sum()) +
          std::abs(capsule.pressure_jump * missing.volume);
        dissipated += std::abs(load.cwiseProduct(way).sum());
      }
    const double at_tolerance = 3. * volume_ * level_.liquids().mean_viscosity() * std::pow(parameters_.newton_tolerance, 2) * step.tau;
    return layout_.sum(left_over) <= part * (layout_.sum(dissipated) + at_tolerance);
  }


  LinearisedShells
  NewtonSolver::linearised(const State &state, const Linearisation &choice)
  {
    const Timings::Scope scope(timings_, "Shell tangent and factorisation");
    if (level_.inertia() != nullptr)
      level_.inertia()->linearise(state.fluid);
    return {level_.elasticity(), level_.coupling(), state, level_.shells(state), level_.shell_velocity(state), choice, implicit_shells_};
  }


  unsigned int
  NewtonSolver::max_linear_iterations(const double tau) const
  {
    // With an exact tangent that is indefinite the solver gets nowhere; a definite one needs a few dozen iterations, more with viscosities that differ much.
    const double ratio = level_.liquids().viscosity_ratio, contrast = std::sqrt(std::max(ratio, 1. / ratio));
    return contrast * (memory_.tangent == Tangent::exact && tau > 0. ? std::min(100u, parameters_.max_linear_iterations) : parameters_.max_linear_iterations);
  }


  LinearReport
  NewtonSolver::linear_solve(const Residual &r, const LinearisedShells &shells, const double tolerance, State &increment, const bool jumps_follow)
  {
    const Timings::Scope     scope(timings_, "Linear solver");
    const Fluid             &fluid   = level_.fluid();
    const Inertia *const     inertia = shells.tau() > 0. ? level_.inertia() : nullptr;
    const MonolithicOperator matrix(fluid.stokes(), shells, layout_, &timings_, inertia, jumps_follow);
    if (!pressure_jumps_)
      {
        const Timings::Scope jump_scope(timings_, "- pressure jumps");
        const double         tolerance = level_.has_viscosities() ? 0.03 : 0.1; // more accurate ones save no iterations
        pressure_jumps_.emplace(FluidOperator{fluid.stokes(), inertia},
                                fluid.preconditioner(),
                                level_.coupling(),
                                level_.liquids().mean_viscosity(),
                                krylov_basis_,
                                tolerance);
      }
    const MonolithicPreconditioner preconditioner(fluid.preconditioner(), shells, layout_, *pressure_jumps_, &timings_);

    ShellFields dx0, zeros;
    for (unsigned int c = 0; c < shells.size(); ++c)
      {
        dx0.push_back(shells[c].displacement_of_residual(r.capsules[c].x, r.capsules[c].volume));
        zeros.push_back(ControlPoints::Zero(dx0[c].rows(), 3));
      }
    FluidBlockVector rhs = layout_.vector(fluid.space()), solution(rhs);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      rhs.block(b).equ(-1., r.fluid.block(b));
    if (shells.points_move())
      level_.coupling().spread_with_motion(zeros, dx0, shells.densities(), rhs);
    for (unsigned int c = 0; c < shells.size(); ++c)
      layout_.set(rhs, c, r.capsules[c].flux + shells[c].flux(zeros[c], dx0[c]), shells.damped(c, -r.capsules[c].force - shells[c].stiffness_times(dx0[c])));
    const LinearReport report = solve_fgmres(matrix, preconditioner, solution, rhs, tolerance, max_linear_iterations(shells.tau()), krylov_basis_);
    set_increment(solution, r, dx0, shells, matrix, increment);
    return report;
  }


  void
  NewtonSolver::set_increment(const FluidBlockVector   &solution,
                              const Residual           &r,
                              const ShellFields        &dx0,
                              const LinearisedShells   &shells,
                              const MonolithicOperator &matrix,
                              State                    &increment) const
  {
    level_.fluid().space().reinit(increment.fluid);
    for (unsigned int b = 0; b <= pressure_block; ++b)
      increment.fluid.block(b) = solution.block(b);
    const std::vector<ShellUnknowns> unknowns = layout_.unknowns(solution);
    ExtendedForces                   extended;
    matrix.extend(solution, densities(unknowns), {}, extended);
    const ShellFields moments = level_.coupling().velocity_moments(solution, extended);
    increment.capsules.resize(shells.size());
    for (unsigned int c = 0; c < shells.size(); ++c)
      {
        CapsuleState &capsule = increment.capsules[c];
        capsule.pressure_jump = unknowns[c].pressure_jump;
        capsule.x             = dx0[c] + shells[c].displacement(moments[c]);
        capsule.volume_shift  = shells[c].volume_shift(moments[c], r.capsules[c].x, capsule.x);
        capsule.force         = shells[c].force_change(shells[c].force(unknowns[c].density), capsule.x);
        // The ranks of a team have computed this alike up to rounding, which differs between kinds of processors: one answer for all, so that they take the same
        // decisions.
        layout_.share(capsule.x.data(), capsule.x.size());
        layout_.share(capsule.force.data(), capsule.force.size());
        layout_.share(&capsule.volume_shift, 1);
      }
  }


  std::string
  NewtonSolver::iterate(State &state, Residual &r, const TimeStep &step, Progress &progress, NewtonReport &report)
  {
    const bool             near     = progress.length < 0.25 * level_.finest_cell();
    const bool             complete = near && !progress.cautious && level_.coupling().knows_motion();
    const LinearisedShells shells   = linearised(state,
                                               {step.tau,
                                                  level_.finest_cell(),
                                                  motion_accuracy(progress.length / step.tau),
                                                complete ? PointDerivatives::complete : PointDerivatives::frozen,
                                                  memory_.tangent,
                                                  level_.flow(),
                                                  level_.liquids().mean_viscosity()});
    if (report.residuals.empty())
      report.residuals.push_back(norm(r, step.tau));
    State              increment;
    const LinearReport linear = linear_solve(r,
                                             shells,
                                             forcing_term(report.residuals.back()),
                                             increment,
                                             level_.has_viscosities() && trial_points() == Points::stay && !progress.settled);
    implicit_shells_.watch(linear);
    ++report.newton_iterations;
    report.linear_iterations += linear.iterations;
    if (!linear.converged)
      return "the linear solver did not converge in " + std::to_string(linear.iterations) + " iterations";
    report.step_lengths.push_back(line_search(state, r, increment, step, progress));
    report.residuals.push_back(norm(r, step.tau));
    return report.step_lengths.back() == 0. ? "Newton's direction does not reduce the residual" : "";
  }


  void
  NewtonSolver::iterate_to_solution(State &trial, const TimeStep &step, NewtonReport &report)
  {
    if (level_.has_viscosities())
      {
        level_.set_viscosity(trial);
        level_.move_points(trial);
        level_.update_jumps(trial);
      }
    Residual r = level_.residual(trial, step, level_.has_viscosities() ? Points::stay : Points::follow);
    Progress progress;
    progress.length = step.tau * speed(r, step.tau);
    while (!progress.solved)
      {
        if (report.newton_iterations == parameters_.max_newton_iterations && progress.tolerable)
          return;
        if (report.newton_iterations == parameters_.max_newton_iterations)
          throw NumericalError("no convergence in " + std::to_string(report.newton_iterations) + " Newton iterations");
        if (trial_points() == Points::follow && !report.step_lengths.empty() && report.step_lengths.back() < 1.)
          level_.move_points(trial); // where a rejected trial has left it
        if (memory_.tangent == Tangent::positive && exact_may_serve(progress, report))
          {
            use(Tangent::exact);
            progress.cautious = false;
          }
        const unsigned int renewals = implicit_shells_.n_renewals();
        const std::string  failure  = iterate(trial, r, step, progress, report);
        if (!failure.empty() && progress.tolerable)
          {
            level_.move_points(trial); // which a rejected trial may have taken along
            return;
          }
        if (!failure.empty())
          react(failure, implicit_shells_.n_renewals() > renewals, report.residuals.back(), progress);
        if (!progress.followed && follow_shells(trial, progress))
          {
            r                       = level_.residual(trial, step, trial_points());
            report.residuals.back() = norm(r, step.tau);
            progress.followed       = true;
          }
        if (progress.followed)
          progress.settled = progress.settled || report.residuals.back() <= 10. * parameters_.newton_tolerance ||
            2 * report.newton_iterations >= parameters_.max_newton_iterations;
        progress.tolerable = is_solved(r, report.residuals.back());
        progress.solved    = progress.tolerable && (is_balanced(trial, r, step) || progress.n_refinements++ == max_refinements);
        progress.length    = step.tau * report.residuals.back();
      }
  }


  NewtonReport
  NewtonSolver::solve(State &state, const TimeStep &step)
  {
    NewtonReport report;
    State        trial = state;
    pressure_jumps_.reset();
    level_.begin(step);
    try
      {
        iterate_to_solution(trial, step, report);
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
    level_.fluid().space().reinit(state.fluid);
    for (CapsuleState &capsule : state.capsules)
      capsule.pressure_jump = 0.;
    level_.set_forces(state);
    level_.coupling().move(level_.shells(state));
  }


  unsigned int
  NewtonSolver::solve_flow(State &state, const double time)
  {
    constexpr unsigned int n_sweeps = 3; // for the viscous part of the jumps
    level_.begin_at_rest(time);
    pressure_jumps_.reset();
    level_.set_forces(state);
    level_.set_viscosity(state);
    unsigned int iterations = solve_with_fixed_jumps(state, Points::follow);
    for (unsigned int i = 0; i < n_sweeps && level_.has_viscosities() && !level_.coupling().knows_motion(); ++i)
      {
        level_.update_jumps(state);
        iterations += solve_with_fixed_jumps(state, Points::stay);
      }
    return iterations + (level_.unbounded_liquid() == nullptr ? 0 : settle_faces(state));
  }


  unsigned int
  NewtonSolver::settle_faces(State &state)
  {
    constexpr unsigned int max_solves = 20;
    unsigned int           iterations = 0;
    for (unsigned int i = 0; i < max_solves; ++i)
      {
        const unsigned int further = solve_with_fixed_jumps(state, Points::stay);
        iterations += further;
        if (further == 0)
          return iterations;
      }
    throw NumericalError("The velocities on the faces of the box did not settle in " + std::to_string(max_solves) +
                         " solutions of the Stokes equations: the box is too small for unbounded liquid around these shells.");
  }


  unsigned int
  NewtonSolver::solve_with_fixed_jumps(State &state, const Points points)
  {
    State          increment;
    const Residual r = level_.residual(state, {positions(state), 0.}, points);
    // Relative to the loads of the shells and of unit pressures, not to what the initial guess has left of them.
    double flux = 0.;
    for (const Residual::OfCapsule &capsule : r.capsules)
      flux += capsule.flux * capsule.flux;
    flux                = std::sqrt(layout_.sum(flux));
    const double wanted = std::max(1e-10, 1e-2 * parameters_.newton_tolerance) * level_.loads(state).l2_norm(), given = std::hypot(r.fluid.l2_norm(), flux);
    if (given <= wanted)
      return 0;
    const LinearReport report = linear_solve(r, linearised(state, frozen_shells(level_.finest_cell())), wanted / given, increment);
    if (!report.converged)
      {
        std::ostringstream message;
        message << "The Stokes solver did not converge: residual " << report.final_residual << " after " << report.iterations << " iterations, from "
                << report.initial_residual << '.';
        throw NumericalError(message.str());
      }
    add(state, 1., increment);
    return report.iterations;
  }
} // namespace tanktread
