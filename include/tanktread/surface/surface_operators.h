// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: mass matrix and Laplace-Beltrami operator on the control points.

#ifndef tanktread_surface_surface_operators_h
#define tanktread_surface_surface_operators_h

#include <tanktread/surface/subdivision_surface.h>

namespace tanktread
{
  /** S^T diag(point_weights) S, NP x NP: the mass matrix for the area measure that the weights (length n_points) stand for. */
  SparseMatrix
  mass_matrix(const SubdivisionSurface &surface, const Eigen::VectorXd &point_weights);

  /**
   * Stiffness matrix of the Laplace-Beltrami operator on the surface with control points x, NP x NP: integral of grad_s N^I . grad_s N^J, that is
   * sum_q w_q sqrt(det a) a^{alpha beta} N^I_{,alpha} N^J_{,beta}. Throws NumericalError where the surface is degenerate.
   */
  SparseMatrix
  laplace_beltrami(const SubdivisionSurface &surface, const ControlPoints &x);
} // namespace tanktread

#endif
