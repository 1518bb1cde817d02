// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kinks of the velocity and the jumps of the pressure at all shells.

#ifndef tanktread_coupling_shell_jumps_h
#define tanktread_coupling_shell_jumps_h

#include <tanktread/coupling/jump_enrichment.h>
#include <tanktread/coupling/pressure_without_mean.h>
#include <tanktread/coupling/shell_colours.h>
#include <tanktread/coupling/shell_pairs.h>
#include <tanktread/coupling/shell_transfer.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** Nodal forces f of all shells where the fluid feels them; without a jump of the pressure, P f, if there are jumps. */
  struct ExtendedForces
  {
    std::vector<double>      at_points;      // force times area at the points of all shells on this rank, 3 numbers each
    std::vector<double>      normal_parts;   // multiples of v that P f lacks, for each shell
    std::vector<double>      pressure_jumps; // pi of each shell
    std::vector<VertexArray> at_vertices;    // f_t and f_n of the shells of each colour; only if there are jumps
    bool                     whole = false;  // with all that does not depend on the forces, see JumpEnrichment::complete()
  };

  /**
   * The jumps of JumpEnrichment for all shells and of ShellPairs for shells in the same cells, with what they have in common: the pressure, the nodes and the
   * messages. Of no shell at all (the plain interface) it adds nothing, at
   * no cost.
   *
   * Shells that are far from each other share one JumpEnrichment, with its arrays over all vertices of the rank and its messages: they have the same colour
   * (shell_colours()), of which there are about as many as a shell has neighbours. What a shell has to do with are the vertices of the finest cells that contain
   * its points or touch one that does, and of any other cells that contain some, and the masters of these vertices where they hang. With h the size of the finest
   * cells and H >= h that of the largest with points these are max(3 h, 2 H) beyond its points at the most, the last h or H being that of the masters: twice
   * that is the margin. All ranks take part in the messages of all colours, wherever the shells are.
   */
  class ShellJumps
  {
  public:
    /** @param n_shells that have jumps: all or none. Keeps `space` by reference. Collective. */
    ShellJumps(const TaylorHoodSpace &space, const ViscosityContrast &contrast, unsigned int n_shells);

    bool
    are_none() const
    {
      return n_shells_ == 0;
    }

    /**
     * @param transfers of shells that have points on this rank or are near its cells, in the order of their points. @param numbers of these shells, ascending.
     * @param boxes about the points of all shells of the scene, by their numbers. @param points of all shells, kept by reference. Collective. Throws as
     * JumpEnrichment::move().
     */
    void
    move(const std::vector<ShellTransfer> &transfers,
         const std::vector<unsigned int>  &numbers,
         const std::vector<ShellBox>      &boxes,
         const PointInterpolation         &points);

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

    /** See tanktread::carry_pressure(), for all shells; afterwards `sides` are those since move(). Nothing but that if they were empty. Collective. */
    void
    carry_pressure(const ExtendedForces &forces, VertexSides &sides, FluidBlockVector &fields) const;

    /** See JumpEnrichment; gradients and Laplacians are those of u_inf + u_h at the points of all shells. Collective. */
    void
    update_viscous_forces(const std::vector<double> &gradients, const std::vector<double> &laplacians, const ExtendedForces &forces);

    /** The viscous forces of a flow, of all shells, and boxes about the shells then: what a run that goes on has to be given back. Not collective. */
    struct ViscousForces
    {
      std::vector<JumpEnrichment::ViscousForce> at_vertices;
      std::vector<ShellBox>                     boxes; // none before the first update
    };
    ViscousForces
    viscous_forces() const
    {
      return {viscous_forces_, viscous_boxes_};
    }
    /** To be followed by move(). */
    void
    set_viscous_forces(ViscousForces forces);

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
    /** Of the scene. */
    unsigned int
    n_shells() const
    {
      return n_shells_;
    }
    /** Of the shells of each colour. */
    const std::vector<JumpEnrichment> &
    colours() const
    {
      return colours_;
    }
    const ShellPairs &
    pairs() const
    {
      return pairs_;
    }

  private:
    void
    set_colours(const std::vector<ShellBox> &boxes, const PointInterpolation &points);
    /** Gives those of the flow before to the colours that the shells have now. */
    void
    give_viscous_forces();
    void
    set_sides();

    const TaylorHoodSpace                    &space_;
    const ViscosityContrast                   contrast_;
    const unsigned int                        n_shells_;
    std::shared_ptr<const NodeSpace>          vertices_; // and the next two: none without shells
    std::shared_ptr<const CellLocator>        locator_;
    std::unique_ptr<PressureWithoutMean>      pressure_;
    std::vector<ShellBox>                     boxes_;     // of all shells
    std::vector<unsigned int>                 colour_of_; // each of them
    std::vector<JumpEnrichment>               colours_;
    ShellPairs                                pairs_;
    VertexSides                               sides_;
    unsigned int                              n_coarse_cut_cells_ = 0;
    std::vector<ShellBox>                     viscous_boxes_;  // of the shells when the viscous forces were made; none before
    std::vector<JumpEnrichment::ViscousForce> viscous_forces_; // of all shells
    mutable std::vector<VertexArray>          duals_;          // memory of the calls
    mutable dealii::AlignedVector<double>     pressures_;
    mutable std::vector<double>               tractions_;
  };
} // namespace tanktread

#endif
