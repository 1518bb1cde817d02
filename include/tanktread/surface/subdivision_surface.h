// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Loop subdivision limit surface as fixed linear maps from control points to quadrature points.

#ifndef tanktread_surface_subdivision_surface_h
#define tanktread_surface_subdivision_surface_h

#include <tanktread/surface/assembly_pattern.h>
#include <tanktread/surface/limit_map.h>
#include <tanktread/surface/triangle_mesh.h>
#include <tanktread/surface/triangle_quadrature.h>
#include <tanktread/surface/types.h>

#include <vector>

namespace tanktread
{
  /** How many derivatives a SubdivisionSurface keeps. */
  enum class Derivatives
  {
    none,
    first,
    second
  };

  /**
   * Limit surface X(xi) = sum_I N^I(xi) x_I of Loop's subdivision of a closed triangle mesh, evaluated at the same quadrature points in every face.
   *
   * On face (v0, v1, v2) the coordinates (xi_1, xi_2) are (0,0) at v0, (1,0) at v1 and (0,1) at v2; all derivatives are with respect to them, also next to
   * extraordinary vertices (valence other than 6). There the surface consists of infinitely many quartic rings; the topology is refined until every
   * quadrature point lies in one of them, so that all values are those of the limit surface, not of an approximation to it.
   *
   * The rows are held as dense stencils over the control points of a face (its `support`), which all points of the face share.
   */
  class SubdivisionSurface
  {
  public:
    /**
     * Only the connectivity of `topology` matters, not the positions of its vertices; vertex I carries control point I. Throws InputError when the
     * connectivity is not that of a closed manifold.
     */
    SubdivisionSurface(const TriangleMesh &topology, const TriangleQuadrature &quadrature, Derivatives derivatives);

    /** NP, the number of control points. */
    unsigned int
    n_control_points() const
    {
      return n_control_points_;
    }

    /** Number of faces. */
    unsigned int
    n_faces() const
    {
      return n_faces_;
    }

    /** Number of quadrature points on the whole surface; those of face f are f * n_points_per_face(), ..., (f + 1) * n_points_per_face() - 1. */
    unsigned int
    n_points() const
    {
      return n_faces_ * n_points_per_face_;
    }

    /** Number of quadrature points in a face. */
    unsigned int
    n_points_per_face() const
    {
      return n_points_per_face_;
    }

    /** Which derivatives are available. */
    Derivatives
    derivatives() const
    {
      return derivatives_;
    }

    /** Weight of each quadrature point in parameter space (length n_points, sum n_faces / 2): times sqrt(det a_alphabeta) it is an area. */
    const Eigen::VectorXd &
    weights() const
    {
      return weights_;
    }

    /** Values, X = S x; n_points x NP. As those below it refers to this object. */
    LimitMap
    S() const
    {
      return map(0);
    }

    /** First derivatives a_1 = S_1 x, a_2 = S_2 x. Throws std::logic_error if the surface was built without them. */
    LimitMap
    S_1() const
    {
      return map(1);
    }
    LimitMap
    S_2() const
    {
      return map(2);
    }

    /** Second derivatives a_{1,1} = S_11 x, a_{1,2} = S_12 x, a_{2,2} = S_22 x. Throws std::logic_error if the surface was built without them. */
    LimitMap
    S_11() const
    {
      return map(3);
    }
    LimitMap
    S_12() const
    {
      return map(4);
    }
    LimitMap
    S_22() const
    {
      return map(5);
    }

    /**
     * Length of every dense stencil: the largest number of control points that a face depends on (12 where all valences are at most 6), rounded up to a
     * multiple of 4. Faces that depend on fewer repeat their first control point with weight zero.
     */
    unsigned int
    support_size() const
    {
      return support_size_;
    }

    /** The support_size() control points of a face. */
    const int *
    support(const unsigned int face) const
    {
      return supports_.data() + std::size_t(face) * support_size_;
    }

    /** Number of stencils a point has: 1, 3 or 6 (S, S_1, S_2, S_11, S_12, S_22, in this order). */
    unsigned int
    n_stencils() const
    {
      return derivatives_ == Derivatives::none ? 1 : (derivatives_ == Derivatives::first ? 3 : 6);
    }

    /** Stencils of quadrature point q, n_stencils() x support_size(), stored by rows. */
    const double *
    stencils(const unsigned int point) const
    {
      return stencils_.data() + std::size_t(point) * n_stencils() * support_size_;
    }

    /** Where face by face assembly puts its entries. */
    const AssemblyPattern &
    pattern() const
    {
      return pattern_;
    }

  private:
    LimitMap
    map(unsigned int kind) const;

    unsigned int        n_control_points_, n_faces_, n_points_per_face_;
    Derivatives         derivatives_;
    Eigen::VectorXd     weights_;
    unsigned int        support_size_;
    std::vector<int>    supports_;
    std::vector<double> stencils_;
    AssemblyPattern     pattern_;
  };

  /**
   * Limit position of each vertex of a closed triangle mesh under Loop's subdivision, NP x NP: row I holds 1 - n chi at I and chi at its n neighbours, with
   * 1/chi = n + 3/(8 beta_n) and beta_n = loop_weight(n).
   */
  SparseMatrix
  vertex_limit_stencils(const TriangleMesh &topology);
} // namespace tanktread

#endif
