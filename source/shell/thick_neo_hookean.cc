// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the incompressible neo-Hookean shell of finite thickness.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/thick_neo_hookean.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace tanktread
{
  // The metric of a layer, a - 2 t kappa + t^2 kappa a^{-1} kappa with t = zeta eta, is (1 - t^2 kappa_G) a - 2 t (1 - t kappa_m) kappa: every matrix of two
  // rows satisfies its own characteristic equation. Its determinant is det a times the square of the shifter, s = 1 - 2 t kappa_m + t^2 kappa_G.
  // So a layer knows the surface by five numbers:
  //   d = det a,  n = a22 k11 - 2 a12 k12 + a11 k22 = 2 d kappa_m,  k = det kappa = d kappa_G,  P = gbar^{..} : a,  Q = gbar^{..} : kappa.
  namespace
  {
    using Vector5 = Eigen::Matrix<double, 5, 1>;
    using Matrix5 = Eigen::Matrix<double, 5, 5>;

    enum Invariant
    {
      d_,
      n_,
      k_,
      P_,
      Q_
    };

    /** Density of a layer with its derivatives by the five numbers; only the upper triangle of the hessian is set. */
    struct LayerDensity
    {
      double  energy;
      Vector5 gradient;
      Matrix5 hessian;
    };

    /** A function of d, n and k with the derivatives that do not vanish. */
    struct Coefficient
    {
      double value, d, n, k, dd, dn, dk;
    };

    /** det gbar/det g and its derivatives, added to `w`. */
    void
    add_thickness_stretch(const Coefficient &s, const double d, const double determinant, LayerDensity &w)
    {
      const double f = determinant / (d * s.value * s.value), by_s = -2. * f / s.value, by_ss = 6. * f / (s.value * s.value), by_sd = -by_s / d;
      w.energy += f;
      w.gradient[d_] += by_s * s.d - f / d;
      w.gradient[n_] += by_s * s.n;
      w.gradient[k_] += by_s * s.k;
      w.hessian(d_, d_) += by_ss * s.d * s.d + 2. * by_sd * s.d + by_s * s.dd + 2. * f / (d * d);
      w.hessian(d_, n_) += by_ss * s.d * s.n + by_sd * s.n + by_s * s.dn;
      w.hessian(d_, k_) += by_ss * s.d * s.k + by_sd * s.k + by_s * s.dk;
      w.hessian(n_, n_) += by_ss * s.n * s.n;
      w.hessian(n_, k_) += by_ss * s.n * s.k;
      w.hessian(k_, k_) += by_ss * s.k * s.k;
    }

    /** gbar^{alpha beta} g_{alpha beta} + det gbar/det g - 3. */
    LayerDensity
    layer_density(const Vector5 &x, const ThickReference::Layer &layer)
    {
      const double d = x[d_], z = layer.height, t = z / std::sqrt(d), t_2 = t * t / d; // t^2 kappa_G = t_2 k
      const double u = 0.5 * t * x[n_] / d, v = t_2 * x[k_];                           // t kappa_m, t^2 kappa_G
      const double s = 1. - 2. * u + v;
      // s is the product of 1 - t kappa_1 and 1 - t kappa_2, 2 (1 - u) their sum: both are positive
      if (!(s > 0.) || !(u < 1.))
        throw NumericalError("The shell is folded: half its thickness is more than a radius of curvature.");

      const Coefficient of_a{1. - v, 2. * v / d, 0., -t_2, -6. * v / (d * d), 0., 2. * t_2 / d};
      const Coefficient of_kappa{-2. * t * (1. - u), t * (1. - 4. * u) / d, t_2, 0., t * (12. * u - 1.5) / (d * d), -2. * t_2 / d, 0.};
      const Coefficient shifter{s, (3. * u - 2. * v) / d, -t / d, t_2, (6. * v - 7.5 * u) / (d * d), 1.5 * t / (d * d), -2. * t_2 / d};

      LayerDensity w{of_a.value * x[P_] + of_kappa.value * x[Q_] - 3., Vector5::Zero(), Matrix5::Zero()};
      w.gradient << of_a.d * x[P_] + of_kappa.d * x[Q_], of_kappa.n * x[Q_], of_a.k * x[P_], of_a.value, of_kappa.value;
      w.hessian(d_, d_) = of_a.dd * x[P_] + of_kappa.dd * x[Q_];
      w.hessian(d_, n_) = of_kappa.dn * x[Q_];
      w.hessian(d_, k_) = of_a.dk * x[P_];
      w.hessian(d_, P_) = of_a.d;
      w.hessian(d_, Q_) = of_kappa.d;
      w.hessian(n_, Q_) = of_kappa.n;
      w.hessian(k_, P_) = of_a.k;
      add_thickness_stretch(shifter, d, layer.metric.determinant, w);
      return w;
    }

    /** matrix += factor * second derivatives of the three quadratic invariants d, n, k by (a11, a12, a22, k11, k12, k22). */
    void
    add_quadratic_invariants(const Vector5 &factor, Eigen::Matrix<double, 6, 6> &matrix)
    {
      const auto add = [&matrix](const int i, const int j, const double value) {
        matrix(i, j) += value;
        matrix(j, i) += value;
      };
      add(0, 2, factor[d_]);
      add(1, 1, -factor[d_]);
      add(2, 3, factor[n_]);
      add(1, 4, -2. * factor[n_]);
      add(0, 5, factor[n_]);
      add(3, 5, factor[k_]);
      add(4, 4, -factor[k_]);
    }
  } // namespace


  CurvatureTensor::CurvatureTensor(const SurfaceDerivatives &y)
  {
    const Eigen::Vector3d a_3 = Eigen::Vector3d(y.row(0)).cross(Eigen::Vector3d(y.row(1))).normalized();
    k11                       = y.row(2).dot(a_3);
    k12                       = y.row(3).dot(a_3);
    k22                       = y.row(4).dot(a_3);
  }


  ThickReference::ThickReference(const SurfaceDerivatives &y, const double thickness)
  {
    const Metric          a{y.row(0).squaredNorm(), y.row(0).dot(y.row(1)), y.row(1).squaredNorm()};
    const CurvatureTensor kappa(y);
    const double          d = a.determinant(), mean = (a.a22 * kappa.k11 - 2. * a.a12 * kappa.k12 + a.a11 * kappa.k22) / (2. * d);
    const double          gaussian = (kappa.k11 * kappa.k22 - kappa.k12 * kappa.k12) / d;
    const double          largest = std::abs(mean) + std::sqrt(std::max(0., mean * mean - gaussian)), simpson[] = {1. / 6., 4. / 6., 1. / 6.};
    if (!(0.5 * thickness * largest < 1.))
      throw InputError("Capsule/Thickness: got " + std::to_string(thickness) +
                       "; allowed: less than twice the smallest radius of curvature of the initial shape, which is " + std::to_string(1. / largest) +
                       " or less.");
    for (int i = 0; i < 3; ++i)
      {
        const double zeta = 0.5 * (i - 1) * thickness, shifter = 1. - 2. * zeta * mean + zeta * zeta * gaussian;
        const double of_a = 1. - zeta * zeta * gaussian, of_kappa = -2. * zeta * (1. - zeta * mean);
        layers[i].metric =
          ReferenceMetric(Metric{of_a * a.a11 + of_kappa * kappa.k11, of_a * a.a12 + of_kappa * kappa.k12, of_a * a.a22 + of_kappa * kappa.k22});
        layers[i].height = zeta * std::sqrt(d);
        layers[i].weight = simpson[i] * shifter;
      }
  }


  ThickDensity
  thick_neo_hookean(const Metric &a, const CurvatureTensor &kappa, const ThickReference &reference, const double surface_young_modulus, const bool with_hessian)
  {
    const double d = a.determinant(), n = a.a22 * kappa.k11 - 2. * a.a12 * kappa.k12 + a.a11 * kappa.k22, k = kappa.k11 * kappa.k22 - kappa.k12 * kappa.k12;
    // rows: the five numbers; columns: a11, a12, a22, k11, k12, k22
    Eigen::Matrix<double, 5, 6> by_tensors = Eigen::Matrix<double, 5, 6>::Zero();
    by_tensors.row(d_).head<3>() << a.a22, -2. * a.a12, a.a11;
    by_tensors.row(n_) << kappa.k22, -2. * kappa.k12, kappa.k11, a.a22, -2. * a.a12, a.a11;
    by_tensors.row(k_).tail<3>() << kappa.k22, -2. * kappa.k12, kappa.k11;

    ThickDensity result{0., Eigen::Matrix<double, 6, 1>::Zero(), Eigen::Matrix<double, 6, 6>::Zero()};
    Vector5      quadratic = Vector5::Zero();
    for (const ThickReference::Layer &layer : reference.layers)
      {
        const ReferenceMetric &g = layer.metric;
        by_tensors.row(P_).head<3>() << g.inverse_11, 2. * g.inverse_12, g.inverse_22;
        by_tensors.row(Q_).tail<3>() = by_tensors.row(P_).head<3>();
        Vector5 x;
        x << d, n, k, g.inverse_11 * a.a11 + 2. * g.inverse_12 * a.a12 + g.inverse_22 * a.a22,
          g.inverse_11 * kappa.k11 + 2. * g.inverse_12 * kappa.k12 + g.inverse_22 * kappa.k22;

        const LayerDensity w      = layer_density(x, layer);
        const double       weight = surface_young_modulus / 6. * layer.weight;
        result.energy += weight * w.energy;
        result.gradient.noalias() += weight * (by_tensors.transpose() * w.gradient);
        if (!with_hessian)
          continue;
        const Matrix5 second = weight * Matrix5(w.hessian.selfadjointView<Eigen::Upper>());
        result.hessian.noalias() += by_tensors.transpose() * (second * by_tensors).eval();
        quadratic += weight * w.gradient;
      }
    if (with_hessian)
      add_quadratic_invariants(quadratic, result.hessian);
    return result;
  }


  void
  add_derivatives(const ThickDensity &w, const double weight, const SurfaceDerivatives &y, SurfaceDerivatives &gradient, SurfaceDerivativesTangent *tangent)
  {
    using Vector     = Eigen::Vector3d;
    using Matrix     = Eigen::Matrix3d;
    const Vector a_1 = y.row(0), a_2 = y.row(1), m = a_1.cross(a_2);
    const double a11 = a_1.squaredNorm(), a12 = a_1.dot(a_2), a22 = a_2.squaredNorm(), d = m.squaredNorm();
    const Vector a_3           = m / std::sqrt(d);
    const Vector dual[]        = {(a22 * a_1 - a12 * a_2) / d, (a11 * a_2 - a12 * a_1) / d};
    const double inverse[2][2] = {{a22 / d, -a12 / d}, {-a12 / d, a11 / d}};

    // rows: a11, a12, a22, k11, k12, k22; delta kappa = a_3 . (delta b - (b . a^gamma) delta a_gamma) for b = a_{alpha,beta}
    Eigen::Matrix<double, 6, 15> by_y = Eigen::Matrix<double, 6, 15>::Zero();
    by_y.row(0).head<3>()             = 2. * a_1;
    by_y.row(1).head<3>()             = a_2;
    by_y.row(1).segment<3>(3)         = a_1;
    by_y.row(2).segment<3>(3)         = 2. * a_2;
    for (int i = 0; i < 3; ++i)
      {
        const Vector b                        = y.row(2 + i);
        by_y.row(3 + i).head<3>()             = -b.dot(dual[0]) * a_3;
        by_y.row(3 + i).segment<3>(3)         = -b.dot(dual[1]) * a_3;
        by_y.row(3 + i).segment<3>(6 + 3 * i) = a_3;
      }
    const Eigen::Matrix<double, 6, 1> force = weight * w.gradient;
    Eigen::Map<Eigen::Matrix<double, 15, 1>>(gradient.data()).noalias() += by_y.transpose() * force;
    if (tangent == nullptr)
      return;

    tangent->noalias() += by_y.transpose() * (weight * w.hessian * by_y).eval();
    for (int c = 0; c < 3; ++c)
      {
        (*tangent)(c, c) += 2. * force[0];
        (*tangent)(c + 3, c + 3) += 2. * force[2];
        (*tangent)(c, c + 3) += force[1];
        (*tangent)(c + 3, c) += force[1];
      }
    // second derivatives of kappa, multiplied by the moments
    const Vector moment  = force[3] * y.row(2) + force[4] * y.row(3) + force[5] * y.row(4);
    const double along[] = {moment.dot(dual[0]), moment.dot(dual[1])}, normal = moment.dot(a_3);
    const Matrix turned[]    = {dual[0] * a_3.transpose(), dual[1] * a_3.transpose()}; // minus the derivatives of a_3 by a_1 and a_2
    const Matrix a_3_squared = a_3 * a_3.transpose();
    for (int g = 0; g < 2; ++g)
      {
        for (int e = 0; e < 2; ++e)
          tangent->block<3, 3>(3 * g, 3 * e) += along[g] * turned[e] + along[e] * turned[g].transpose() - inverse[g][e] * normal * a_3_squared;
        for (int i = 0; i < 3; ++i)
          {
            tangent->block<3, 3>(6 + 3 * i, 3 * g) -= force[3 + i] * turned[g];
            tangent->block<3, 3>(3 * g, 6 + 3 * i) -= force[3 + i] * turned[g].transpose();
          }
      }
  }
} // namespace tanktread
