// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the shell of finite thickness.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/neo_hookean.h>
#include <tanktread/shell/shell.h>
#include <tanktread/shell/thick_neo_hookean.h>
#include <tanktread/surface/capsule_shape.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

namespace
{
  using namespace tanktread;
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  using Eigen::VectorXd;

  using Vector6 = Eigen::Matrix<double, 6, 1>;

  SurfaceDerivatives
  random_point(const double size, const unsigned int seed)
  {
    std::mt19937                           engine(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return SurfaceDerivatives::NullaryExpr([&]() { return uniform(engine); });
  }

  /** A point of a curved surface in skew coordinates. */
  SurfaceDerivatives
  curved_point()
  {
    SurfaceDerivatives y;
    y << 1.2, 0.1, -0.2, 0.3, 0.9, 0.2, 0.1, 0.3, -1.1, -0.2, 0.1, 0.3, 0.2, 0.1, -0.6;
    return y;
  }

  SurfaceDerivatives
  plate()
  {
    SurfaceDerivatives y = SurfaceDerivatives::Zero();
    y(0, 0) = y(1, 1) = 1.;
    return y;
  }

  Metric
  metric_of(const SurfaceDerivatives &y)
  {
    return {y.row(0).squaredNorm(), y.row(0).dot(y.row(1)), y.row(1).squaredNorm()};
  }

  double
  energy(const SurfaceDerivatives &y, const ThickReference &reference)
  {
    return thick_neo_hookean(metric_of(y), CurvatureTensor(y), reference, 1.).energy;
  }

  ThickDensity
  density(const Vector6 &v, const ThickReference &reference)
  {
    CurvatureTensor kappa(curved_point());
    kappa.k11 = v[3];
    kappa.k12 = v[4];
    kappa.k22 = v[5];
    return thick_neo_hookean({v[0], v[1], v[2]}, kappa, reference, 1.);
  }

  /** Derivative at 0 by central differences of fourth order. */
  template <typename F>
  auto
  slope(const F &f, const double h)
  {
    return ((8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h)).eval();
  }

  // ------------------------------------------------------------------------------------------------------------- at a point

  TEST(ThickNeoHookean, IsTheMeanOfItsLayers)
  {
    // The layers built from tangents, without invariants: a_alpha + zeta eta a_{3,alpha} and the two shape operators.
    const double             h = 0.3;
    const SurfaceDerivatives Y = curved_point(), y = Y + random_point(0.2, 3);
    const auto               layer = [](const SurfaceDerivatives &y, const double t) {
      Eigen::Matrix2d       a, kappa;
      const Metric          m = metric_of(y);
      const CurvatureTensor k(y);
      a << m.a11, m.a12, m.a12, m.a22;
      kappa << k.k11, k.k12, k.k12, k.k22;
      const Eigen::Matrix2d shifter = Eigen::Matrix2d::Identity() - t * a.inverse() * kappa;
      return Eigen::Matrix2d(shifter.transpose() * a * shifter);
    };
    const double eta  = std::sqrt(metric_of(Y).determinant() / metric_of(y).determinant());
    double       mean = 0;
    for (const int i : {-1, 0, 1})
      {
        const Eigen::Matrix2d g_bar = layer(Y, i * h / 2.), g = layer(y, i * h / 2. * eta);
        const double          w = (g_bar.inverse() * g).trace() + g_bar.determinant() / g.determinant() - 3.;
        mean += (i == 0 ? 4. : 1.) / 36. * w * std::sqrt(g_bar.determinant() / metric_of(Y).determinant());
      }
    EXPECT_GT(mean, 0.01);
    EXPECT_NEAR(energy(y, ThickReference(Y, h)), mean, 1e-14);
  }

  TEST(ThickNeoHookean, DerivativesMatchDifferences)
  {
    const ThickReference     reference(curved_point(), 0.3);
    const SurfaceDerivatives y = curved_point() + random_point(0.2, 3);
    const Metric             a = metric_of(y);
    const CurvatureTensor    kappa(y);
    Vector6                  v;
    v << a.a11, a.a12, a.a22, kappa.k11, kappa.k12, kappa.k22;
    const ThickDensity w = density(v, reference);
    for (int i = 0; i < 6; ++i)
      {
        const auto by = [&](const double t) { return density(v + t * Vector6::Unit(i), reference); };
        EXPECT_NEAR(slope([&](const double t) { return Eigen::Matrix<double, 1, 1>(by(t).energy); }, 2e-4)[0], w.gradient[i], 1e-10);
        EXPECT_LT((slope([&](const double t) { return by(t).gradient; }, 2e-4) - w.hessian.col(i)).norm(), 1e-9);
      }

    SurfaceDerivatives        gradient = SurfaceDerivatives::Zero();
    SurfaceDerivativesTangent tangent  = SurfaceDerivativesTangent::Zero();
    add_derivatives(w, 1.7, y, gradient, &tangent);
    const auto gradient_at = [&](const SurfaceDerivatives &z) {
      SurfaceDerivatives g = SurfaceDerivatives::Zero();
      add_derivatives(thick_neo_hookean(metric_of(z), CurvatureTensor(z), reference, 1.), 1.7, z, g, nullptr);
      return g;
    };
    for (int i = 0; i < 15; ++i)
      {
        SurfaceDerivatives dy = SurfaceDerivatives::Zero();
        dy(i / 3, i % 3)      = 1.;
        const auto by_energy  = [&](const double t) { return Eigen::Matrix<double, 1, 1>(1.7 * energy(y + t * dy, reference)); };
        const auto by_force   = [&](const double t) { return gradient_at(y + t * dy); };
        EXPECT_NEAR(slope(by_energy, 2e-4)[0], gradient(i / 3, i % 3), 1e-10);
        const SurfaceDerivatives change = slope(by_force, 2e-4);
        EXPECT_LT((Eigen::Map<const Eigen::Matrix<double, 15, 1>>(change.data()) - tangent.col(i)).norm(), 1e-9) << i;
      }
    EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-14 * tangent.norm());
  }

  TEST(ThickNeoHookean, UndeformedIsFreeOfStress)
  {
    const SurfaceDerivatives y = curved_point();
    const ThickDensity       w = thick_neo_hookean(metric_of(y), CurvatureTensor(y), ThickReference(y, 0.3), 1.);
    EXPECT_NEAR(w.energy, 0., 1e-15);
    EXPECT_LT(w.gradient.norm(), 1e-15);
  }

  TEST(ThickNeoHookean, InflatedSphereHasTheStretchesOfItsRadii)
  {
    // Unit sphere blown up to radius R: the layer of radius 1 + zeta has R + eta zeta, eta = 1/R^2.
    SurfaceDerivatives y = plate();
    y(2, 2) = y(4, 2) = -1.;
    const double h    = 0.2;
    for (const double R : {0.9, 1.2})
      {
        double W = 0;
        for (const int i : {-1, 0, 1})
          {
            const double zeta = 0.5 * h * i, l = (R + zeta / (R * R)) / (1. + zeta);
            W += (i == 0 ? 4. : 1.) / 36. * (1. + zeta) * (1. + zeta) * (2. * l * l + 1. / (l * l * l * l) - 3.);
          }
        EXPECT_NEAR(energy(R * y, ThickReference(y, h)), W, 1e-15);
      }
  }

  TEST(ThickNeoHookean, BendsLikeAClassicalPlate)
  {
    // D ((kappa_1 + kappa_2)^2 / 2 - (1 - nu) (kappa_1 kappa_2 - kappa_12^2)) with D = E h^3/(12 (1 - nu^2)), nu = 1/2; here E h = 1. The membrane is at rest.
    const double nu = 0.5;
    for (const Vector3d &kappa : {Vector3d(1., 0., 0.), Vector3d(1., 0., 1.), Vector3d(0., 1., 0.), Vector3d(1., 0.3, -0.7)})
      {
        double error[2];
        for (int i = 0; i < 2; ++i)
          {
            const double             h = 0.02 / (1 << i), D = h * h / (12. * (1. - nu * nu));
            const SurfaceDerivatives flat = plate();
            SurfaceDerivatives       y    = flat;
            y.col(2).tail<3>()            = kappa;
            const double mean = kappa[0] + kappa[2], gaussian = kappa[0] * kappa[2] - kappa[1] * kappa[1];
            error[i] = energy(y, ThickReference(flat, h)) / (D * (0.5 * mean * mean - (1. - nu) * gaussian)) - 1.;
          }
        std::printf("bending of a plate, curvatures %4.1f %4.1f %4.1f: relative difference from the classical plate %9.2e at h = 0.02, %9.2e at 0.01\n",
                    kappa[0],
                    kappa[1],
                    kappa[2],
                    error[0],
                    error[1]);
        EXPECT_LT(std::abs(error[0]), 1e-2);
        EXPECT_NEAR(error[0] / error[1], 4., 0.05);
      }
  }

  TEST(ThickNeoHookean, SaysWhenItFolds)
  {
    SurfaceDerivatives y = plate();
    y(2, 2) = y(4, 2) = -1.;
    EXPECT_NO_THROW(ThickReference(y, 1.9));
    EXPECT_THROW(ThickReference(y, 2.1), InputError); // both sides of the inner layer turned: its determinant is positive
    y(4, 2) = 0.;
    EXPECT_THROW(ThickReference(y, 2.1), InputError);
    const ThickReference reference(plate(), 0.2);
    for (const double k : {-11., 11.})
      {
        y(2, 2) = y(4, 2) = k;
        EXPECT_THROW(energy(y, reference), NumericalError);
        y(4, 2) = 0.;
        EXPECT_THROW(energy(y, reference), NumericalError);
        y(2, 2) = 9. / 11. * k;
        EXPECT_NO_THROW(energy(y, reference));
      }
  }

  // -------------------------------------------------------------------------------------------------------------- a capsule

  ControlPoints
  random_field(const Eigen::Index n, const double size, const unsigned int seed)
  {
    std::mt19937                           engine(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return ControlPoints::NullaryExpr(n, 3, [&]() { return uniform(engine); });
  }

  /** Reference is an ellipsoid with 42 control points, the state a random deformation of it. */
  struct Example
  {
    Example()
      : capsule(make_capsule(ellipsoid(), 1))
      , surface(capsule.topology, triangle_quadrature(3), Derivatives::second)
      , x(1.1 * capsule.control_points + random_field(42, 0.06, 1))
    {}

    static CapsuleShapeParameters
    ellipsoid()
    {
      CapsuleShapeParameters shape;
      shape.shape       = Shape::ellipsoid;
      shape.axes        = {{1.4, 1.2, 1.}};
      shape.inclination = 0.15;
      return shape;
    }

    Shell
    shell(const double thickness, const double bending_modulus = 0., const BendingForm form = BendingForm::variational) const
    {
      ShellParameters parameters;
      parameters.thickness = thickness;
      parameters.form      = form;
      return Shell(surface, parameters, {1., bending_modulus}, capsule.control_points);
    }

    FittedShape        capsule;
    SubdivisionSurface surface;
    ControlPoints      x;
  };

  double
  total(const Shell::Energy &energy)
  {
    return energy.membrane + energy.bending;
  }

  TEST(ThickShell, ForceIsMinusTheGradientOfTheEnergy)
  {
    const Example example;
    for (const double bending_modulus : {0., 0.3})
      {
        const Shell         shell = example.shell(0.2, bending_modulus);
        const ControlPoints f     = shell.force(example.x);
        for (unsigned int seed = 10; seed < 13; ++seed)
          {
            const ControlPoints dx = random_field(42, 1., seed);
            const auto          E  = [&](const double t) { return Eigen::Matrix<double, 1, 1>(total(shell.energy(example.x + t * dx))); };
            EXPECT_NEAR(slope(E, 1e-4)[0], -f.cwiseProduct(dx).sum(), 1e-8 * f.norm() * dx.norm());
          }
      }
  }

  TEST(ThickShell, TangentIsMinusTheDerivativeOfTheForce)
  {
    const Example example;
    ControlPoints f;
    SparseMatrix  K;
    for (const double bending_modulus : {0., 0.3})
      for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
        {
          const Shell shell = example.shell(0.2, bending_modulus, form);
          shell.force_and_tangent(example.x, f, K);
          EXPECT_EQ((f - shell.force(example.x)).norm(), 0.);
          const ControlPoints dx      = random_field(42, 1., 30);
          const ControlPoints change  = slope([&](const double t) { return shell.force(example.x + t * dx); }, 1e-4);
          const VectorXd      product = K * Eigen::Map<const VectorXd>(dx.data(), dx.size());
          EXPECT_LT((product + Eigen::Map<const VectorXd>(change.data(), change.size())).norm(), 1e-8 * change.norm());
          const double skew = SparseMatrix(K - SparseMatrix(K.transpose())).norm() / K.norm();
          if (form == BendingForm::variational || bending_modulus == 0.)
            EXPECT_LT(skew, 1e-14);
          else
            EXPECT_GT(skew, 1e-3);
        }
  }

  TEST(ThickShell, RigidMotionsCostNothing)
  {
    const Example       example;
    const Shell         shell = example.shell(0.2);
    const Matrix3d      turn  = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    const auto          moved = [&](const ControlPoints &x) -> ControlPoints { return (x * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2); };
    const ControlPoints f     = shell.force(example.x);
    const double        e     = total(shell.energy(example.x));
    EXPECT_NEAR(total(shell.energy(moved(example.x))), e, 1e-13 * e);
    EXPECT_LT((shell.force(moved(example.x)) - f * turn.transpose()).norm(), 1e-12 * f.norm());
    EXPECT_LT(shell.force(moved(example.capsule.control_points)).norm(), 1e-12 * f.norm());
    EXPECT_NEAR(total(shell.energy(moved(example.capsule.control_points))), 0., 1e-14);
    Vector3d torque = Vector3d::Zero();
    for (Eigen::Index i = 0; i < f.rows(); ++i)
      torque += Vector3d(example.x.row(i)).cross(Vector3d(f.row(i)));
    EXPECT_LT(f.colwise().sum().norm(), 1e-12 * f.rowwise().norm().sum());
    EXPECT_LT(torque.norm(), 1e-12 * f.rowwise().norm().sum());
  }

  TEST(ThickShell, TendsToTheMembraneWithTheSquareOfTheThickness)
  {
    const Example       example;
    const Shell         membrane = example.shell(0.);
    const ControlPoints f        = membrane.force(example.x);
    const double        E        = total(membrane.energy(example.x));
    double              by_force[3], by_energy[3];
    for (int i = 0; i < 3; ++i)
      {
        const Shell shell = example.shell(0.04 / (1 << i));
        by_force[i]       = (shell.force(example.x) - f).norm() / f.norm();
        by_energy[i]      = total(shell.energy(example.x)) / E - 1.;
      }
    std::printf("thick shell beside membrane, relative difference at h = 0.04, 0.02, 0.01: force %.3e %.3e %.3e, energy %.3e %.3e %.3e\n",
                by_force[0],
                by_force[1],
                by_force[2],
                by_energy[0],
                by_energy[1],
                by_energy[2]);
    for (const double *difference : {by_force, by_energy})
      {
        EXPECT_GT(difference[0], 1e-4);
        EXPECT_NEAR(difference[0] / difference[1], 4., 0.04);
        EXPECT_NEAR(difference[1] / difference[2], 4., 0.01);
      }
  }

  TEST(ThickShell, PositiveTangentHasNoNegativeEigenvalues)
  {
    const Example       example;
    const Shell         shell = example.shell(0.2);
    ControlPoints       f;
    SparseMatrix        K, K_plus;
    const auto          smallest = [](const SparseMatrix &A) { return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(A)).eigenvalues()[0]; };
    const ControlPoints x        = 0.8 * example.x; // under compression
    shell.force_and_tangent(x, f, K);
    shell.force_and_tangent(x, f, K_plus, Tangent::positive);
    EXPECT_LT(smallest(K), -1e-2);
    EXPECT_GT(smallest(K_plus), -1e-12);
  }

  TEST(ThickShell, RefusesWrongInput)
  {
    const Example example;
    EXPECT_THROW(example.shell(-0.1), InputError);
    EXPECT_THROW(example.shell(std::nan("")), InputError);
    EXPECT_THROW(example.shell(3.), InputError); // thicker than the radius of curvature
    ShellParameters parameters;
    parameters.thickness = 0.05;
    for (const MembraneLaw law : {MembraneLaw::skalak, MembraneLaw::none})
      {
        parameters.law = law;
        EXPECT_THROW(parameters.check(), InputError);
      }
    parameters.law = MembraneLaw::neo_hookean;
    EXPECT_NO_THROW(parameters.check());
    const SubdivisionSurface first(example.capsule.topology, triangle_quadrature(3), Derivatives::first);
    EXPECT_THROW(Shell(first, parameters, {1., 0.}, example.capsule.control_points), std::logic_error);
  }
} // namespace
