// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kinks of the velocity and the jumps of the pressure at all shells.

#ifndef tanktread_coupling_shell_jumps_h
#define tanktread_coupling_shell_jumps_h

#include <tanktread/coupling/jump_enrichment.h>
#include <tanktread/coupling/pressure_without_mean.h>
#include <tanktread/coupling/shell_pairs.h>
#include <tanktread/coupling/shell_transfer.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** Nodal forces f of all shells where the fluid feels them; without a jump of the pressure, P f, if there are jumps. */
  struct ExtendedForces
  {
    std::vector<double>      at_points;     // force times area at the points of all shells on this rank, 3 numbers each
    std::vector<double>      normal_parts;  // multiples of v that P f lacks, for each shell
    std::vector<VertexArray> at_vertices;   // f_t and f_n of each shell; only if there are jumps
    bool                     whole = false; // with all that does not depend on the forces, see JumpEnrichment::complete()
  };

  /**
   * The jumps of JumpEnrichment for each shell and of ShellPairs for shells in the same cells, with what they have in common: the pressure, the nodes and the
   * messages. Of no shell at all (the plain interface) it adds nothing, at
   * no cost.
   */
  class ShellJumps
  {
  public:
    /** @param n_shells that have jumps: all or none. Keeps `space` by reference. Collective. */
    ShellJumps(const TaylorHoodSpace &space, const ViscosityContrast &contrast, unsigned int n_shells);

    bool
    are_none() const
    {
      return shells_.empty();
    }

    /** @param points of all shells, kept by reference. Collective. */
    void
    move(const std::vector<ShellTransfer> &transfers, const PointInterpolation &points);

    /** Makes at_vertices from at_points. Collective. */
    void
    extend(ExtendedForces &forces) const;

    /** Adds what another viscosity inside and the undisturbed flow contribute and marks the forces as whole. */
    void
    complete(ExtendedForces &forces) const;

    /** load += factor (R f without <f, v>). Collective. */
    void
    add_load(const ExtendedForces &forces, double factor, FluidBlockVector &load) const;

    /** values += (R^T fields without the values of u_h) + Q forces at the points of all shells, the latter unless null. Collective. */
    void
    add_velocities(const FluidBlockVector &fields, const ExtendedForces *forces, std::vector<double> &values) const;

    /** Of shell c, see JumpEnrichment::carry_pressure(). Collective. */
    void
    carry_pressure(unsigned int c, const ExtendedForces &forces, VertexSides &sides, FluidBlockVector &fields) const;

    /** See JumpEnrichment; gradients and Laplacians are those of u_inf + u_h at the points of all shells. Collective. */
    void
    update_viscous_forces(const std::vector<double> &gradients, const std::vector<double> &laplacians, const ExtendedForces &forces);

    /** Adds what these changes of gradients and forces will change of them, to first order. Collective. */
    void
    add_viscous_change(const std::vector<double> &gradients, ExtendedForces &forces) const;

    /** 2 ((mu - 1) eps(u_inf), eps(psi)). Collective. */
    double
    undisturbed_work(const ExtendedForces &forces) const;

    /** How often a shell cuts a cell that is not a finest one, in which its jumps are missing, since move(); on all ranks together. */
    unsigned int
    n_coarse_cut_cells() const
    {
      return n_coarse_cut_cells_;
    }
    const std::vector<JumpEnrichment> &
    shells() const
    {
      return shells_;
    }
    const ShellPairs &
    pairs() const
    {
      return pairs_;
    }

  private:
    const TaylorHoodSpace                &space_;
    const double                          viscosity_ratio_;
    std::vector<JumpEnrichment>           shells_;
    ShellPairs                            pairs_;
    std::unique_ptr<PressureWithoutMean>  pressure_; // none without shells
    unsigned int                          n_coarse_cut_cells_ = 0;
    mutable std::vector<VertexArray>      duals_; // memory of the calls
    mutable dealii::AlignedVector<double> pressures_;
  };
} // namespace tanktread

#endif
