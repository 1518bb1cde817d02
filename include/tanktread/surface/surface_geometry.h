// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: volume, area, normals, curvatures and the inertia ellipsoid of a closed subdivision surface.

#ifndef tanktread_surface_surface_geometry_h
#define tanktread_surface_surface_geometry_h

#include <tanktread/surface/subdivision_surface.h>

namespace tanktread
{
  // In all functions x holds the control points, NP x 3. They throw NumericalError where the surface is degenerate (a_1 x a_2 = 0 or not finite), and
  // std::logic_error when the surface was built without the derivatives they need.

  /**
   * Enclosed volume by the divergence theorem, V = 1/3 sum_q w_q (X - xbar) . (a_1 x a_2), with xbar the mean of the control points: sum_q w_q a_1 x a_2, which
   * vanishes but for the quadrature's error, would make V depend on the origin. V is homogeneous of degree 3, V(L x + b) = det(L) V(x) for linear L.
   */
  double
  enclosed_volume(const SubdivisionSurface &surface, const ControlPoints &x);

  /** Surface area, sum_q w_q |a_1 x a_2|. */
  double
  surface_area(const SubdivisionSurface &surface, const ControlPoints &x);

  /** dV/dx_I of the discrete volume above, that of xbar included, NP x 3. The rows sum to zero: a pressure exerts no net force. */
  ControlPoints
  volume_gradient(const SubdivisionSurface &surface, const ControlPoints &x);

  /**
   * Second derivatives of the discrete volume with xbar held fixed, 3 NP x 3 NP, symmetric; the pattern is that of AssemblyPattern::block_matrix(). xbar would
   * add -(1 (x) G + G^T (x) 1)/(3 NP) with G the derivative of sum_q w_q a_1 x a_2, which has no sparse pattern and is of the size of the quadrature's error:
   * for
   * displacements that keep xbar it is the same small force on all points.
   */
  SparseMatrix
  volume_hessian(const SubdivisionSurface &surface, const ControlPoints &x);

  /** Outward unit normals a_3 = a_1 x a_2 / |a_1 x a_2| at the quadrature points, n_points x 3. */
  ControlPoints
  normals(const SubdivisionSurface &surface, const ControlPoints &x);

  /** Current area that each quadrature point stands for, w_q |a_1 x a_2|. */
  Eigen::VectorXd
  area_weights(const SubdivisionSurface &surface, const ControlPoints &x);

  /**
   * Mean curvature 1/2 a^{alpha beta} kappa_{alpha beta} with kappa_{alpha beta} = a_{alpha,beta} . a_3: -1/R on a sphere of radius R. Needs second
   * derivatives.
   */
  Eigen::VectorXd
  mean_curvature(const SubdivisionSurface &surface, const ControlPoints &x);

  /** Gaussian curvature det kappa / det a: 1/R^2 on a sphere of radius R. Needs second derivatives. */
  Eigen::VectorXd
  gaussian_curvature(const SubdivisionSurface &surface, const ControlPoints &x);

  /** The larger |kappa| of the two principal curvatures: 1/R on a sphere of radius R. Needs second derivatives. */
  Eigen::VectorXd
  largest_curvature(const SubdivisionSurface &surface, const ControlPoints &x);

  /** What inertia_ellipsoid() returns. */
  struct InertiaEllipsoid
  {
    /** Semi-axes: L >= B in the x-z plane, W along y. */
    double L, B, W;
    /** D_xz = (L - B)/(L + B). */
    double taylor_parameter;
    /** Angle in radians, in (-pi/2, pi/2], from the x axis to L, positive towards +z. */
    double inclination;
    /** Centroid of the enclosed volume. */
    Eigen::Vector3d centroid;
  };

  /**
   * The ellipsoid that has the same volume integral of r r^T (hence the same inertia tensor) and mass as the enclosed volume: semi-axis sqrt(5 M_i / V) for the
   * second moment M_i about the centroid, all by surface integrals with r from there. L and B come from the x-z block of the tensor, W from its yy entry, so y
   * is taken as a principal axis, as it is in a shear flow u = (z, 0, 0).
   */
  InertiaEllipsoid
  inertia_ellipsoid(const SubdivisionSurface &surface, const ControlPoints &x);
} // namespace tanktread

#endif
