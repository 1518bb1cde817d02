// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Newton's method for a time level.

#ifndef tanktread_solver_newton_solver_h
#define tanktread_solver_newton_solver_h

#include <tanktread/fluid/linear_solver.h>
#include <tanktread/solver/implicit_shells.h>
#include <tanktread/solver/monolithic_system.h>
#include <tanktread/solver/solver_parameters.h>
#include <tanktread/solver/time_level.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tanktread
{
  /** What a solve did; never ignore `converged`. */
  struct NewtonReport
  {
    bool                converged         = false;
    unsigned int        newton_iterations = 0;
    unsigned int        linear_iterations = 0;
    std::vector<double> residuals;    // norm before the first and after each iteration
    std::vector<double> step_lengths; // of the line search
    std::string         message;      // why it failed
  };

  /**
   * Solves for all unknowns of a TimeLevel together, by Newton's method with the complete derivative. All parts of a residual are measured as velocities of the
   * shells, in a per unit of
   * time: that of J P^{-1} (r_u, r_p) with the Stokes preconditioner P, |r_x| / tau, |(Z_tau + tau (K - pi H_V))^{-1} r_F| with the operators that
   * ImplicitShells holds, r_pi / (3 V0) and r_V / (3 V0 tau), the first three as root mean squares over the
   * control points. (The Euclidean norm of the load vector r_u would not do: moving the shell within a cell redistributes loads among the
   * nodes, which changes the vector much and the flow little.)
   *
   * With another viscosity inside, the viscosity stays while the linear system is solved and during line search; after an
   * iteration it follows the shell as the points of the enriched interface do. So does what the viscosities contribute to the jumps of that interface
   * (JumpEnrichment), which stays for the rest of the step when the residual after a sweep is below ten times the tolerance, or half of the iterations allowed
   * are over.
   */
  class NewtonSolver
  {
  public:
    /** All arguments are kept by reference. */
    NewtonSolver(const SolverParameters &parameters, TimeLevel &level, SolverMemory &memory, Timings &timings);

    /**
     * Advances `state`, which holds the initial guess, to the solution. If the report says that it did not converge, `state` is as it was. Collective.
     *
     * The shells' implicit operators are those of an earlier iteration or time level as long as ImplicitShells says that they serve. They change between
     * iterations only, at the
     * linearisation, so that residuals compared in a line search are measured alike. An iteration that fails with old operators is done again with new ones.
     *
     * Where an iteration fails with the exact tangent, which may be indefinite, the positive one takes its place, until the solution is so much nearer that the exact one deserves another try.
     *
     * Iterations whose displacement |r| tau is longer than a quarter of a cell freeze the points, the others use the complete derivative and converge
     * quadratically.
     */
    NewtonReport
    solve(State &state, const TimeStep &step);

    /**
     * The Stokes flow at fixed shells and forces F = f(x), at `time`: u, p and pi such that no volume flows through the shells. Returns the linear iterations.
     * Throws
     * NumericalError if it fails. Collective.
     */
    unsigned int
    solve_flow(State &state, double time = 0.);

    /** What a liquid with inertia starts from, which cannot jump to another flow: no disturbance, and F = f(x). Collective. */
    void
    start_undisturbed(State &state);

    const ImplicitShells &
    implicit_shells() const
    {
      return implicit_shells_;
    }
    /** To be called when ShellLayout::assign() has given capsules to other teams. */
    void
    reassign()
    {
      implicit_shells_.reassign();
    }

  private:
    using Points = TimeLevel::Points;

    /** How far a step has come, and what its next iteration is going to be like. */
    struct Progress
    {
      double       length;                                              // about that of the next displacement
      bool         cautious  = false;                                   // with the positive tangent after a failure
      double       failed_at = std::numeric_limits<double>::infinity(); // residual at which the exact tangent failed last in this step
      unsigned int n_moves   = 1;                                       // of the points or the viscosity
      bool         settled   = false; // the viscous part of the jumps: what a further sweep would change is small, or too many of them have been done already
      bool         followed  = false; // points, viscosity and jumps are those of the state after the last iteration
      bool         tolerable = false; // the tolerances are met
      bool         solved    = false; // and the work of what is missing is small
      unsigned int n_refinements = 0; // iterations after the tolerance had been met, until is_balanced()
    };

    /**
     * What line search does with the points: those of the enriched interface stay, at fixed positions J is the transpose of R and the linear system their exact
     * derivative.
     */
    Points
    trial_points() const
    {
      return level_.coupling().knows_motion() ? Points::follow : Points::stay;
    }
    void
    iterate_to_solution(State &trial, const TimeStep &step, NewtonReport &report);
    /** An iteration from `state` and its residual `r`. Returns why it failed, or nothing. */
    std::string
    iterate(State &state, Residual &r, const TimeStep &step, Progress &progress, NewtonReport &report);
    /** After a failure with this residual: a new implicit operator or another tangent for the next try. Throws NumericalError when there is none left. */
    void
    react(const std::string &failure, bool renewed, double residual, Progress &progress);
    /** With the positive tangent: whether the exact one deserves a try. */
    bool
    exact_may_serve(const Progress &progress, const NewtonReport &report) const;
    /**
     * With the enriched interface or another viscosity inside: moves points and viscosity after the shells unless they are close enough, so that no solution is
     * accepted with them elsewhere, and, unless settled, makes the viscous part of
     * the jumps that of the present flow. Returns true if anything has changed.
     */
    bool
    follow_shells(State &state, Progress &progress);
    LinearisedShells
    linearised(const State &state, const Linearisation &choice);
    /** Part of the norm that needs no linearisation. Collective. */
    double
    speed(const Residual &r, double tau) const;
    double
    norm(const Residual &r, double tau) const;
    bool
    is_solved(const Residual &r, double norm) const;
    /**
     * Whether what is missing in a solution does no work to speak of, in a liquid at rest: over a step Delta = x - xhat by w = J P^{-1} (r_u, r_p)
     *
     *     |r_F . Delta| + |(F + pi v) . (r_x + tau w)| + |pi r_V|  <=  (|(F + pi v) . Delta| + 3 V0 mu tolerance^2 tau) / 10,
     *
     * the right side a part of what the step dissipates, at least of what a flow of the speed of Newton's tolerance would. A stiff shell needs it: its energy feels displacements that the tolerance, a velocity, lets through.
     * True in any other flow, whose work keeps the dissipation away from zero. Collective.
     */
    bool
    is_balanced(const State &state, const Residual &r, const TimeStep &step) const;
    void
    use(Tangent tangent);
    /** Relative residual at which the linear solver may stop when the norm of the nonlinear residual is `norm`. */
    double
    forcing_term(const double norm) const
    {
      // As accurate as the second order of the iteration deserves, but no more than the tolerance asks for. Points that follow their shell, whose motion the
      // linear system does not know, leave 0.02 of a residual in any case, and 0.03 with the jumps that another viscosity makes.
      const double known = level_.coupling().knows_motion() ? 0. : level_.has_viscosities() ? 0.01 : 0.006;
      return std::min(parameters_.linear_tolerance, std::max({0.3 * norm, known, 0.3 * parameters_.newton_tolerance / norm}));
    }
    /** Error that ShellMotion may have in an iteration that starts with the residual `norm`, which may lack the part of the forces. */
    double
    motion_accuracy(const double norm) const
    {
      return std::min(0.01, 0.1 * forcing_term(norm)); // small against what the linear solve leaves
    }
    unsigned int
    max_linear_iterations(double tau) const;
    LinearReport
    linear_solve(const Residual &r, const LinearisedShells &shells, double tolerance, State &increment, bool jumps_follow = false);
    void
    set_increment(const FluidBlockVector   &solution,
                  const Residual           &r,
                  const ShellFields        &dx0,
                  const LinearisedShells   &shells,
                  const MonolithicOperator &matrix,
                  State                    &increment) const;
    /**
     * Moves `state` along `increment` with the longest step length of 1, 1/2, ... that reduces the norm of the residual; returns 0 if there is none. A full step
     * after which follow_shells() would have something to do is tried with that done, then without.
     */
    double
    line_search(State &state, Residual &r, const State &increment, const TimeStep &step, Progress &progress);
    /** The full step with follow_shells(). */
    bool
    accept_following(State &state, Residual &r, const State &increment, const TimeStep &step, Progress &progress);
    /** Whether follow_shells() will change anything for these shells. */
    bool
    has_to_follow(const ShellFields &x, const Progress &progress);
    /** Moves `state` by `length` times `increment` if that reduces the norm of the residual, and `r` with it. */
    bool
    accept_if_better(State &state, Residual &r, const State &increment, const TimeStep &step, double length, Points points);
    /** How far shells may be from the points that stand for them, and from where the viscosity has them, in a solution. */
    double
    distance_allowed(const Progress &progress) const;
    /** solve_flow() with the viscous part of the jumps as it is. Returns the linear iterations. */
    unsigned int
    solve_with_fixed_jumps(State &state, Points points);
    /** Solves again until the velocities on the faces are those of the flow, in unbounded liquid. Returns the linear iterations. Throws NumericalError if they do not settle. */
    unsigned int
    settle_faces(State &state);

    const SolverParameters &parameters_;
    TimeLevel              &level_;
    SolverMemory           &memory_;
    Timings                &timings_;
    const ShellLayout      &layout_;
    const double            volume_; // V0, mean over the capsules
    ImplicitShells          implicit_shells_;
    KrylovBasis             krylov_basis_;

    std::optional<PressureJumpResponse> pressure_jumps_; // of the present step
  };
} // namespace tanktread

#endif
