// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the linear system of a Newton iteration and its preconditioner.

#ifndef tanktread_solver_monolithic_system_h
#define tanktread_solver_monolithic_system_h

#include <tanktread/base/timings.h>
#include <tanktread/coupling/shell_layout.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/solver/linearised_shell.h>
#include <tanktread/solver/pressure_jump_response.h>

namespace tanktread
{
  /**
   * The Newton system in (du, dp) and, for each capsule, (dpi, dG), dx being eliminated by LinearisedShell (sums over the capsules; the last two rows for
   * each):
   *
   *                   A du - B^T dp - sum [R(dG + v dpi) + D_R dx] = ...     D_R dx: motion of the spreading points
   *                                                      - B du = ...
   *                                                 - d(v . J u) = ...     volume flux through the shell
   *         Z_tau (Z_tau + tau (K - pi H_V))^{-1} (dG + (K - pi H_V) dx) = ...     dx = displacement(du) + known part
   *
   * With inertia its derivative is added to A.
   */
  class MonolithicOperator
  {
  public:
    /**
     * All are kept by reference. @param timings where to add what the parts take, or null. @param inertia linearised, or null. @param jumps_follow whether the
     * viscous part of the jumps changes with the flow.
     */
    MonolithicOperator(const StokesMap        &stokes,
                       const LinearisedShells &shells,
                       const ShellLayout      &layout,
                       Timings                *timings      = nullptr,
                       const Inertia          *inertia      = nullptr,
                       const bool              jumps_follow = false)
      : stokes_(stokes)
      , shells_(shells)
      , layout_(layout)
      , inertia_(inertia)
      , timings_(timings)
      , jumps_follow_(jumps_follow)
    {}

    /** The change of forces that belongs to unknowns. Collective. */
    void
    extend(const FluidBlockVector &unknowns, const ShellFields &densities, const std::vector<double> &pressure_jumps, ExtendedForces &forces) const
    {
      if (jumps_follow_)
        shells_.coupling().extend_change(unknowns, densities, forces, pressure_jumps);
      else
        shells_.coupling().extend(densities, forces, pressure_jumps);
    }

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

  private:
    const StokesMap        &stokes_;
    const LinearisedShells &shells_;
    const ShellLayout      &layout_;
    const Inertia *const    inertia_;
    Timings *const          timings_;
    const bool              jumps_follow_;
    mutable ExtendedForces  forces_;
  };

  /**
   * Block-triangular: the shells' forces (their rows are already close to the identity) and the pressure jumps first, then the pressures and
   * one multigrid V-cycle for the velocities.
   */
  class MonolithicPreconditioner
  {
  public:
    /** All are kept by reference. @param timings where to add what the parts take, or null. */
    MonolithicPreconditioner(const StokesInverse        &stokes,
                             const LinearisedShells     &shells,
                             const ShellLayout          &layout,
                             const PressureJumpResponse &pressure_jumps,
                             Timings                    *timings = nullptr);

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const;

  private:
    const StokesInverse        &stokes_;
    const LinearisedShells     &shells_;
    const ShellLayout          &layout_;
    const PressureJumpResponse &pressure_jumps_;
    Timings *const              timings_;
    mutable FluidBlockVector    loads_;
  };

  /** The densities of all unknowns, with those of the pressure jumps, dg + m dpi, or without. */
  ShellFields
  densities(const std::vector<ShellUnknowns> &unknowns);
  ShellFields
  densities_with_pressure(const std::vector<ShellUnknowns> &unknowns, const LinearisedShells &shells);
} // namespace tanktread

#endif
