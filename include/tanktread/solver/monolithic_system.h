// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the linear system of a Newton iteration and its preconditioner.

#ifndef tanktread_solver_monolithic_system_h
#define tanktread_solver_monolithic_system_h

#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/solver/linearised_shell.h>

namespace tanktread
{
  /** Block of the monolithic vectors that holds dpi (entry 0) and the nodal forces dG (entry 1 + 3 I + c); rank 0 owns all of it. */
  constexpr unsigned int shell_block = pressure_block + 1;

  /** Unknowns of the shell block, replicated. */
  struct ShellUnknowns
  {
    double        pressure_jump = 0.;
    ControlPoints force;
  };

  /** Zero vector with blocks (u, p, shell) for `n_control_points`. Collective. */
  FluidBlockVector
  monolithic_vector(const TaylorHoodSpace &space, unsigned int n_control_points);

  /** Copies the shell block to all ranks. Collective. */
  ShellUnknowns
  shell_unknowns(const FluidBlockVector &vector, MPI_Comm communicator);

  /** Stores replicated unknowns in the shell block. */
  void
  set_shell_unknowns(FluidBlockVector &vector, const ShellUnknowns &unknowns);

  /**
   * The Newton system in (du, dp, dpi, dG), dx being eliminated by LinearisedShell:
   *
   *                      A du - B^T dp - R(dG + v dpi) - D_R dx = ...     D_R dx: motion of the spreading points
   *                                                      - B du = ...
   *                                                 - d(v . J u) = ...     volume flux through the shell
   *         Z_tau (Z_tau + tau (K - pi H_V))^{-1} (dG + (K - pi H_V) dx) = ...     dx = displacement(du) + known part
   *
   * With inertia its derivative is added to A.
   */
  class MonolithicOperator
  {
  public:
    /** @param timings where to add what the parts take, or null. @param inertia linearised, or null. */
    MonolithicOperator(const StokesOperator &stokes, const LinearisedShell &shell, Timings *timings = nullptr, const Inertia *inertia = nullptr)
      : stokes_(stokes)
      , shell_(shell)
      , inertia_(inertia)
      , timings_(timings)
    {}

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

  private:
    const StokesOperator  &stokes_;
    const LinearisedShell &shell_;
    const Inertia *const   inertia_;
    Timings *const         timings_;
    mutable ExtendedForces forces_;
  };

  /**
   * Block-triangular: the shell's forces (their row is already close to the identity) and the pressures first, with the mass matrix for the Schur complement and the
   * capsule's volume, over the mean viscosity, for that of the pressure jump; then one multigrid V-cycle for the velocities.
   */
  class MonolithicPreconditioner
  {
  public:
    /** @param volume of the capsule over the mean of the viscosities inside and outside. @param timings where to add what the parts take, or null. */
    MonolithicPreconditioner(const StokesPreconditioner &stokes, const LinearisedShell &shell, double volume, Timings *timings = nullptr);

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

  private:
    const StokesPreconditioner &stokes_;
    const LinearisedShell      &shell_;
    double                      volume_;
    Timings *const              timings_;
    mutable FluidBlockVector    loads_;
  };
} // namespace tanktread

#endif
