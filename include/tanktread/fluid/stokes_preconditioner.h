// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block-triangular preconditioner of the Stokes equations.

#ifndef tanktread_fluid_stokes_preconditioner_h
#define tanktread_fluid_stokes_preconditioner_h

#include <tanktread/base/timings.h>
#include <tanktread/fluid/multigrid.h>
#include <tanktread/fluid/pressure_mass.h>
#include <tanktread/fluid/pressure_projection.h>
#include <tanktread/fluid/stokes_operator.h>

namespace tanktread
{
  /**
   * The factors of a block elimination, each about: first the pressure z_p = -S^{-1} (r_p + B A^{-1} r_u), S = B A^{-1} B^T, with mu M_p^{-1} in place of S^{-1}
   * for r_p (the mass matrix is spectrally equivalent to mu S) and PressureProjection for what is left of it, then one multigrid V-cycle for the velocities of
   * r_u + B^T z_p. All in single precision, which costs no iteration.
   *
   * Where inertia puts s times the mass matrix to A, the Schur complement's inverse is about mu M_p^{-1} + s L_p^{-1} (Cahouet and Chabard), L_p the pressures'
   * Laplace matrix, and one V-cycle stands for L_p^{-1}.
   */
  class StokesPreconditioner : public StokesInverse
  {
  public:
    StokesPreconditioner(const StokesPreconditioner &) = delete; // its parts know each other's places

    /**
     * Keeps all by reference; the multigrids, that of the pressure of linear elements, have climbed to the mesh of `space`. Collective.
     */
    StokesPreconditioner(const TaylorHoodSpace &space, Multigrid<float> &multigrid, Multigrid<float> &pressure_multigrid);

    /** From now on for A + shift times the velocities' mass matrix. Collective. */
    void
    set_shift(double shift);

    /** Weights the pressures' mass with 1/mu and gives the multigrid the cells' means of mu. Collective. */
    void
    set_viscosity(const Viscosity &viscosity);

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src, Timings *timings = nullptr) const override;

    const TaylorHoodSpace &
    space() const override
    {
      return space_;
    }

  private:
    /** z_p, the pressures of `dst`, and B^T z_p in load_. */
    void
    solve_pressure(FluidBlockVector &dst, const FluidBlockVector &src) const;
    /** Diagonal of the pressure mass and its largest eigenvalue. */
    void
    prepare_pressure_mass();

    const TaylorHoodSpace                    &space_;
    Multigrid<float>                         &multigrid_;
    double                                    shift_ = 0.;
    const InstructionSet                      instructions_;
    PressureProjection                        projection_;
    PressureMass                              pressure_mass_;
    ChebyshevSmoother<PressureMass, float, 1> pressure_mass_inverse_;
    mutable dealii::AlignedVector<float>      p_, r_p_, load_; // full arrays
  };
} // namespace tanktread

#endif
