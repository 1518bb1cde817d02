// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the nonlinear system of a time level.

#ifndef tanktread_solver_newton_solver_h
#define tanktread_solver_newton_solver_h

#include <tanktread/base/timings.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/solver/implicit_shell.h>
#include <tanktread/solver/monolithic_system.h>
#include <tanktread/solver/solver_parameters.h>
#include <tanktread/solver/state.h>

#include <memory>
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

  /** A residual (r_u, r_p; r_x; r_F; r_pi; r_V). */
  struct Residual
  {
    FluidBlockVector fluid;    // A u - B^T p - R(F + pi v), -B u
    double        shell_speed; // root mean square of J P^{-1} (r_u, r_p), P the Stokes preconditioner: about how fast the missing forces would move the shell
    ControlPoints x;           // x - xhat - tau (J u + undisturbed flow) - sigma m
    ControlPoints force;       // F - f(x)
    double        flux;        // v . (J u + u_inf)
    double        volume;      // V - V0
  };

  /**
   * Solves for all unknowns of a time level together, by Newton's method with the complete derivative:
   *
   *     A u - B^T p = R(x)(F + pi v(x)),   B u = 0,   v . (J(x) u + u_inf) = 0,   F = f(x),
   *     x = xhat + tau (J(x) u + u_inf(x)) + sigma m(x),   V(x) = V0,   v = dV/dx,   m = M^{-1} v.
   *
   * xhat and tau carry the time scheme: x_n and dt for backward Euler. The pressure jump pi lets no volume through the shell at the new time level; what a finite step
   * along such a velocity still changes of the volume is an error of the time scheme, which the uniform normal displacement sigma m takes away. (To ask
   * the fluid for that volume instead would drive flow through the shell against incompressibility, with a pressure jump that grows like dt/h.) All parts of a residual are measured as velocities of the shell, in a per unit of
   * time: that of J P^{-1} (r_u, r_p) with the Stokes preconditioner P, |r_x| / tau, |(Z_tau + tau (K - pi H_V))^{-1} r_F| with the operator that ImplicitShell holds, r_pi / (3 V0) and r_V / (3 V0 tau), the first three as root mean squares over the
   * control points. (The Euclidean norm of the load vector r_u would not do: moving the shell within a cell redistributes loads among the
   * nodes, which changes the vector much and the flow little.)
   *
   * With another viscosity inside, A is the strain form with it, and the undisturbed flow has the load -2 ((mu - 1) eps(u_inf), eps(v)). The viscosity stays while the linear system is solved and during line search; after an
   * iteration it follows the shell as the points of the enriched interface do. So does what the viscosities contribute to the jumps of that interface (JumpEnrichment), which stays for the rest of the step when the residual after a sweep is below ten times the tolerance, or half of the iterations allowed are over.
   */
  class NewtonSolver
  {
  public:
    /**
     * All arguments of class type but the flow are kept by reference. `volume` is V0. @param viscosity_ratio inside over outside. @param reynolds_number the density in the scene's units; 0 leaves inertia
     * out.
     */
    NewtonSolver(const SolverParameters   &parameters,
                 const DistributedShell   &shell,
                 const SubdivisionSurface &surface,
                 Coupling                 &coupling,
                 double                    volume,
                 ShearFlow                 flow,
                 Timings                  &timings,
                 double                    viscosity_ratio = 1.,
                 double                    reynolds_number = 0.);

    bool
    has_inertia() const
    {
      return reynolds_number_ > 0.;
    }

    /** To be called for every new fluid mesh; the fluid is kept by reference and gets the viscosity. */
    void
    attach(Fluid &fluid);

    /**
     * Advances `state`, which holds the initial guess, to the solution. If the report says that it did not converge, `state` is as it was. Collective.
     *
     * The shell's implicit operator is that of an earlier iteration or time level as long as ImplicitShell says that it serves. It changes between iterations only, at the
     * linearisation, so that residuals compared in a line search are measured alike. An iteration that fails with an old operator is done again with a new one.
     *
     * Where the linear solver fails with the exact tangent, which may be indefinite, the positive one takes its place for the rest of the step, and until the solution of the next is near.
     *
     * Iterations whose displacement |r| tau is longer than a quarter of a cell freeze the points, the others use the complete derivative and converge quadratically.
     *
     * @param uhat velocities in the role of xhat, as with inertia they have a time scheme too; not read without it.
     */
    NewtonReport
    solve(State &state, const ControlPoints &xhat, double tau, const FluidVector *uhat = nullptr);

    /**
     * The Stokes flow at fixed shell `state.x` and forces F = f(x): u, p and pi such that no volume flows through the shell. Returns the linear iterations. Throws
     * NumericalError if it fails. Collective.
     */
    unsigned int
    solve_flow(State &state);

    /** What a liquid with inertia starts from, which cannot jump to another flow: no disturbance, and F = f(x). Collective. */
    void
    start_undisturbed(State &state);

    /** Power that goes into the disturbance's kinetic energy, by the last step; zero without inertia. Collective. */
    double
    inertial_power(const State &state) const;

    /** Velocity of the control points, J u + u_inf; the coupling's points must be at state.x, as they are after a solve. Collective. */
    ControlPoints
    shell_velocity(const State &state) const;

    /**
     * What more than the undisturbed flow dissipates, the integral of 2 mu eps : eps of the whole flow over the box minus that of the undisturbed flow: the shell's work on the disturbance and, with another viscosity inside,
     * 2 ((mu - 1) eps(u_inf), eps(u)) + 2 ((mu - 1) eps(u_inf), eps(u_inf)). Collective.
     */
    double
    dissipation(const State &state) const;

    /** Makes the pressure of `state` that of the sides on which the coupling's points have the vertices; a state of another time can then be combined with those of the present. Collective. */
    void
    carry_pressure(State &state) const;

    const ImplicitShell &
    implicit_shell() const
    {
      return implicit_shell_;
    }

  private:
    /** Whether the coupling's points go to where the state has the shell. */
    enum class Points
    {
      follow,
      stay
    };

    /** Points::follow moves the points to state.x, and carries the pressure over. */
    void
    move_points(State &state);
    Residual
    residual(State &state, const ControlPoints &xhat, double tau, Points points);
    /** What line search does with the points: those of the enriched interface stay, at fixed positions J is the transpose of R and the linear system their exact derivative. */
    Points
    trial_points() const;
    /**
     * With the enriched interface or another viscosity inside: moves points and viscosity after the shell unless they are close enough, so that no solution is accepted with them elsewhere, and, `with_jumps`, makes the viscous part of
     * the jumps that of the present flow. Returns true if anything has changed.
     */
    bool
    follow_shell(State &state, unsigned int &n_moves, bool with_jumps);
    /** Viscosity of a shell at x, and the load of the undisturbed flow with it. */
    void
    set_viscosity(const ControlPoints &x);
    /** solve_flow() with the viscous part of the jumps as it is. Returns the linear iterations. */
    unsigned int
    solve_with_fixed_jumps(State &state, Points points);
    /** Part of the norm that needs no linearisation. */
    double
    speed(const Residual &r, double tau) const;
    double
    norm(const Residual &r, double tau) const;
    double
    shell_speed(const FluidBlockVector &load) const;
    bool
    is_solved(const Residual &r, double norm) const;
    void
    use(Tangent tangent);
    LinearisedShell
    linearised(const State &state, const Linearisation &choice);
    double
    finest_cell() const;
    /** Relative residual at which the linear solver may stop when the norm of the nonlinear residual is `norm`. */
    double
    forcing_term(double norm) const;
    /** Error that ShellMotion may have in an iteration that starts with the residual `norm`, which may lack the part of the forces. */
    double
    motion_accuracy(double norm) const;
    LinearReport
    linear_solve(const Residual &r, const LinearisedShell &shell, double tolerance, State &increment);
    /**
     * Moves `state` along `increment` with the longest step length of 1, 1/2, ... that reduces the norm of the residual; returns 0 if there is none.
     */
    double
    line_search(State &state, Residual &r, const State &increment, const ControlPoints &xhat, double tau);
    /** An iteration that starts from `state` and its residual `r`, with its linearisation `shell`. Returns why it failed, or nothing. */
    std::string
    iterate(State &state, Residual &r, const LinearisedShell &shell, const ControlPoints &xhat, NewtonReport &report);

    const SolverParameters   &parameters_;
    const DistributedShell   &shell_;
    const SubdivisionSurface &surface_;
    Coupling                 &coupling_;
    const double              volume_;
    const ShearFlow           flow_;
    Timings                  &timings_;
    ImplicitShell             implicit_shell_;
    Tangent                   tangent_ = Tangent::exact; // to start a step with
    KrylovBasis               krylov_basis_;
    const double              viscosity_ratio_, reynolds_number_;
    ControlPoints             viscosity_x_;      // where the shell was when the viscosity was set
    FluidVector               undisturbed_load_; // 2 ((mu - 1) eps(u_inf), eps(v)); empty with one viscosity
    std::unique_ptr<Inertia>  inertia_;          // none without it
    Fluid                    *fluid_ = nullptr;
  };
} // namespace tanktread

#endif
