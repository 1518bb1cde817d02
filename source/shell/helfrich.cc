// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Helfrich's bending energy and the two forms of its virtual work.

#include <tanktread/shell/helfrich.h>

#include <Eigen/Geometry>

#include <cmath>

namespace tanktread
{
  // Write b_11, b_12, b_22 for a_{1,1}, a_{1,2}, a_{2,2}, and
  //   m = a_1 x a_2,  D = m . m = det a,  P = a22 b_11 - 2 a12 b_12 + a11 b_22,  h = P . m.
  // Then kappa_m = h / (2 D^{3/2}): everything is a function of the two polynomials h and D of y.
  namespace
  {
    using Vector = Eigen::Vector3d;
    using Matrix = Eigen::Matrix3d;

    enum Row
    {
      row_1,
      row_2,
      row_11,
      row_12,
      row_22
    };

    struct Frame
    {
      explicit Frame(const SurfaceDerivatives &y)
        : a_1(y.row(row_1))
        , a_2(y.row(row_2))
        , b_11(y.row(row_11))
        , b_12(y.row(row_12))
        , b_22(y.row(row_22))
        , m(a_1.cross(a_2))
        , a11(a_1.squaredNorm())
        , a12(a_1.dot(a_2))
        , a22(a_2.squaredNorm())
        , P(a22 * b_11 - 2. * a12 * b_12 + a11 * b_22)
        , D(m.squaredNorm())
        , h(P.dot(m))
        , J(std::sqrt(D))
        , curvature(h / (2. * D * J))
      {}

      Vector a_1, a_2, b_11, b_12, b_22, m;
      double a11, a12, a22;
      Vector P;
      double D, h, J, curvature;
    };

    /** Matrix of v -> w x v. */
    Matrix
    cross_matrix(const Vector &w)
    {
      Matrix matrix;
      matrix << 0., -w[2], w[1], w[2], 0., -w[0], -w[1], w[0], 0.;
      return matrix;
    }

    auto
    block(SurfaceDerivativesTangent &matrix, const Row p, const Row q)
    {
      return matrix.block<3, 3>(3 * p, 3 * q);
    }

    SurfaceDerivatives
    gradient_of_D(const Frame &f)
    {
      SurfaceDerivatives g = SurfaceDerivatives::Zero();
      g.row(row_1)         = 2. * (f.a22 * f.a_1 - f.a12 * f.a_2);
      g.row(row_2)         = 2. * (f.a11 * f.a_2 - f.a12 * f.a_1);
      return g;
    }

    /** matrix += factor * second derivatives of D. */
    void
    add_hessian_of_D(const Frame &f, const double factor, SurfaceDerivativesTangent &matrix)
    {
      const Matrix a_1_a_2 = f.a_1 * f.a_2.transpose();
      const Matrix mixed   = factor * (4. * a_1_a_2 - 2. * a_1_a_2.transpose() - 2. * f.a12 * Matrix::Identity());
      block(matrix, row_1, row_1) += 2. * factor * (f.a22 * Matrix::Identity() - f.a_2 * f.a_2.transpose());
      block(matrix, row_2, row_2) += 2. * factor * (f.a11 * Matrix::Identity() - f.a_1 * f.a_1.transpose());
      block(matrix, row_1, row_2) += mixed;
      block(matrix, row_2, row_1) += mixed.transpose();
    }

    /** The part q of the gradient of h in which the metric in P is held: q . dy = a22 m . db_11 - 2 a12 m . db_12 + a11 m . db_22 + P . dm. */
    SurfaceDerivatives
    gradient_of_h_at_fixed_metric(const Frame &f)
    {
      SurfaceDerivatives q;
      q.row(row_1)  = f.a_2.cross(f.P);
      q.row(row_2)  = f.P.cross(f.a_1);
      q.row(row_11) = f.a22 * f.m;
      q.row(row_12) = -2. * f.a12 * f.m;
      q.row(row_22) = f.a11 * f.m;
      return q;
    }

    /** The rest of the gradient of h, in rows a_1 and a_2. */
    void
    add_metric_part(const Frame &f, SurfaceDerivatives &gradient)
    {
      const double b11 = f.b_11.dot(f.m), b12 = f.b_12.dot(f.m), b22 = f.b_22.dot(f.m);
      gradient.row(row_1) += 2. * (b22 * f.a_1 - b12 * f.a_2);
      gradient.row(row_2) += 2. * (b11 * f.a_2 - b12 * f.a_1);
    }

    /** matrix += factor * derivative of gradient_of_h_at_fixed_metric(), in which the metric does vary now. Not symmetric. */
    void
    add_tangent_at_fixed_metric(const Frame &f, const double factor, SurfaceDerivativesTangent &matrix)
    {
      const Vector m = factor * f.m, a_1 = factor * f.a_1, a_2 = factor * f.a_2;
      const Matrix A_1 = cross_matrix(a_1), A_2 = cross_matrix(a_2), P = cross_matrix(factor * f.P);
      const Matrix m_a_1 = 2. * m * f.a_1.transpose(), m_a_2 = 2. * m * f.a_2.transpose();

      block(matrix, row_1, row_1) += 2. * (a_2.cross(f.b_22) * f.a_1.transpose() - a_2.cross(f.b_12) * f.a_2.transpose());
      block(matrix, row_1, row_2) += 2. * (a_2.cross(f.b_11) * f.a_2.transpose() - a_2.cross(f.b_12) * f.a_1.transpose()) - P;
      block(matrix, row_2, row_1) += 2. * (f.b_22.cross(a_1) * f.a_1.transpose() - f.b_12.cross(a_1) * f.a_2.transpose()) + P;
      block(matrix, row_2, row_2) += 2. * (f.b_11.cross(a_1) * f.a_2.transpose() - f.b_12.cross(a_1) * f.a_1.transpose());

      block(matrix, row_1, row_11) += f.a22 * A_2;
      block(matrix, row_1, row_12) -= 2. * f.a12 * A_2;
      block(matrix, row_1, row_22) += f.a11 * A_2;
      block(matrix, row_2, row_11) -= f.a22 * A_1;
      block(matrix, row_2, row_12) += 2. * f.a12 * A_1;
      block(matrix, row_2, row_22) -= f.a11 * A_1;

      block(matrix, row_11, row_1) -= f.a22 * A_2;
      block(matrix, row_11, row_2) += f.a22 * A_1 + m_a_2;
      block(matrix, row_12, row_1) += 2. * f.a12 * A_2 - m_a_2;
      block(matrix, row_12, row_2) -= 2. * f.a12 * A_1 + m_a_1;
      block(matrix, row_22, row_1) += m_a_1 - f.a11 * A_2;
      block(matrix, row_22, row_2) += f.a11 * A_1;
    }

    /** matrix += factor * derivative of add_metric_part(); with the function above the symmetric second derivatives of h. */
    void
    add_tangent_of_metric_part(const Frame &f, const double factor, SurfaceDerivativesTangent &matrix)
    {
      const Vector a_1 = 2. * factor * f.a_1, a_2 = 2. * factor * f.a_2;
      const double b11 = 2. * factor * f.b_11.dot(f.m), b12 = 2. * factor * f.b_12.dot(f.m), b22 = 2. * factor * f.b_22.dot(f.m);
      const Vector a_2_b_12 = f.a_2.cross(f.b_12), b_12_a_1 = f.b_12.cross(f.a_1);

      block(matrix, row_1, row_1) += b22 * Matrix::Identity() + a_1 * f.a_2.cross(f.b_22).transpose() - a_2 * a_2_b_12.transpose();
      block(matrix, row_1, row_2) += a_1 * f.b_22.cross(f.a_1).transpose() - a_2 * b_12_a_1.transpose() - b12 * Matrix::Identity();
      block(matrix, row_2, row_1) += a_2 * f.a_2.cross(f.b_11).transpose() - a_1 * a_2_b_12.transpose() - b12 * Matrix::Identity();
      block(matrix, row_2, row_2) += b11 * Matrix::Identity() + a_2 * f.b_11.cross(f.a_1).transpose() - a_1 * b_12_a_1.transpose();

      block(matrix, row_1, row_12) -= a_2 * f.m.transpose();
      block(matrix, row_1, row_22) += a_1 * f.m.transpose();
      block(matrix, row_2, row_11) += a_2 * f.m.transpose();
      block(matrix, row_2, row_12) -= a_1 * f.m.transpose();
    }

    /** View as a column of 15 numbers. */
    auto
    flat(const SurfaceDerivatives &g)
    {
      return Eigen::Map<const Eigen::Matrix<double, 15, 1>>(g.data());
    }
  } // namespace


  double
  bending_energy(const SurfaceDerivatives &y, const double modulus, const double reference_curvature)
  {
    const Frame  f(y);
    const double e = f.curvature - reference_curvature;
    return 2. * modulus * e * e * f.J;
  }


  void
  variational_bending(const SurfaceDerivatives  &y,
                      const double               modulus,
                      const double               reference_curvature,
                      SurfaceDerivatives        &gradient,
                      SurfaceDerivativesTangent *tangent)
  {
    // psi(h, D) = 2 kappa_B e^2 sqrt(D), e = h/(2 D^{3/2}) - kappa^R; k is the curvature.
    const Frame  f(y);
    const double k = f.curvature, e = k - reference_curvature, D = f.D, J = f.J;
    const double psi_h = 2. * modulus * e / D, psi_D = modulus * e * (e - 6. * k) / J;

    SurfaceDerivatives       h_gradient = gradient_of_h_at_fixed_metric(f);
    const SurfaceDerivatives D_gradient = gradient_of_D(f);
    add_metric_part(f, h_gradient);
    gradient = psi_h * h_gradient + psi_D * D_gradient;
    if (tangent == nullptr)
      return;

    const double                       psi_hh = modulus / (D * D * J), psi_hD = -modulus * (3. * k + 2. * e) / (D * D);
    const double                       psi_DD = modulus * (9. * k * (k + e) - 0.5 * e * e) / (D * J);
    const auto                         h_1 = flat(h_gradient), D_1 = flat(D_gradient);
    const Eigen::Matrix<double, 15, 1> along_h = psi_hh * h_1 + psi_hD * D_1, along_D = psi_hD * h_1 + psi_DD * D_1;
    tangent->noalias() = h_1 * along_h.transpose();
    tangent->topRows<6>().noalias() += D_1.head<6>() * along_D.transpose();
    add_tangent_at_fixed_metric(f, psi_h, *tangent);
    add_tangent_of_metric_part(f, psi_h, *tangent);
    add_hessian_of_D(f, psi_D, *tangent);
  }


  void
  moment_only_bending(const SurfaceDerivatives  &y,
                      const double               modulus,
                      const double               reference_curvature,
                      SurfaceDerivatives        &work,
                      SurfaceDerivativesTangent *tangent)
  {
    // work = c (q - (h/2D) grad D) with c = 2 kappa_B e/D; the subtracted term is the part of q that would turn no normal, only stretch m.
    const Frame  f(y);
    const double k = f.curvature, e = k - reference_curvature, D = f.D;
    const double c = 2. * modulus * e / D, stretch = f.h / (2. * D);

    const SurfaceDerivatives q = gradient_of_h_at_fixed_metric(f), D_gradient = gradient_of_D(f);
    const SurfaceDerivatives moment = q - stretch * D_gradient;
    work                            = c * moment;
    if (tangent == nullptr)
      return;

    const double       c_h = modulus / (D * D * f.J), c_D = -modulus * (3. * k + 2. * e) / (D * D);
    SurfaceDerivatives h_gradient = q;
    add_metric_part(f, h_gradient);
    const auto                         h_1 = flat(h_gradient), D_1 = flat(D_gradient);
    const Eigen::Matrix<double, 15, 1> c_gradient       = c_h * h_1 + c_D * D_1;
    const Eigen::Matrix<double, 15, 1> stretch_gradient = h_1 / (2. * D) - stretch / D * D_1;
    tangent->noalias()                                  = flat(moment) * c_gradient.transpose();
    tangent->topRows<6>().noalias() -= (c * D_1.head<6>()) * stretch_gradient.transpose();
    add_tangent_at_fixed_metric(f, c, *tangent);
    add_hessian_of_D(f, -c * stretch, *tangent);
  }
} // namespace tanktread
