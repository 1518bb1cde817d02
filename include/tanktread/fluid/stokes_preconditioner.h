// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block-triangular preconditioner of the Stokes equations.

#ifndef tanktread_fluid_stokes_preconditioner_h
#define tanktread_fluid_stokes_preconditioner_h

#include <tanktread/base/timings.h>
#include <tanktread/fluid/multigrid.h>
#include <tanktread/fluid/pressure_mass.h>
#include <tanktread/fluid/stokes_operator.h>

namespace tanktread
{
  /**
   * Upper block-triangular: pressure first, z_p = -mu M_p^{-1} r_p (the mass matrix is spectrally equivalent to the Schur complement B A^{-1} B^T / mu), then
   * one multigrid V-cycle for the velocities of r_u + B^T z_p. All in single precision, which costs no iteration.
   *
   * Where inertia puts s times the mass matrix to A, the Schur complement's inverse is about mu M_p^{-1} + s L_p^{-1} (Cahouet and Chabard), L_p the pressures'
   * Laplace matrix, and one V-cycle stands for L_p^{-1}.
   */
  class StokesPreconditioner
  {
  public:
    StokesPreconditioner(const StokesPreconditioner &) = delete; // its parts know each other's places

    /**
     * Keeps both by reference, and the pointer; the multigrids have climbed to the mesh of `space`. Collective. @param pressure_multigrid of linear elements,
     * needed with inertia only.
     */
    StokesPreconditioner(const TaylorHoodSpace &space, Multigrid<float> &multigrid, Multigrid<float> *pressure_multigrid = nullptr);

    /**
     * From now on for A + shift times the velocities' mass matrix. Throws std::logic_error if there is no multigrid for the pressure that a shift needs.
     * Collective.
     */
    void
    set_shift(double shift);

    /** Weights the pressures' mass with 1/mu and gives the multigrid the cells' means of mu. Collective. */
    void
    set_viscosity(const Viscosity &viscosity);

    /** dst = P^{-1} src on blocks 0 and 1. Collective. @param timings where to add what its parts take, or null. */
    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src, Timings *timings = nullptr) const;

    const TaylorHoodSpace &
    space() const
    {
      return space_;
    }

  private:
    /** z_p = -M_p^{-1} r_p, the pressures of `dst`, and B^T z_p in load_. */
    void
    solve_pressure(FluidBlockVector &dst, const FluidBlockVector &src) const;
    /** Diagonal of the pressure mass and its largest eigenvalue. */
    void
    prepare_pressure_mass();
    /** p_ += shift L_p^{-1} r_p_ */
    void
    add_inertial_pressure() const;

    const TaylorHoodSpace                    &space_;
    Multigrid<float>                         &multigrid_;
    Multigrid<float> *const                   pressure_multigrid_;
    double                                    shift_ = 0.;
    const InstructionSet                      instructions_;
    PressureMass                              pressure_mass_;
    ChebyshevSmoother<PressureMass, float, 1> pressure_mass_inverse_;
    mutable dealii::AlignedVector<float>      p_, r_p_, load_; // full arrays
  };
} // namespace tanktread

#endif
