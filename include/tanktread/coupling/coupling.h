// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shell and spreading of the shell's forces to the fluid, each the other's adjoint.

#ifndef tanktread_coupling_coupling_h
#define tanktread_coupling_coupling_h

#include <tanktread/base/vector4.h>
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
   * so the power f . J u = (R f) . u agrees to rounding. Nodal fields are NP x 3 and replicated on all ranks; what belongs to a point is on the rank of its fluid cell
   * alone, so sums over points end in one sum over the ranks. Calls that take fluid vectors or velocity gradients are collective.
   */
  class Coupling
  {
  public:
    /**
     * @param surface quadrature of the coupling, spaced at about half a fluid cell or less; kept by reference.
     * @param reference_weights w_q sqrt(det abar_q), length n_points.
     */
    Coupling(const SubdivisionSurface &surface, Eigen::VectorXd reference_weights);

    /** To be called for every new fluid mesh, before move(). Keeps `space` by reference. */
    void
    attach(const TaylorHoodSpace &space);

    /** Moves the quadrature points to S x. Collective. Throws NumericalError when one leaves the box. */
    void
    move(const ControlPoints &x);

    /** Number of quadrature points on this rank since move(). */
    unsigned int
    n_local_points() const
    {
      return interpolation_->local_points().size();
    }

    /** S x as points of the fluid. */
    std::vector<dealii::Point<3>>
    points(const ControlPoints &x) const;

    /** S^T W Phi u: what M has to be inverted on to give J u. */
    ControlPoints
    velocity_moments(const FluidBlockVector &u) const;

    /** J u. */
    ControlPoints
    interpolate(const FluidBlockVector &u) const;

    /** grad u at the points of this rank, from inside the cells that they lie in. */
    VelocityGradients
    velocity_gradients(const FluidBlockVector &u) const;

    /** M^{-1} f: control points of the force density per reference area. */
    ControlPoints
    density(const ControlPoints &f) const;

    /** load += R f. */
    void
    spread(const ControlPoints &f, FluidBlockVector &load) const;

    /**
     * load += R f + sum_q w_q (S dx)_q . grad Phi(X_q) (S g)_q, the second term being the change of R f0 when the shell moves by dx.
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
    Eigen::VectorXd                     weights_;
    SparseMatrix                        mass_;
    MassInverse                         mass_inverse_;
    MPI_Comm                            communicator_ = MPI_COMM_NULL;
    std::unique_ptr<PointInterpolation> interpolation_;
    std::vector<FacePoints>             local_faces_;

    // Memory of the calls, kept between them.
    std::vector<dealii::Point<3>> points_;
    mutable ControlPoints         density_;
    mutable std::vector<double>   values_, moments_;
    mutable std::vector<Vector4>  face_;
  };

  /**
   * Points per face (as subdivisions of a triangle rule with `points_per_face` points) that bring the points of the surface x closer than half a cell of size h:
   * the smallest n for which the largest area of a point, estimated as 4^-n of that of the undivided rule, is below (h/2)^2.
   */
  unsigned int
  coupling_subdivisions(const TriangleMesh &topology, const ControlPoints &x, unsigned int points_per_face, double h);
} // namespace tanktread

#endif
