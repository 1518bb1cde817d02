// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the mean of the velocity gradients on both sides of a shell between two viscosities.

#include <tanktread/coupling/mean_gradient.h>
#include <tanktread/fluid/quadratic_element.h>

#include <Eigen/LU>

namespace tanktread
{
  namespace
  {
    double
    divergence_of_normal(const QuadraticPatch &patch, const Eigen::Vector3d &n)
    {
      Eigen::Matrix2d metric, curvature;
      metric << patch.a_1.dot(patch.a_1), patch.a_1.dot(patch.a_2), patch.a_1.dot(patch.a_2), patch.a_2.dot(patch.a_2);
      curvature << patch.a_11.dot(n), patch.a_12.dot(n), patch.a_12.dot(n), patch.a_22.dot(n);
      return -(metric.inverse() * curvature).trace();
    }


    /** Gradient of the trilinear function with these values at the vertices of a cell of size one. */
    Eigen::Vector3d
    trilinear_slope(const VertexForces &F, const unsigned int component, const dealii::Point<3> &unit)
    {
      Eigen::Vector3d result = Eigen::Vector3d::Zero();
      for (unsigned int v = 0; v < 8; ++v)
        {
          const bool upper[3] = {v % 2 == 1, v / 2 % 2 == 1, v / 4 == 1};
          double     value[3];
          for (unsigned int d = 0; d < 3; ++d)
            value[d] = upper[d] ? unit[d] : 1. - unit[d];
          for (unsigned int d = 0; d < 3; ++d)
            result[d] += (upper[d] ? 1. : -1.) * value[(d + 1) % 3] * value[(d + 2) % 3] * F[v][component];
        }
      return result;
    }


    /** Mean on both sides of the Laplacians of psi_v. */
    std::array<double, 8>
    mean_laplacians(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit, const double h)
    {
      const std::array<double, 3> x = quadratic_values(unit[0]), y = quadratic_values(unit[1]), z = quadratic_values(unit[2]);
      std::array<double, 8>       result{};
      for (unsigned int a = 0; a < 27; ++a)
        {
          const unsigned int i = a % 3, j = a / 3 % 3, k = a / 9;
          const double       laplacian =
            (quadratic_curvatures[i] * y[j] * z[k] + x[i] * quadratic_curvatures[j] * z[k] + x[i] * y[j] * quadratic_curvatures[k]) / (h * h);
          for (unsigned int v = 0; v < 8; ++v)
            result[v] += (nodes.inside[a] ? -0.5 : 0.5) * q[a][v] * laplacian;
        }
      return result;
    }


    /** Amplitudes of the function whose second derivative along the normal jumps by one, outside minus inside. */
    NodeAmplitudes
    amplitudes_of_second_jump(const NodeDistances &nodes)
    {
      NodeAmplitudes result{};
      for (unsigned int a = 0; a < 27; ++a)
        result[a][0] = -0.5 * nodes.phi[a] * nodes.phi[a];
      return result;
    }


    Eigen::Vector3d
    eigen(const Vector4 &v)
    {
      return {v[0], v[1], v[2]};
    }
  } // namespace


  MeanGradient::MeanGradient(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit, const double h, const QuadraticPatch &patch)
    : n_(patch.a_1.cross(patch.a_2).normalized())
    , divergence_of_n_(divergence_of_normal(patch, n_))
    , unit_(unit)
    , h_(h)
    , slopes_(mean_slopes(nodes, q, unit, h))
    , laplacians_(mean_laplacians(nodes, q, unit, h))
    , second_slope_(eigen(mean_slopes(nodes, amplitudes_of_second_jump(nodes), unit, h)[0]))
  {}


  Eigen::Matrix3d
  MeanGradient::without_second_jump(const Eigen::Matrix3d &of_u_h, const VertexForces &F) const
  {
    Eigen::Matrix3d G = of_u_h;
    for (unsigned int v = 0; v < 8; ++v)
      G += eigen(F[v]) * eigen(slopes_[v]).transpose();
    return G - G.trace() * n_ * n_.transpose();
  }


  Eigen::Matrix3d
  MeanGradient::operator()(const Eigen::Matrix3d &of_u_h, const Eigen::Vector3d &laplacian, const VertexForces &F, const double viscosity_ratio) const
  {
    const std::array<double, 8> hats = hat_functions(unit_);
    Eigen::Vector3d             sum  = 1. / h_ * trilinear_slope(F, 3, unit_) - (1. - viscosity_ratio) * laplacian;
    for (unsigned int v = 0; v < 8; ++v)
      sum += (hats[v] * divergence_of_n_ - (1. - viscosity_ratio) * laplacians_[v]) * eigen(F[v]);
    const Eigen::Vector3d K = 2. / (1. + viscosity_ratio) * (sum - sum.dot(n_) * n_);
    return without_second_jump(of_u_h, F) + K * second_slope_.transpose();
  }
} // namespace tanktread
