// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the mean of the velocity gradients on both sides of a shell between two viscosities.

#ifndef tanktread_coupling_mean_gradient_h
#define tanktread_coupling_mean_gradient_h

#include <tanktread/coupling/cut_cell_forms.h>
#include <tanktread/surface/closest_point.h>

#include <Eigen/Core>

#include <array>

namespace tanktread
{
  /**
   * At a point of a shell in a cell that it cuts, the mean G of grad U on both sides, from u_h and the kink psi of forces F at the cell's vertices
   * (doc/theory.md, section 4.6). grad (u_h + psi) alone is wrong by a part of h [d^2U/dn^2], which neither function has. So
   *
   *     n . G n = -(I - n n^T) : G                                                             from div U = 0, and
   *     K_t = 2/(1 + lambda) (grad_t F_n + (div n) F_t - (1 - lambda) mean of (lap U)_t),        the jump of d^2U_t/dn^2 by the balance of forces,
   *
   * adds the mean slope of the function with that jump less its own nodal interpolant.
   */
  class MeanGradient
  {
  public:
    /** Of no cell: to be assigned to. */
    MeanGradient() = default;

    /** @param unit place in the cell. @param h its size. @param q as for psi. @param patch of the shell at the point. */
    MeanGradient(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit, double h, const QuadraticPatch &patch);

    /** G, linear in both. @param of_u_h gradient of u_inf + u_h, entry (c, d) being du_c/dx_d. @param F at the vertices, f_t + g_t and f_n + g_n. */
    Eigen::Matrix3d
    without_second_jump(const Eigen::Matrix3d &of_u_h, const VertexForces &F) const;

    /** The same with what K_t adds. @param laplacian of u_inf + u_h. */
    Eigen::Matrix3d
    operator()(const Eigen::Matrix3d &of_u_h, const Eigen::Vector3d &laplacian, const VertexForces &F, double viscosity_ratio) const;

  private:
    Eigen::Vector3d        n_;
    double                 divergence_of_n_;
    dealii::Point<3>       unit_;
    double                 h_;
    std::array<Vector4, 8> slopes_;       // mean of grad psi_v
    std::array<double, 8>  laplacians_;   // mean of lap psi_v
    Eigen::Vector3d        second_slope_; // mean of the gradient of the function with [d^2/dn^2] = 1
  };
} // namespace tanktread

#endif
