// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the nonlinear system of a time level: what is wrong with a state, and what a state means.

#ifndef tanktread_solver_time_level_h
#define tanktread_solver_time_level_h

#include <tanktread/base/timings.h>
#include <tanktread/coupling/coupling.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/fluid/undisturbed_flow.h>
#include <tanktread/solver/distributed_shell.h>
#include <tanktread/solver/solver_memory.h>
#include <tanktread/solver/state.h>
#include <tanktread/solver/unbounded_liquid.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** What liquids and flow a scene has. */
  struct Liquids
  {
    FlowInTime flow;
    double     viscosity_ratio = 1.;    // inside over outside
    double     reynolds_number = 0.;    // the density in the scene's units; 0 leaves inertia out
    bool       unbounded       = false; // the box is a part of unbounded liquid: see UnboundedLiquid

    double
    mean_viscosity() const
    {
      return 0.5 * (1. + viscosity_ratio);
    }
  };

  /** A step in time: x = xhat + tau dx/dt, and likewise uhat for velocities where there is inertia. */
  struct TimeStep
  {
    ShellFields        xhat;
    double             tau;
    double             time = 0.;      // of the level to come
    const FluidVector *uhat = nullptr; // not read without inertia
  };

  /** A residual (r_u, r_p; for each capsule r_x, r_F, r_pi, r_V). */
  struct Residual
  {
    struct OfCapsule
    {
      ControlPoints velocity; // J P^{-1} (r_u, r_p), P the Stokes preconditioner: about how fast the missing forces would move the shell
      ControlPoints x;        // x - xhat - tau (J u + undisturbed flow) - sigma m
      ControlPoints force;    // F - f(x)
      double        flux;     // v . (J u + u_inf)
      double        volume;   // V - V0
    };

    FluidBlockVector       fluid; // A u - B^T p - sum R(F + pi v), -B u
    std::vector<OfCapsule> capsules;
  };

  /**
   * The unknowns of a time level satisfy, with sums over the capsules and the last two lines for each of them,
   *
   *     A u - B^T p = sum R(x)(F + pi v(x)),   B u = 0,   v . (J(x) u + u_inf) = 0,   F = f(x),
   *     x = xhat + tau (J(x) u + u_inf(x)) + sigma m(x),   V(x) = V0,   v = dV/dx,   m = M^{-1} v.
   *
   * xhat and tau carry the time scheme: x_n and dt for backward Euler. The pressure jump pi lets no volume through the shell at the new time level; what a
   * finite step
   * along such a velocity still changes of the volume is an error of the time scheme, which the uniform normal displacement sigma m takes away. (To ask
   * the fluid for that volume instead would drive flow through the shell against incompressibility, with a pressure jump that grows like dt/h.)
   *
   * With another viscosity inside, A is the strain form with it, and the undisturbed flow has the load -2 ((mu - 1) eps(u_inf), eps(v)).
   */
  class TimeLevel
  {
  public:
    /** All arguments of class type are kept by reference. */
    TimeLevel(const Liquids &liquids, const DistributedShell &elasticity, Coupling &coupling, SolverMemory &memory, Timings &timings);

    /** To be called for every new fluid mesh; the fluid is kept by reference and gets the viscosity. */
    void
    attach(Fluid &fluid);

    /** To be called when ShellLayout::assign() has given capsules to other teams: forgets where shells were. */
    void
    reassign();

    /** Makes the undisturbed flow that of step.time, and inertia that of the step; null: of a step of no length, at `time`. Collective. */
    void
    begin(const TimeStep &step);
    void
    begin_at_rest(double time);

    /** Whether the coupling's points go to where the state has the shells. */
    enum class Points
    {
      follow,
      stay
    };
    /**
     * Points::follow moves the points to the state's positions, and carries the pressure over. Collective. Throws NumericalError for shells that are degenerate
     * or out of the box.
     */
    Residual
    residual(State &state, const TimeStep &step, Points points);

    /** Moves the coupling's points to the state's positions, and carries the pressure over. Collective. */
    void
    move_points(State &state);
    /** Viscosity of shells where the state has them, and the load of the undisturbed flow with it. Nothing with one viscosity. Collective. */
    void
    set_viscosity(const State &state);
    /** Where the shells were when the preconditioner's viscosity was set. */
    const ShellFields &
    preconditioner_x() const
    {
      return preconditioner_x_;
    }
    /** Viscosities of shells where they were when they were set on this mesh, that of the preconditioner first; nothing where there were none. Collective. */
    void
    restore_viscosities(const ShellFields &preconditioner_x, const ShellFields &viscosity_x);
    /** How far the shells are from where the viscosity was set; zero with one viscosity. Collective. */
    double
    viscosity_distance(const State &state) const;
    /** Makes the viscous part of the jumps that of the present flow. Collective. */
    void
    update_jumps(const State &state);

    /** The rank's own shells of a state, computed once for the same positions. */
    const ShellConfigurations &
    shells(const State &state);

    /** Velocity of the control points, J u + u_inf; the coupling's points must be near the state's positions, as they are after a solve. Collective. */
    ShellFields
    shell_velocity(const State &state);

    /** The flow with the velocities that it has on the faces of the box, and the spaces that it is in. Collective. */
    FluidBlockVector
    whole_fields(const State &state);
    const TaylorHoodSpace &
    whole_space() const
    {
      return unbounded_ ? unbounded_->faces().whole_space() : fluid_->space();
    }

    /** Residual::OfCapsule::velocity of each shell. Collective. */
    ShellFields
    shell_velocity_of(const FluidBlockVector &load) const;

    /** Loads of the shells' forces, of unit pressure jumps and of the undisturbed flow: what residuals of the flow are small against. Collective. */
    FluidBlockVector
    loads(const State &state);

    /** F = f(x) for all capsules. Collective. */
    void
    set_forces(State &state) const;

    /**
     * What more than the undisturbed flow dissipates, the integral of 2 mu eps : eps of the whole flow over the box minus that of the undisturbed flow: the
     * shells' work on the disturbance and, with another viscosity inside,
     * 2 ((mu - 1) eps(u_inf), eps(u)) + 2 ((mu - 1) eps(u_inf), eps(u_inf)). Collective.
     */
    double
    dissipation(const State &state);

    /** Power that goes into the disturbance's kinetic energy, by the last step; zero without inertia. Collective. */
    double
    inertial_power(const State &state) const;

    /**
     * Makes the pressure of `state` that of the sides on which the coupling's points have the vertices; a state of another time can then be combined with those
     * of the present. Collective.
     */
    void
    carry_pressure(State &state) const;

    const Liquids &
    liquids() const
    {
      return liquids_;
    }
    bool
    has_inertia() const
    {
      return liquids_.reynolds_number > 0.;
    }
    bool
    has_viscosities() const
    {
      return liquids_.viscosity_ratio != 1.;
    }
    /** The undisturbed flow at the time of the level. */
    const UndisturbedFlow &
    flow() const
    {
      return flow_;
    }
    /** 2 ((mu - 1) eps(u_inf), eps(v)); empty with one viscosity. */
    const FluidVector &
    undisturbed_load() const
    {
      return undisturbed_load_;
    }
    Coupling &
    coupling() const
    {
      return coupling_;
    }
    const DistributedShell &
    elasticity() const
    {
      return elasticity_;
    }
    const Fluid &
    fluid() const
    {
      return *fluid_;
    }
    /** Null without. */
    Inertia *
    inertia() const
    {
      return inertia_.get();
    }
    /** Null in a box of its own. */
    UnboundedLiquid *
    unbounded_liquid() const
    {
      return unbounded_.get();
    }
    double
    finest_cell() const
    {
      return fluid_->mesh().cell_size(fluid_->mesh().finest_level());
    }

  private:
    const Liquids                   &liquids_;
    const DistributedShell          &elasticity_;
    Coupling                        &coupling_;
    SolverMemory                    &memory_;
    Timings                         &timings_;
    UndisturbedFlow                  flow_;
    FluidVector                      undisturbed_load_;
    ShellFields                      preconditioner_x_; // where the shells were when its viscosity was set; empty: nowhere on this mesh
    std::unique_ptr<Inertia>         inertia_;          // none without it
    std::unique_ptr<UnboundedLiquid> unbounded_;        // none in a box of its own
    Fluid                           *fluid_ = nullptr;
    ShellConfigurations              shells_; // where they were asked for last
  };
} // namespace tanktread

#endif
