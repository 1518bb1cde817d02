// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of energy, forces and tangent of a shell.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/helfrich.h>
#include <tanktread/surface/face_partition.h>
#include <tanktread/surface/surface_geometry.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "shell_examples.h"
#include <cmath>

namespace
{
  using namespace tanktread;
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  using Eigen::VectorXd;

  TEST(Shell, ForceIsMinusTheGradientOfTheEnergy)
  {
    const Example example;
    const double  h = 1e-4;
    for (const auto &[name, parameters] : combinations(BendingForm::variational))
      {
        const Shell         shell = example.shell(parameters);
        const ControlPoints f     = shell.force(example.x);
        for (unsigned int seed = 10; seed < 13; ++seed)
          {
            const ControlPoints dx    = random_field(42, 1., seed);
            const auto          E     = [&](const double t) { return total(shell.energy(example.x + t * dx)); };
            const double        slope = (8. * (E(h) - E(-h)) - (E(2. * h) - E(-2. * h))) / (12. * h);
            EXPECT_NEAR(slope, -f.cwiseProduct(dx).sum(), 1e-8 * f.norm() * dx.norm()) << name;
          }
      }
  }

  /** kappa_alphabeta at all points for control points x: columns 11, 12, 22. */
  ControlPoints
  curvature_tensor(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    const ControlPoints n = normals(surface, x);
    ControlPoints       kappa(surface.n_points(), 3);
    kappa.col(0) = n.cwiseProduct(surface.S_11() * x).rowwise().sum();
    kappa.col(1) = n.cwiseProduct(surface.S_12() * x).rowwise().sum();
    kappa.col(2) = n.cwiseProduct(surface.S_22() * x).rowwise().sum();
    return kappa;
  }

  TEST(Shell, MomentOnlyForceDoesTheWorkOfTheMoments)
  {
    const Example example;
    const auto   &surface = example.surface;
    const double  h = 1e-4, kappa_B = 0.3;
    for (const auto &[name, parameters] : combinations(BendingForm::moment_only))
      {
        const ControlPoints f = example.shell(parameters).force(example.x) - example.shell(parameters, {1., 0.}).force(example.x);
        VectorXd            m = mean_curvature(surface, example.x);
        if (parameters.reference == ReferenceCurvature::initial)
          m -= mean_curvature(surface, example.capsule.control_points);
        else if (parameters.reference == ReferenceCurvature::value)
          m.array() += 0.7;

        const ControlPoints dx = random_field(42, 1., 20), a_1 = surface.S_1() * example.x, a_2 = surface.S_2() * example.x;
        const auto          kappa = [&](const double t) { return curvature_tensor(surface, example.x + t * dx); };
        const ControlPoints delta = (8. * (kappa(h) - kappa(-h)) - (kappa(2. * h) - kappa(-2. * h))) / (12. * h);
        const VectorXd      area  = area_weights(surface, example.x);
        double              work  = 0;
        for (unsigned int q = 0; q < surface.n_points(); ++q)
          {
            const double a11 = a_1.row(q).squaredNorm(), a12 = a_1.row(q).dot(a_2.row(q)), a22 = a_2.row(q).squaredNorm(), det = a11 * a22 - a12 * a12;
            work += area[q] * 2. * kappa_B * m[q] * (a22 * delta(q, 0) - 2. * a12 * delta(q, 1) + a11 * delta(q, 2)) / det;
          }
        EXPECT_NEAR(work, -f.cwiseProduct(dx).sum(), 1e-8 * f.norm() * dx.norm()) << name;
      }
  }

  TEST(Shell, TangentIsMinusTheDerivativeOfTheForce)
  {
    const Example example;
    const double  h = 1e-4;
    ControlPoints f;
    SparseMatrix  K;
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      for (const double bending_modulus : {0., 0.3})
        for (const auto &[name, parameters] : combinations(form))
          {
            const Shell shell = example.shell(parameters, {1., bending_modulus});
            shell.force_and_tangent(example.x, f, K);
            EXPECT_EQ((f - shell.force(example.x)).norm(), 0.);
            for (unsigned int seed = 30; seed < 32; ++seed)
              {
                const ControlPoints dx     = random_field(42, 1., seed);
                const auto          force  = [&](const double t) { return shell.force(example.x + t * dx); };
                const ControlPoints change = (8. * (force(h) - force(-h)) - (force(2. * h) - force(-2. * h))) / (12. * h);
                EXPECT_LT((K * flat(dx) + flat(change)).norm(), 1e-8 * change.norm()) << name << ", kappa_B " << bending_modulus;
              }
            const double skew = SparseMatrix(K - SparseMatrix(K.transpose())).norm() / K.norm();
            if (form == BendingForm::variational || bending_modulus == 0.)
              EXPECT_LT(skew, 1e-14) << name;
            else
              EXPECT_GT(skew, 1e-3) << name;
          }
  }

  TEST(Shell, TangentWithManyPointsAndOtherValences)
  {
    // 16 control points a face, 28 points a face: the paths that the usual mesh does not take
    TriangleMesh mesh = icosphere(1);
    const auto   apex = mesh.vertices.size();
    for (unsigned int f = 0; f < 3; ++f) // a vertex in the midst of some faces: valence 3, and 7 beside it
      {
        const auto [a, b, c] = mesh.faces[20 * f];
        mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]).normalized());
        mesh.faces[20 * f] = {{a, b, int(apex + f)}};
        mesh.faces.push_back({{b, c, int(apex + f)}});
        mesh.faces.push_back({{c, a, int(apex + f)}});
      }
    check_closed_surface(mesh, "mesh");
    const SubdivisionSurface surface(mesh, triangle_quadrature(7, 1), Derivatives::second);
    ASSERT_GT(surface.support_size(), 12u);
    ControlPoints reference(mesh.vertices.size(), 3);
    for (Eigen::Index i = 0; i < reference.rows(); ++i)
      reference.row(i) = mesh.vertices[i];
    const ControlPoints x = reference + random_field(reference.rows(), 0.02, 5), dx = random_field(reference.rows(), 1., 6);
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      {
        ShellParameters parameters;
        parameters.form = form;
        const Shell   shell(surface, parameters, {1., 0.3}, reference);
        ControlPoints f;
        SparseMatrix  K;
        shell.force_and_tangent(x, f, K);
        const double        h      = 1e-5;
        const auto          force  = [&](const double t) { return shell.force(x + t * dx); };
        const ControlPoints change = (8. * (force(h) - force(-h)) - (force(2. * h) - force(-2. * h))) / (12. * h);
        EXPECT_LT((K * flat(dx) + flat(change)).norm(), 1e-8 * change.norm());
      }
  }

  TEST(Shell, TangentKeepsItsPattern)
  {
    const Example example;
    const Shell   shell = example.shell({});
    ControlPoints f;
    SparseMatrix  K;
    shell.force_and_tangent(example.x, f, K);
    const SparseMatrix first  = K;
    const double      *values = K.valuePtr();
    shell.force_and_tangent(1.1 * example.x, f, K);
    EXPECT_GT(SparseMatrix(K - first).norm(), 1e-3);
    shell.force_and_tangent(example.x, f, K);
    EXPECT_EQ(SparseMatrix(K - first).norm(), 0.);
    EXPECT_EQ(K.valuePtr(), values);
    EXPECT_EQ(K.nonZeros(), example.surface.pattern().n_block_entries());
  }

  TEST(Shell, PartsOfTheFacesSumToTheWhole)
  {
    const Example example;
    const auto    parts = partition_faces(example.capsule.topology, 3);
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      {
        ShellParameters parameters;
        parameters.form     = form;
        const Shell   shell = example.shell(parameters);
        Shell::Energy energy{0., 0.};
        ControlPoints force = ControlPoints::Zero(42, 3), tangent_force = force, f, g;
        SparseMatrix  K, part_K, sum = example.surface.pattern().block_matrix();
        for (const auto &part : parts)
          {
            const Shell::Energy e = shell.energy(example.x, part);
            energy.membrane += e.membrane;
            energy.bending += e.bending;
            force += shell.force(example.x, part);
            shell.force_and_tangent(example.x, part, g, part_K);
            tangent_force += g;
            sum.coeffs() += part_K.coeffs();
          }
        shell.force_and_tangent(example.x, f, K);
        EXPECT_NEAR(total(energy), total(shell.energy(example.x)), 1e-13 * total(energy));
        EXPECT_LT((force - f).norm(), 1e-13 * f.norm());
        EXPECT_LT((tangent_force - f).norm(), 1e-13 * f.norm());
        EXPECT_LT((sum.coeffs() - K.coeffs()).matrix().norm(), 1e-13 * K.norm());
        EXPECT_GT((g - f).norm(), 0.1 * f.norm());
      }
  }

  TEST(Shell, RigidMotionsCostNothing)
  {
    const Example  example;
    const Matrix3d turn  = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    const auto     moved = [&](const ControlPoints &x) -> ControlPoints { return (x * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2); };
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      for (const auto &[name, parameters] : combinations(form))
        {
          const Shell         shell  = example.shell(parameters);
          const double        energy = total(shell.energy(example.x));
          const ControlPoints f      = shell.force(example.x);
          EXPECT_NEAR(total(shell.energy(moved(example.x))), energy, 1e-13 * energy) << name;
          EXPECT_LT((shell.force(moved(example.x)) - f * turn.transpose()).norm(), 1e-12 * f.norm()) << name;
          // the reference turned: no membrane force, and no bending force about the initial curvature
          const bool          unbent      = parameters.reference == ReferenceCurvature::initial;
          const Shell         stress_free = example.shell(parameters, {1., unbent ? 0.3 : 0.});
          const ControlPoints g           = stress_free.force(moved(example.capsule.control_points));
          EXPECT_LT(g.norm(), 1e-12 * f.norm()) << name;
          EXPECT_NEAR(total(stress_free.energy(moved(example.capsule.control_points))), 0., 1e-14) << name;
        }
  }

  TEST(Shell, ForceAndTorqueVanish)
  {
    const Example example;
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      for (const auto &[name, parameters] : combinations(form))
        {
          const ControlPoints f      = example.shell(parameters).force(example.x);
          Vector3d            torque = Vector3d::Zero();
          for (Eigen::Index i = 0; i < f.rows(); ++i)
            torque += Vector3d(example.x.row(i)).cross(Vector3d(f.row(i)));
          const double scale = f.rowwise().norm().sum();
          EXPECT_LT(f.colwise().sum().norm(), 1e-12 * scale) << name;
          EXPECT_LT(torque.norm(), 1e-12 * scale) << name;
        }
  }

  TEST(Shell, SaysWhenASurfaceIsDegenerate)
  {
    const Example example;
    const Shell   shell = example.shell({});
    ControlPoints x     = ControlPoints::Zero(42, 3), f;
    SparseMatrix  K;
    EXPECT_THROW(shell.force(x), NumericalError);
    EXPECT_THROW(shell.energy(x), NumericalError);
    EXPECT_THROW(shell.force_and_tangent(x, f, K), NumericalError);
    x       = example.x;
    x(3, 1) = std::nan("");
    EXPECT_THROW(shell.force(x), NumericalError);
    EXPECT_THROW(Shell(example.surface, {}, {1., 0.}, ControlPoints::Zero(42, 3)), NumericalError);
  }

  TEST(Shell, RefusesWrongInput)
  {
    const Example example;
    EXPECT_THROW(example.shell({}, {-1., 0.}), InputError);
    EXPECT_THROW(example.shell({}, {1., std::nan("")}), InputError);
    const SubdivisionSurface first(example.capsule.topology, triangle_quadrature(3), Derivatives::first);
    EXPECT_NO_THROW(Shell(first, {}, {1., 0.}, example.capsule.control_points).force(example.x));
    EXPECT_THROW(Shell(first, {}, {1., 0.1}, example.capsule.control_points), std::logic_error);
  }
} // namespace
