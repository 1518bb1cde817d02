// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: volume, area, normals, curvatures and the inertia ellipsoid of a closed subdivision surface.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/surface_geometry.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace tanktread
{
  namespace
  {
    using Vector = Eigen::Vector3d;

    /** a_1 x a_2 at every point; a degenerate one throws. */
    ControlPoints
    area_vectors(const ControlPoints &a_1, const ControlPoints &a_2, const unsigned int n_points_per_face)
    {
      ControlPoints m(a_1.rows(), 3);
      for (Eigen::Index q = 0; q < m.rows(); ++q)
        {
          m.row(q)         = a_1.row(q).cross(a_2.row(q));
          const double det = m.row(q).squaredNorm();
          if (!(det > 0) || !std::isfinite(det))
            throw NumericalError("The surface is degenerate in face " + std::to_string(q / n_points_per_face) + ".");
        }
      return m;
    }

    ControlPoints
    area_vectors(const SubdivisionSurface &surface, const ControlPoints &x)
    {
      return area_vectors(surface.S_1() * x, surface.S_2() * x, surface.n_points_per_face());
    }

    /**
     * The surface seen from the mean of its control points: X - xbar, a_1 and a_2 at every point. Without cancellation, however far from the origin it lies.
     */
    struct CentredSurface
    {
      CentredSurface(const SubdivisionSurface &surface, const ControlPoints &x)
        : mean(x.colwise().mean())
      {
        const ControlPoints y = x.rowwise() - mean;
        X                     = surface.S() * y;
        a_1                   = surface.S_1() * y;
        a_2                   = surface.S_2() * y;
      }

      Eigen::RowVector3d mean;
      ControlPoints      X, a_1, a_2;
    };

    /** Coefficients of the first and second fundamental form at a point. */
    struct FundamentalForms
    {
      double a11, a12, a22, kappa11, kappa12, kappa22;
    };

    /** Applies `curvature` to the fundamental forms of every point. */
    template <typename Curvature>
    Eigen::VectorXd
    map_fundamental_forms(const SubdivisionSurface &surface, const ControlPoints &x, const Curvature &curvature)
    {
      const ControlPoints n   = normals(surface, x);
      const ControlPoints a_1 = surface.S_1() * x, a_2 = surface.S_2() * x;
      const ControlPoints a_11 = surface.S_11() * x, a_12 = surface.S_12() * x, a_22 = surface.S_22() * x;
      Eigen::VectorXd     result(n.rows());
      for (Eigen::Index q = 0; q < n.rows(); ++q)
        result[q] = curvature(FundamentalForms{a_1.row(q).squaredNorm(),
                                               a_1.row(q).dot(a_2.row(q)),
                                               a_2.row(q).squaredNorm(),
                                               a_11.row(q).dot(n.row(q)),
                                               a_12.row(q).dot(n.row(q)),
                                               a_22.row(q).dot(n.row(q))});
      return result;
    }
  } // namespace


  double
  enclosed_volume(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    const CentredSurface centred(surface, x);
    double               volume = 0;
    for (Eigen::Index q = 0; q < centred.X.rows(); ++q)
      volume += surface.weights()[q] * centred.X.row(q).dot(centred.a_1.row(q).cross(centred.a_2.row(q)));
    return volume / 3.;
  }


  double
  surface_area(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return area_weights(surface, x).sum();
  }


  ControlPoints
  volume_gradient(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    // (X - xbar) . (a_1 x a_2) is linear in each factor, and invariant under cyclic exchange.
    CentredSurface     centred(surface, x);
    Eigen::RowVector3d closure = Eigen::RowVector3d::Zero();
    for (Eigen::Index q = 0; q < centred.X.rows(); ++q)
      {
        const double w     = surface.weights()[q] / 3.;
        const Vector value = centred.X.row(q), first = centred.a_1.row(q), second = centred.a_2.row(q);
        centred.X.row(q)   = w * first.cross(second);
        centred.a_1.row(q) = w * second.cross(value);
        centred.a_2.row(q) = w * value.cross(first);
        closure += centred.X.row(q);
      }
    ControlPoints gradient = surface.S().transposed_times(centred.X);
    gradient += surface.S_1().transposed_times(centred.a_1);
    gradient += surface.S_2().transposed_times(centred.a_2);
    gradient.rowwise() -= closure / double(x.rows()); // each point moves xbar
    return gradient;
  }


  SparseMatrix
  volume_hessian(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    // The entry of (I, c) and (J, d) is v_IJ . (e_c x e_d) with
    // v_IJ = 1/3 sum_q w (N^I N^J,1 - N^I,1 N^J) a_2 + (N^I,1 N^J,2 - N^I,2 N^J,1) (X - xbar) + (N^I,2 N^J - N^I N^J,2) a_1.
    const CentredSurface   centred(surface, x);
    const AssemblyPattern &pattern = surface.pattern();
    SparseMatrix           hessian = pattern.block_matrix();
    double                *values  = hessian.valuePtr();
    const unsigned int     n = surface.support_size(), n_points = surface.n_points_per_face();
    const auto             add = [&](const unsigned int f, const unsigned int i, const unsigned int j, const Vector &v) {
      const int row    = surface.support(f)[i];
      const int length = 3 * pattern.row_length(row);
      double   *entry  = values + 9 * pattern.row_start(row) + 3 * pattern.places(f)[i * n + j];
      entry[1] += v[2];
      entry[2] -= v[1];
      entry[length] -= v[2];
      entry[length + 2] += v[0];
      entry[2 * length] += v[1];
      entry[2 * length + 1] -= v[0];
    };
    for (unsigned int f = 0; f < surface.n_faces(); ++f)
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < i; ++j)
          {
            Vector v = Vector::Zero();
            for (unsigned int q = f * n_points; q < (f + 1) * n_points; ++q)
              {
                const double *S = surface.stencils(q), *S_1 = S + n, *S_2 = S_1 + n;
                v += (surface.weights()[q] / 3.) *
                  ((S[i] * S_1[j] - S_1[i] * S[j]) * centred.a_2.row(q) + (S_1[i] * S_2[j] - S_2[i] * S_1[j]) * centred.X.row(q) +
                   (S_2[i] * S[j] - S[i] * S_2[j]) * centred.a_1.row(q));
              }
            add(f, i, j, v);
            add(f, j, i, -v);
          }
    return hessian;
  }


  ControlPoints
  normals(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return area_vectors(surface, x).rowwise().normalized();
  }


  Eigen::VectorXd
  area_weights(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return surface.weights().cwiseProduct(area_vectors(surface, x).rowwise().norm());
  }


  Eigen::VectorXd
  mean_curvature(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return map_fundamental_forms(surface, x, [](const FundamentalForms &f) {
      return 0.5 * (f.a22 * f.kappa11 - 2. * f.a12 * f.kappa12 + f.a11 * f.kappa22) / (f.a11 * f.a22 - f.a12 * f.a12);
    });
  }


  Eigen::VectorXd
  gaussian_curvature(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return map_fundamental_forms(surface, x, [](const FundamentalForms &f) {
      return (f.kappa11 * f.kappa22 - f.kappa12 * f.kappa12) / (f.a11 * f.a22 - f.a12 * f.a12);
    });
  }


  Eigen::VectorXd
  largest_curvature(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return map_fundamental_forms(surface, x, [](const FundamentalForms &f) {
      const double det   = f.a11 * f.a22 - f.a12 * f.a12;
      const double mean  = 0.5 * (f.a22 * f.kappa11 - 2. * f.a12 * f.kappa12 + f.a11 * f.kappa22) / det;
      const double gauss = (f.kappa11 * f.kappa22 - f.kappa12 * f.kappa12) / det;
      return std::abs(mean) + std::sqrt(std::max(0., mean * mean - gauss)); // rounding makes the root's argument negative where both are the same
    });
  }


  InertiaEllipsoid
  inertia_ellipsoid(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    // div r = 3, div(r_i r) = 4 r_i, div(r_i r_j r) = 5 r_i r_j: r from the mean of the control points, then from the centroid.
    const CentredSurface centred(surface, x);
    const ControlPoints  m      = area_vectors(centred.a_1, centred.a_2, surface.n_points_per_face());
    double               volume = 0;
    Vector               first  = Vector::Zero();
    for (Eigen::Index q = 0; q < m.rows(); ++q)
      {
        const Vector r    = centred.X.row(q);
        const double flux = surface.weights()[q] * r.dot(m.row(q));
        volume += flux / 3.;
        first += flux / 4. * r;
      }
    const Vector    from_mean = first / volume;
    Eigen::Matrix3d second    = Eigen::Matrix3d::Zero();
    for (Eigen::Index q = 0; q < m.rows(); ++q)
      {
        const Vector r = Vector(centred.X.row(q)) - from_mean;
        second += surface.weights()[q] * r.dot(m.row(q)) / 5. * r * r.transpose();
      }
    InertiaEllipsoid result;
    result.centroid = centred.mean.transpose() + from_mean;

    const double mean = (second(0, 0) + second(2, 2)) / 2., difference = (second(0, 0) - second(2, 2)) / 2.;
    const double radius     = std::hypot(difference, second(0, 2));
    result.L                = std::sqrt(5. * (mean + radius) / volume);
    result.B                = std::sqrt(5. * (mean - radius) / volume);
    result.W                = std::sqrt(5. * second(1, 1) / volume);
    result.taylor_parameter = (result.L - result.B) / (result.L + result.B);
    result.inclination      = 0.5 * std::atan2(second(0, 2), difference);
    if (result.inclination <= -M_PI / 2.)
      result.inclination += M_PI;
    return result;
  }
} // namespace tanktread
