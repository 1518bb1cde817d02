// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: distance to the surface from its second-order shape at nearby points.

#include <tanktread/surface/closest_point.h>
#include <tanktread/surface/stencil_products.h>

#include <cmath>

namespace tanktread
{
  std::vector<QuadraticPatch>
  quadratic_patches(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    const unsigned int          n = surface.support_size(), n_q = surface.n_points_per_face();
    std::vector<QuadraticPatch> result(surface.n_points());
    std::vector<Vector4>        local(n);
    double                      values[6][3];
    for (unsigned int face = 0; face < surface.n_faces(); ++face)
      {
        const int *const support = surface.support(face);
        for (unsigned int i = 0; i < n; ++i)
          local[i] = Vector4(x.data() + 3 * std::size_t(support[i]));
        for (unsigned int q = face * n_q; q < (face + 1) * n_q; ++q)
          {
            stencil_products({surface.stencils(q), n, 6, n}, local.data(), values[0]);
            const auto vector = [&](const unsigned int k) { return Eigen::Vector3d(values[k]); };
            result[q]         = {vector(0), vector(1), vector(2), vector(3), vector(4), vector(5)};
          }
      }
    return result;
  }


  double
  signed_distance(const QuadraticPatch &p, const Eigen::Vector3d &y)
  {
    // Stationary |X(d) - y|^2 / 2 in the two coordinates d.
    Eigen::Vector2d d(0., 0.);
    Eigen::Vector3d normal = p.a_1.cross(p.a_2), offset = y - p.X;
    const double    plane = offset.dot(normal) / normal.norm();
    for (unsigned int iteration = 0; iteration < 4; ++iteration)
      {
        const Eigen::Vector3d t_1 = p.a_1 + d[0] * p.a_11 + d[1] * p.a_12, t_2 = p.a_2 + d[0] * p.a_12 + d[1] * p.a_22;
        offset = y - (p.X + 0.5 * (d[0] * (p.a_1 + t_1) + d[1] * (p.a_2 + t_2)));
        normal = t_1.cross(t_2);
        Eigen::Matrix2d hessian;
        hessian(0, 0) = t_1.dot(t_1) - offset.dot(p.a_11);
        hessian(1, 1) = t_2.dot(t_2) - offset.dot(p.a_22);
        hessian(0, 1) = hessian(1, 0) = t_1.dot(t_2) - offset.dot(p.a_12);
        const double determinant      = hessian.determinant();
        if (!(determinant > 0.05 * normal.squaredNorm()) || !(hessian(0, 0) > 0.))
          return plane;
        const Eigen::Vector2d gradient(offset.dot(t_1), offset.dot(t_2));
        const Eigen::Vector2d step((hessian(1, 1) * gradient[0] - hessian(0, 1) * gradient[1]) / determinant,
                                   (hessian(0, 0) * gradient[1] - hessian(0, 1) * gradient[0]) / determinant);
        d += step;
        if (step.squaredNorm() < 1e-20)
          break;
      }
    return offset.dot(normal) / normal.norm();
  }
} // namespace tanktread
