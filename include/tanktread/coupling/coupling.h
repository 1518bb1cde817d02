// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shells and spreading of the shells' forces to the fluid, each the other's adjoint.

#ifndef tanktread_coupling_coupling_h
#define tanktread_coupling_coupling_h

#include <tanktread/coupling/interface.h>
#include <tanktread/coupling/shell_guests.h>
#include <tanktread/coupling/shell_jumps.h>
#include <tanktread/coupling/shell_layout.h>
#include <tanktread/coupling/shell_transfer.h>
#include <tanktread/coupling/shell_viscosity.h>
#include <tanktread/fluid/point_interpolation.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace tanktread
{
  /**
   * For each shell, with X_q = S x its points in the fluid, Phi the fluid's shape functions there, W the weights in reference area and M = S^T W S:
   *
   *     interpolation  J(x) u = M^{-1} S^T W Phi u        (velocity of the control points)
   *     spreading      R(x) f = Phi^T W S M^{-1} f = J^T f (load vector of nodal forces f)
   *
   * so the power f . J u = (R f) . u agrees to rounding. Loads of several shells add.
   *
   * With Interface::enriched R f has a part in the continuity equation too, J acts on the pressure, and the shells' own forces move them by Q f in addition, Q
   * symmetric (ShellJumps). The
   * enrichment is for P f = f - v (m . f)/(m . v) of each shell only, v its volume gradient and m = M^{-1} v: a constant normal force is the business of its
   * indicator pressure.
   *
   * Nodal fields (ShellFields) and shells are those of the rank's own capsules (ShellLayout), NP x 3 for each. Points are on the rank of their fluid cell alone: what
   * they need goes from the capsule's leader to the ranks where it is present, and sums over points come back (ShellGuests). What belongs to points or to present
   * capsules stays inside this class. Calls that take fluid vectors or shells are collective, and throw on all ranks alike. Forces are told by their
   * densities g = M^{-1} f, but where `f` stands for them, which costs a solve with M.
   */
  class Coupling
  {
  public:
    /** Keeps `layout` by reference. Coupling surfaces have second derivatives if the interface is enriched. */
    Coupling(const ShellLayout &layout, Interface interface);

    /** To be called before attach(), for another viscosity inside. */
    void
    set_viscosity_contrast(const ViscosityContrast &contrast)
    {
      contrast_ = contrast;
    }

    /** To be called for every new fluid mesh, before move(). Keeps `space` by reference. Collective. */
    void
    attach(const TaylorHoodSpace &space);

    /** To be called when ShellLayout::assign() has given capsules to other teams, before move(). */
    void
    reassign();

    /** Moves the points of all shells. Collective. Throws NumericalError when a point leaves the box, or a shell comes too near to an image of itself. */
    void
    move(const ShellConfigurations &shells);

    /** Largest distance of a control point of any capsule from where it was when the points were moved last; infinite before that. Collective. */
    double
    distance(const ShellConfigurations &shells) const;

    const ShellLayout &
    layout() const
    {
      return layout_;
    }
    /** The rank's own shells where the points were moved last. */
    const ShellConfigurations &
    shells() const
    {
      return shells_;
    }
    /** The capsules that are present on this rank, and the transfer of each. */
    const ShellGuests &
    guests() const
    {
      return guests_;
    }
    const std::vector<ShellTransfer> &
    transfers() const
    {
      return transfers_;
    }
    const ShellJumps &
    jumps() const
    {
      return *jumps_;
    }
    /** Those that jumps() has told of, on the same mesh; to be followed by move(). */
    void
    set_viscous_forces(ShellJumps::ViscousForces forces)
    {
      jumps_->set_viscous_forces(std::move(forces));
    }
    /** Whether J and R know how they change with the position of the points: not with jumps in the cells. */
    bool
    knows_motion() const
    {
      return interface_ == Interface::plain;
    }

    /** Viscosity of the fluid's cells with the shells there. Their coupling surfaces need second derivatives. Collective. */
    Viscosity
    viscosity(const ShellConfigurations &shells) const;

    /** Positions of the points of these shells. Not collective. */
    static std::vector<dealii::Point<3>>
    points(const ShellConfigurations &shells);

    /** Forces of densities g, and pressure jumps pi of the same capsules (empty: none), for several of the calls below. Collective. */
    void
    extend(const ShellFields &g, ExtendedForces &forces, const std::vector<double> &pressure_jumps = {}) const;

    /**
     * Extended forces of the shells in the whole flow: with what another viscosity inside and the undisturbed flow contribute, which is not linear in g. See
     * JumpEnrichment. Collective.
     */
    void
    extend_whole(const ShellFields &g, ExtendedForces &forces, const std::vector<double> &pressure_jumps = {}) const;

    /**
     * Changes of the forces where densities change by g and the flow by `change`: with that of the contribution which the flow makes with another viscosity inside,
     * to first order. Collective.
     */
    void
    extend_change(const FluidBlockVector &change, const ShellFields &g, ExtendedForces &forces, const std::vector<double> &pressure_jumps = {}) const;

    /** Makes that contribution the one of the flow `fields` with forces of densities g. Nothing with one viscosity or the plain interface. Collective. */
    void
    update_viscous_forces(const FluidBlockVector &fields, const ShellFields &g);

    /** What psi adds to 2 ((mu - 1) eps(u_inf), eps(u_h)). Collective. */
    double
    undisturbed_work(const ShellFields &g) const;

    /** M J fields: S^T W Phi u, and what the jumps add. */
    ShellFields
    velocity_moments(const FluidBlockVector &fields) const;

    /** M (J fields + Q f), f being extended. */
    ShellFields
    velocity_moments(const FluidBlockVector &fields, const ExtendedForces &f) const;

    /** J fields. */
    ShellFields
    interpolate(const FluidBlockVector &fields) const;

    /** J fields + Q f: the shells' part of the velocity that nodal forces f make. */
    ShellFields
    interpolate(const FluidBlockVector &fields, const ShellFields &f) const;
    ShellFields
    interpolate(const FluidBlockVector &fields, const ExtendedForces &f) const;

    /**
     * Velocity of the control points of `shells` in the undisturbed flow: its linear part there, which is exact, and M^{-1} S^T W of the rest at their points.
     * Collective.
     */
    ShellFields
    undisturbed_velocity(const UndisturbedFlow &flow, const ShellConfigurations &shells) const;

    /** M^{-1} f: control points of the force density per reference area. */
    ShellFields
    density(const ShellFields &f) const;

    /**
     * Adds to the pressure of `fields` what it jumps where the shells with nodal forces f have passed a vertex of the mesh since `sides`, which
     * become the sides at move(). Nothing if `sides` are empty, before
     * the first move() on a mesh, and with the plain interface. Collective.
     */
    void
    carry_pressure(const ShellFields &f, VertexSides &sides, FluidBlockVector &fields) const;

    /** load += R M g without what the jumps add. */
    void
    spread_plainly(const ShellFields &g, FluidBlockVector &load) const;

    /** load += R f. */
    void
    spread(const ShellFields &f, FluidBlockVector &load) const;

    /** load += factor R (f + pi v), f and pi being extended. */
    void
    spread(double factor, const ExtendedForces &f, FluidBlockVector &load) const;

    /**
     * load += R M g + sum_q w_q (S dx)_q . grad Phi(X_q) (S g0)_q, where knows_motion() only, the second term being the change of R M g0 when the shells move
     * by dx.
     */
    void
    spread_with_motion(const ShellFields &g, const ShellFields &dx, const ShellFields &g0, FluidBlockVector &load) const;

    /**
     * S^T W (grad u_inf - G + grad u) S for each of the own shells, 3 NP x 3 NP, u_inf at the points of `shells`, G its gradient at the middle of the shell
     * (gradient_at_middle()), u from inside the cells that the points lie in: M^{-1} times it is what J u and u_inf - G x change when the shell moves. In the pattern of
     * AssemblyPattern::block_matrix(). @param u null: leave it out. Collective.
     */
    std::vector<SparseMatrix>
    gradient_matrices(const ShellConfigurations &shells, const UndisturbedFlow &flow, const FluidBlockVector *u) const;

  private:
    /** M (J fields + Q f), the latter unless null. */
    ShellFields
    all_moments(const FluidBlockVector &fields, const ExtendedForces *f) const;

    /** S^T W values, summed over the ranks; with `fluxes` of the present shells, those of the own ones summed too. */
    ShellFields
    sum_moments(const std::vector<double> &values, std::vector<double> *fluxes = nullptr) const;

    /** Two numbers for each present capsule. */
    using NumbersOfCapsules = std::vector<std::array<double, 2>>;

    /** Point forces w S g of all present shells. @param numbers go to guests in the same messages, unless null. */
    void
    set_point_forces(const ShellFields &g, std::vector<double> &forces, NumbersOfCapsules *numbers = nullptr) const;

    /** Fields of all present capsules by those of the own ones; in `memory`, unless there are no others here. Collective. */
    const ShellFields &
    at_guests(const ShellFields &own, ShellFields &memory, NumbersOfCapsules *numbers = nullptr) const;
    /** Shells of all present capsules, of which guests are taken from `known` if they are there. Collective. */
    ShellConfigurations
    present_shells(const ShellConfigurations &own, const ShellGuests &guests, const ShellConfigurations &known) const;
    /** Has the shells compute what moving the points needs of them, and throws on all ranks if one is degenerate. Collective. */
    void
    evaluate(const ShellConfigurations &shells) const;

    const ShellLayout                  &layout_;
    const Interface                     interface_;
    ViscosityContrast                   contrast_;
    ShellGuests                         guests_;
    ShellConfigurations                 shells_;    // own ones
    std::vector<ShellTransfer>          transfers_; // of present ones
    const TaylorHoodSpace              *space_ = nullptr;
    std::unique_ptr<PointInterpolation> interpolation_;
    std::unique_ptr<ShellJumps>         jumps_;
    bool                                moved_ = false; // on this mesh

    // Memory of the calls, kept between them.
    std::vector<double>         normal_forces_; // of the density m of each shell, at the points of this rank
    mutable std::vector<double> values_, moments_, further_values_, sums_;
    mutable ShellFields         fields_, motions_, loads_;
  };

  /**
   * The rule with the fewest points, 3 or 6 times a power of four a face, whose points on the surface x are close enough for a fluid mesh with finest cells of
   * size h: half a cell from each other, 0.3 cells with the
   * enriched interface, for which the velocity has a kink there (doc/theory.md, section 4.4). A point's distance is taken as the root of the largest area of
   * one.
   */
  TriangleQuadrature
  coupling_quadrature(const TriangleMesh &topology, const ControlPoints &x, Interface interface, double h);

  /**
   * That rule, and `mechanics` points a face for the shell. @param viscosity_ratio another viscosity inside needs second derivatives as the enriched interface
   * does.
   */
  CapsuleQuadrature
  capsule_quadrature(const FittedShape &shape, unsigned int mechanics, Interface interface, double h, double viscosity_ratio = 1.);
} // namespace tanktread

#endif
