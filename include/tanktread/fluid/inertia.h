// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the terms of inertia in the momentum equation.

#ifndef tanktread_fluid_inertia_h
#define tanktread_fluid_inertia_h

#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/fluid/undisturbed_flow.h>

namespace tanktread
{
  /**
   * Re ((u - uhat) / tau + (u_inf + u) . grad u + u . grad u_inf, v) for the disturbance u of the undisturbed flow u_inf, which solves the Navier-Stokes
   * equations by itself, with a force per volume if need be: its own inertia is not among the terms, du_inf/dt neither. uhat and tau carry the time scheme, as
   * for the positions of the shell: u_n and dt for backward Euler.
   *
   * Nothing is assembled; the integrals are those of the 3 x 3 x 3 Gauss rule on each cell. All calls are collective.
   */
  class Inertia
  {
  public:
    /** Keeps `space` by reference. `reynolds_number` is the density in the scene's units. */
    Inertia(const TaylorHoodSpace &space, double reynolds_number, const UndisturbedFlow &undisturbed);

    /** The undisturbed flow from now on: where it changes in time, that at the end of the step, set before begin_step(). */
    void
    set_flow(const UndisturbedFlow &undisturbed);

    /** The step to come: u = uhat + tau du/dt. `uhat` is the velocity block of a fluid vector. */
    void
    begin_step(const FluidVector &uhat, double tau);

    /** Re / tau, the factor of the velocities' mass matrix. */
    double
    mass() const
    {
      return mass_;
    }

    /** Adds the terms to the velocity block of `residual`. */
    void
    add_residual(const FluidBlockVector &u, FluidBlockVector &residual) const;

    /** Chooses the flow for add_derivative(). */
    void
    linearise(const FluidBlockVector &u);

    /** Adds the derivative of the terms in the direction du to the velocity block of `y`. */
    void
    add_derivative(const FluidBlockVector &du, FluidBlockVector &y) const;

    /** Power that the liquid takes up as kinetic energy: the terms times u, an inner product over all ranks. */
    double
    power(const FluidBlockVector &u) const;

  private:
    InertiaCoefficients<double>
    coefficients() const;

    const TaylorHoodSpace                &space_;
    const InstructionSet                  instructions_;
    const double                          reynolds_number_;
    UndisturbedFlow                       undisturbed_;
    double                                mass_ = 0.;
    const std::vector<double>             corners_;      // see lower_corners()
    FluidVector                           history_;      // mass() (uhat, v)
    mutable dealii::AlignedVector<double> flow_, u_, y_; // full arrays
  };
} // namespace tanktread

#endif
