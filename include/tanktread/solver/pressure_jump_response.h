// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what unit pressure jumps at the shells do to the liquid, for the preconditioner.

#ifndef tanktread_solver_pressure_jump_response_h
#define tanktread_solver_pressure_jump_response_h

#include <tanktread/coupling/coupling.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/fluid/krylov_basis.h>

#include <vector>

namespace tanktread
{
  /** The Stokes operator with the derivative of inertia, if there is any. */
  struct FluidOperator
  {
    const StokesMap &stokes;
    const Inertia   *inertia = nullptr; // linearised

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
    {
      stokes.vmult(dst, src);
      if (inertia != nullptr)
        inertia->add_derivative(src, dst);
    }
  };

  /**
   * A pressure jump pi is the coefficient of a shell's indicator function chi among the pressures, which the continuous ones represent but for the cells that the
   * shell cuts. The Schur complement of
   * (p, pi) is therefore about that of p and, for the part of chi that is left over, s = |chi - e|^2/mu with the best approximation e, far less than |chi|^2/mu, the
   * volume over the viscosity:
   *
   *     pi = -(r_pi - e . r_p)/s.
   *
   * For e and s the Stokes equations are solved with the loads R v of all shells, roughly: -e is the pressure, s the flux through the shell and what is left of
   * the divergence. Loads of several shells are told apart by the nearest of their centres: so e has to be zero outside of all of them, its mean their part of
   * the box.
   */
  class PressureJumpResponse
  {
  public:
    /**
     * @param coupling has its points where the shells are. @param viscosity mean of inside and outside: the volume of a capsule over it stands in place of s where that is
     * not found. @param
     * basis memory that may be used. @param tolerance of that solution. Collective.
     */
    PressureJumpResponse(const FluidOperator &fluid,
                         const StokesInverse &preconditioner,
                         const Coupling      &coupling,
                         double               viscosity,
                         KrylovBasis         &basis,
                         double               tolerance = 0.1);

    /** pi of the rank's own capsules for the rows r_p of the pressures and r_pi of the fluxes. Collective. */
    std::vector<double>
    pressure_jumps(const FluidVector &r_p, std::vector<double> r_pi) const;

    /** s of the rank's own capsules. */
    const std::vector<double> &
    schur_complements() const
    {
      return s_;
    }

  private:
    /** Adds a constant pressure to e. Collective. */
    void
    set_mean(const TaylorHoodSpace &space, double mean);
    /** The capsule that each pressure of this rank belongs to, if there are several. */
    void
    assign_nodes(const TaylorHoodSpace &space, const Coupling &coupling);
    /** Sum of products of pressures, for each of the rank's own capsules. Collective. */
    std::vector<double>
    products(const FluidVector &p, const FluidVector &q) const;

    const ShellLayout        &layout_;
    FluidVector               e_; // of all capsules together
    std::vector<double>       s_;
    std::vector<unsigned int> capsule_of_node_; // by its number
  };
} // namespace tanktread

#endif
