// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the pressure that belongs to loads on the velocities.

#ifndef tanktread_fluid_pressure_projection_h
#define tanktread_fluid_pressure_projection_h

#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/multigrid.h>
#include <tanktread/fluid/taylor_hood_space.h>

#include <vector>

namespace tanktread
{
  /**
   * The pressure whose gradient takes most of the divergence out of a load r_u,
   *
   *     z_p = -L_p^{-1} B D^{-1} r_u,
   *
   * which is -S^{-1} B A^{-1} r_u, S = B A^{-1} B^T, as far as divergence and Laplacian commute (Elman, Silvester and Wathen, Finite Elements and Fast
   * Iterative Solvers, section 9.2), for any viscosity. D is diagonal, the sums of rows of the velocities' mass matrix (on cubes 125/64 of its diagonal) over
   * 1.236: B D^{-1} B^T lies between 0.82 and 1.18 times the pressures' Laplace matrix L_p on a mesh of equal cells, by its symbol. One V-cycle stands for
   * L_p^{-1}; of its result, known up to a constant, the mean is taken away. Everything in single precision, on full arrays (see NodeSpace).
   */
  class PressureProjection
  {
  public:
    /** Keeps both by reference; the multigrid, of linear elements, has climbed to the mesh of `space`. Collective. */
    PressureProjection(const TaylorHoodSpace &space, Multigrid<float> &multigrid);

    /** p += L_p^{-1} (shift r_p - B D^{-1} r_u) for owned nodes. The first term is what inertia asks for, see StokesPreconditioner. Collective. */
    void
    add(const FluidVector &r_u, double shift, const float *r_p, float *p) const;

  private:
    const TaylorHoodSpace               &space_;
    Multigrid<float>                    &multigrid_;
    const InstructionSet                 instructions_;
    std::vector<float>                   inverse_mass_;      // D^{-1}, one number an owned node
    std::vector<float>                   integrals_;         // of the pressures' functions over the volume of the box, one an owned node
    mutable dealii::AlignedVector<float> load_, divergence_; // full arrays
  };
} // namespace tanktread

#endif
