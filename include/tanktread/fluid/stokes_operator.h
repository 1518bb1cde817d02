// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the discrete Stokes equations of one viscosity.

#ifndef tanktread_fluid_stokes_operator_h
#define tanktread_fluid_stokes_operator_h

#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/stokes_system.h>
#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/fluid/viscosity.h>

namespace tanktread
{
  /**
   * mu (grad u, grad v) - (p, div v), -(q, div u): with one viscosity in the whole box the same flow as the strain form, and the velocity components do not
   * know of each other but
   * through the pressure. All cells being cubes, nothing is assembled. The viscosity of the outer fluid is the unit, mu = 1.
   *
   * With a Viscosity mu that varies from m upwards the strain form 2 (mu eps(u), eps(v)) in all cells, without m (grad u^T, grad v), which is m (div u, div v)
   * and does nothing to a solenoidal u:
   * (mu grad u, grad v) + ((mu - m) grad u^T, grad v), positive definite point by point, and what it was where mu = m.
   */
  class StokesOperator : public StokesMap
  {
  public:
    /** Keeps `space` by reference. */
    explicit StokesOperator(const TaylorHoodSpace &space);

    /** @param viscosity kept by reference. */
    void
    set_viscosity(const Viscosity &viscosity);

    void
    vmult(FluidBlockVector &dst, const FluidBlockVector &src) const override;

    const TaylorHoodSpace &
    space() const
    {
      return space_;
    }

  private:
    const TaylorHoodSpace                &space_;
    const InstructionSet                  instructions_;
    const Viscosity                      *viscosity_ = nullptr; // null: 1 everywhere
    std::vector<double>                   cut_sizes_;           // of its cut cells
    std::vector<unsigned int>             cut_nodes_;           // 27 for each of them
    mutable dealii::AlignedVector<double> u_, p_, y_u_, y_p_;   // full arrays
  };

  /** The cells of a pair of spaces for the kernels. */
  Cubes
  cubes(const TaylorHoodSpace &space);

  /** Their lower corners, three numbers each. */
  std::vector<double>
  lower_corners(const TaylorHoodSpace &space);
} // namespace tanktread

#endif
