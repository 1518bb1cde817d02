// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the linear system of a Newton iteration and its preconditioner.

#ifndef tanktread_solver_monolithic_system_h
#define tanktread_solver_monolithic_system_h

#include <tanktread/fluid/fluid.h>
#include <tanktread/solver/linearised_shell.h>

#include <memory>

namespace tanktread
{
  /** Block of the monolithic vectors that holds dpi (entry 0) and the nodal forces dF (entry 1 + 3 I + c); rank 0 owns all of it. */
  constexpr unsigned int shell_block = pressure_block + 1;

  /** Unknowns of the shell block, replicated. */
  struct ShellUnknowns
  {
    double        pressure_jump = 0.;
    ControlPoints force;
  };

  /** Zero vector with blocks (u_x, u_y, u_z, p, shell) for `n_control_points`. Collective. */
  FluidBlockVector
  monolithic_vector(const TaylorHoodSpace &space, unsigned int n_control_points);

  /** Copies the shell block to all ranks. Collective. */
  ShellUnknowns
  shell_unknowns(const FluidBlockVector &vector, MPI_Comm communicator);

  /** Stores replicated unknowns in the shell block. */
  void
  set_shell_unknowns(FluidBlockVector &vector, const ShellUnknowns &unknowns);

  /**
   * The Newton system in (du, dp, dpi, dF), dx being eliminated by LinearisedShell:
   *
   *     A du - B^T dp - R(dF + v dpi) - D_R dx = ...     D_R dx: motion of the spreading points
   *                                     - B du = ...
   *                                    - v . dw = ...
   *                  dF + (K - pi H_V) tau dw = ...     dx = tau dw + known part
   */
  class MonolithicOperator
  {
  public:
    MonolithicOperator(const StokesOperator &stokes, const LinearisedShell &shell)
      : stokes_(stokes)
      , shell_(shell)
    {}

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

  private:
    const StokesOperator  &stokes_;
    const LinearisedShell &shell_;
  };

  /**
   * Block-triangular: first the shell, with the surface mobility J A^{-1} J^T replaced by the inverse of a sparse operator
   *
   *     Z = c0 M_s + c1 L_s,   c0 = 4 mu k1 k2/(k1 + k2),   c1 = 4 mu/(k1 + k2),   k1 = 2/a,   k2 = pi/h,
   *
   * (mass and Laplace-Beltrami matrices on the current surface; c0 + c1 k^2 equals the symbol 4 mu k of the inverse mobility of a plane at both ends of the resolved
   * wave numbers), so dF = (1 + tau K Z^{-1})^{-1} r_F = Z (Z + tau K)^{-1} r_F; then the pressures; then one multigrid V-cycle a velocity component.
   */
  class MonolithicPreconditioner
  {
  public:
    /** Factors Z + tau K once; throws NumericalError if that is singular. `x`: current control points. `h`: finest fluid cell. */
    MonolithicPreconditioner(const StokesPreconditioner &stokes, const LinearisedShell &shell, const SubdivisionSurface &surface, const ControlPoints &x, double h);

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

  private:
    ControlPoints
    shell_force(const ControlPoints &r_F) const;

    const StokesPreconditioner &stokes_;
    const LinearisedShell      &shell_;
    SparseMatrix                Z_;
    Factorisation               factorisation_;
    double                      indicator_schur_;
    mutable FluidVector         velocity_scratch_;
  };
} // namespace tanktread

#endif
