// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shell and spreading of the shell's forces to the fluid, each the other's adjoint.

#ifndef tanktread_coupling_coupling_h
#define tanktread_coupling_coupling_h

#include <tanktread/base/vector4.h>
#include <tanktread/coupling/interface.h>
#include <tanktread/coupling/jump_enrichment.h>
#include <tanktread/coupling/shell_viscosity.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/surface/mass_inverse.h>
#include <tanktread/surface/subdivision_surface.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** Velocity gradients at the coupling's points on this rank, n_local_points x 9: entry 3 c + d is du_c/dx_d. */
  using VelocityGradients = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

  /**
   * With X_q = S x the quadrature points, Phi the fluid's shape functions there, W the weights in reference area and M = S^T W S:
   *
   *     interpolation  J(x) u = M^{-1} S^T W Phi u        (velocity of the control points)
   *     spreading      R(x) f = Phi^T W S M^{-1} f = J^T f (load vector of nodal forces f)
   *
   * so the power f . J u = (R f) . u agrees to rounding.
   *
   * With Interface::enriched R f has a part in the continuity equation too, J acts on the pressure, and the shell's own force moves it by Q f in addition, Q symmetric. The
   * enrichment is for P f = f - v (m . f)/(m . v) only, v the volume gradient and m = M^{-1} v: a constant normal force is the business of the indicator pressure.
   *
   * Nodal fields are NP x 3 and replicated on all ranks; what belongs to a point is on the rank of its fluid cell
   * alone, so sums over points end in one sum over the ranks. Calls that take fluid vectors or velocity gradients are collective.
   */
  class Coupling
  {
  public:
    /**
     * @param surface quadrature of the coupling, spaced at about half a fluid cell or less; kept by reference. With second derivatives if the interface is enriched.
     * @param reference_weights w_q sqrt(det abar_q), length n_points.
     */
    Coupling(const SubdivisionSurface &surface, Eigen::VectorXd reference_weights, Interface interface = Interface::plain);

    /** To be called before attach(), for another viscosity inside. */
    void
    set_viscosity_contrast(const ViscosityContrast &contrast)
    {
      contrast_ = contrast;
    }

    /** To be called for every new fluid mesh, before move(). Keeps `space` by reference. */
    void
    attach(const TaylorHoodSpace &space);

    /** Moves the quadrature points to S x. @param volume_gradient v at x, used by the enriched interface. Collective. Throws NumericalError when a point leaves the box. */
    void
    move(const ControlPoints &x, const ControlPoints &volume_gradient = {});

    /** Largest distance of a control point from where it was when the points were moved last; infinite before that. */
    double
    distance(const ControlPoints &x) const;

    /** Number of quadrature points on this rank since move(). */
    unsigned int
    n_local_points() const
    {
      return interpolation_->local_points().size();
    }

    /** Viscosity of the fluid's cells with the shell at x. The surface needs second derivatives. Collective. */
    Viscosity
    viscosity(const ControlPoints &x) const;

    /** S x as points of the fluid. */
    std::vector<dealii::Point<3>>
    points(const ControlPoints &x) const;

    /** P f as the enrichment needs it, for several of the calls below; nothing with the plain interface. Collective. */
    void
    extend(const ControlPoints &f, ExtendedForces &forces) const;

    /** Extended forces of the shell in the whole flow: with what another viscosity inside and the undisturbed flow contribute, which is not linear in f. See JumpEnrichment. Collective. */
    void
    extend_whole(const ControlPoints &f, ExtendedForces &forces) const;

    /** Makes that contribution the one of the flow `fields` with nodal forces f. Nothing with one viscosity or the plain interface. Collective. */
    void
    update_viscous_forces(const FluidBlockVector &fields, const ControlPoints &f);

    /** What psi adds to 2 ((mu - 1) eps(u_inf), eps(u_h)). Collective. */
    double
    undisturbed_work(const ControlPoints &f) const;

    /** M J fields: S^T W Phi u, and what the enrichment adds. */
    ControlPoints
    velocity_moments(const FluidBlockVector &fields) const;

    /** M (J fields + Q f), f being extended. */
    ControlPoints
    velocity_moments(const FluidBlockVector &fields, const ExtendedForces &f) const;

    /** J fields. */
    ControlPoints
    interpolate(const FluidBlockVector &fields) const;

    /** J fields + Q f: the shell's part of the velocity that nodal forces f make. */
    ControlPoints
    interpolate(const FluidBlockVector &fields, const ControlPoints &f) const;
    ControlPoints
    interpolate(const FluidBlockVector &fields, const ExtendedForces &f) const;

    /** grad u at the points of this rank, from inside the cells that they lie in. */
    VelocityGradients
    velocity_gradients(const FluidBlockVector &u) const;

    /** M^{-1} f: control points of the force density per reference area. */
    ControlPoints
    density(const ControlPoints &f) const;

    /**
     * Adds to the pressure of `fields` what it jumps where the shell with nodal forces f has passed a vertex of the mesh since `sides`, which becomes the sides at move(). Nothing if `sides` is empty, before
     * the first move() on a mesh, and with the plain interface. Collective.
     */
    void
    carry_pressure(const ControlPoints &f, VertexSides &sides, FluidBlockVector &fields) const;

    Interface
    interface() const
    {
      return interface_;
    }

    /** load += R f without what the enrichment adds. */
    void
    spread_plainly(const ControlPoints &f, FluidBlockVector &load) const;

    /** load += R f. */
    void
    spread(const ControlPoints &f, FluidBlockVector &load) const;

    /** load += factor R f, where f and `forces` may differ by a multiple of v. */
    void
    spread(double factor, const ControlPoints &f, const ExtendedForces &forces, FluidBlockVector &load) const;

    /**
     * load += R f + sum_q w_q (S dx)_q . grad Phi(X_q) (S g)_q, plain interface only, the second term being the change of R f0 when the shell moves by dx.
     *
     * @param g = density(f0).
     */
    void
    spread_with_motion(const ControlPoints &f, const ControlPoints &dx, const ControlPoints &g, FluidBlockVector &load) const;

    /**
     * S^T W grad u S, 3 NP x 3 NP: M^{-1} times it is the change of J u when the shell moves.
     *
     * @param result takes the pattern surface().pattern().block_matrix(), without allocation if it has as many entries already, which must then be these.
     */
    void
    gradient_matrix(const VelocityGradients &gradients, SparseMatrix &result) const;

    /** M, NP x NP. */
    const SparseMatrix &
    mass() const
    {
      return mass_;
    }
    const SubdivisionSurface &
    surface() const
    {
      return surface_;
    }

  private:
    /** M (J fields + Q f), the latter unless null. */
    ControlPoints
    all_moments(const FluidBlockVector &fields, const ExtendedForces *f) const;

    /** S^T W values, summed over the ranks. */
    ControlPoints
    sum_moments(const std::vector<double> &values) const;

    /** Forces at the local points of a density given by its control points. */
    void
    set_point_forces(const ControlPoints &density, std::vector<double> &forces) const;

    /** Consecutive local points [begin, end) in one face. */
    struct FacePoints
    {
      unsigned int face, begin, end;
    };

    void
    set_points(const ControlPoints &x, std::vector<dealii::Point<3>> &points) const;

    /** Adds S^T W grad u S of one face's points. */
    void
    add_gradients(const FacePoints &points, const VelocityGradients &gradients, double *matrix_values) const;

    const SubdivisionSurface           &surface_;
    Interface                           interface_;
    ViscosityContrast                   contrast_;
    Eigen::VectorXd                     weights_;
    SparseMatrix                        mass_;
    MassInverse                         mass_inverse_;
    MPI_Comm                            communicator_ = MPI_COMM_NULL;
    const TaylorHoodSpace              *space_        = nullptr;
    std::unique_ptr<PointInterpolation> interpolation_;
    std::unique_ptr<JumpEnrichment>     enrichment_; // only with Interface::enriched
    std::vector<FacePoints>             local_faces_;
    ControlPoints                       x_, volume_gradient_, normal_field_; // where the shell was moved to, v and m = M^{-1} v there

    // Memory of the calls, kept between them.
    std::vector<dealii::Point<3>> points_;
    mutable ControlPoints         density_;
    std::vector<double>           normal_forces_; // of the density m, at the local points
    mutable std::vector<double>   values_, moments_, enriched_values_;
    mutable std::vector<Vector4>  face_;
  };

  /**
   * The rule with the fewest points, 3 or 6 times a power of four a face, whose points on the surface x are close enough for a fluid mesh with finest cells of size h: half a cell from each other, 0.3 cells with the
   * enriched interface, for which the velocity has a kink there (doc/theory.md, section 4.4). A point's distance is taken as the root of the largest area of one.
   */
  TriangleQuadrature
  coupling_quadrature(const TriangleMesh &topology, const ControlPoints &x, Interface interface, double h);
} // namespace tanktread

#endif
