// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the membrane laws and of the parameters of a shell.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/neo_hookean.h>
#include <tanktread/shell/skalak.h>
#include <tanktread/surface/surface_geometry.h>

#include <deal.II/base/parameter_handler.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "shell_examples.h"
#include <cmath>

namespace
{
  using namespace tanktread;
  using Eigen::Vector3d;

  TEST(MembraneLaws, MatchTheirFormulasInPrincipalStretches)
  {
    // undeformed metric of skew coordinates, deformed by stretches l1, l2 along turned axes
    Eigen::Matrix2d base;
    base << 1.3, 0.4, -0.2, 0.8;
    const Eigen::Matrix2d undeformed = base.transpose() * base;
    const ReferenceMetric reference(Metric{undeformed(0, 0), undeformed(0, 1), undeformed(1, 1)});
    const double          G_s = 1.7, C = 4.;
    for (const auto &[l1, l2] : {std::pair<double, double>{1., 1.}, {1.3, 0.9}, {0.8, 1.5}})
      {
        const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.6).toRotationMatrix();
        const Eigen::Matrix2d now = turn * Eigen::Vector2d(l1, l2).asDiagonal() * turn.transpose() * base, a = now.transpose() * now;
        const Metric          metric{a(0, 0), a(0, 1), a(1, 1)};
        const double          I1 = l1 * l1 + l2 * l2 - 2., I2 = l1 * l1 * l2 * l2 - 1.;
        EXPECT_NEAR(neo_hookean(metric, reference, G_s).energy, 0.5 * G_s * (I1 - 1. + 1. / (I2 + 1.)), 1e-14);
        EXPECT_NEAR(skalak(metric, reference, G_s, C).energy, 0.25 * G_s * (I1 * I1 + 2. * I1 - 2. * I2 + C * I2 * I2), 1e-14);
      }
  }

  TEST(MembraneLaws, DerivativesMatchDifferences)
  {
    const ReferenceMetric reference(Metric{1.2, 0.3, 0.9});
    const Vector3d        a(1.5, -0.2, 1.1);
    for (const bool is_skalak : {false, true})
      {
        const auto law = [&](const Vector3d &b) {
          const Metric metric{b[0], b[1], b[2]};
          return is_skalak ? skalak(metric, reference, 2., 5.) : neo_hookean(metric, reference, 2.);
        };
        const MembraneDensity w = law(a);
        for (int i = 0; i < 3; ++i)
          {
            const Vector3d        step = 1e-5 * Vector3d::Unit(i);
            const MembraneDensity up = law(a + step), down = law(a - step);
            EXPECT_NEAR((up.energy - down.energy) / 2e-5, w.gradient[i], 1e-8);
            EXPECT_LT(((up.gradient - down.gradient) / 2e-5 - w.hessian.col(i)).norm(), 1e-7);
          }
      }
  }

  TEST(MembraneLaws, UndeformedIsFreeOfStress)
  {
    const Metric metric{1.2, 0.3, 0.9};
    for (const MembraneDensity &w : {neo_hookean(metric, ReferenceMetric(metric), 1.), skalak(metric, ReferenceMetric(metric), 1., 10.)})
      {
        EXPECT_NEAR(w.energy, 0., 1e-15);
        EXPECT_LT(w.gradient.norm(), 1e-15);
      }
  }

  TEST(Shell, TensionOfABlownUpCapsuleIsUniform)
  {
    // Patch test: x = l xbar stretches every direction by l, whatever the shape. With n the uniform tension, E = area w(l), and the radial work
    // -f . x = l dE/dl = 2 n area l^2.
    const Example example;
    const double  l = 1.3, G_s = 1. / 3., C = 3., J = l * l * l * l;
    for (const auto &[name, parameters] : combinations(BendingForm::variational))
      {
        const Shell   shell     = example.shell(parameters, {1., 0.});
        const double  area      = shell.reference_weights().sum();
        const bool    is_skalak = parameters.law == MembraneLaw::skalak;
        const double  I1 = 2. * l * l - 2., I2 = J - 1.;
        const double  w  = is_skalak ? 0.25 * G_s * (I1 * I1 + 2. * I1 - 2. * I2 + C * I2 * I2) : 0.5 * G_s * (2. * l * l + 1. / J - 3.);
        const double  dw = is_skalak ? 0.25 * G_s * ((2. * I1 + 2.) * 4. * l + (2. * C * I2 - 2.) * 4. * l * l * l) : 0.5 * G_s * (4. * l - 4. / (J * l));
        ControlPoints x  = l * example.capsule.control_points;
        EXPECT_NEAR(shell.energy(x).membrane, area * w, 1e-13 * area) << name;
        EXPECT_NEAR(-shell.force(x).cwiseProduct(x).sum(), l * dw * area, 1e-12 * area) << name;
        // The tension is uniform, so the membrane pulls like a soap film: its work on any displacement is tension times change of area.
        const double        tension     = dw / (2. * l); // per current length
        const ControlPoints f           = example.shell(parameters, {1., 0.}).force(x);
        const double        h           = 1e-4;
        const ControlPoints dx          = random_field(42, 1., 40);
        const double        area_change = (8. * (surface_area(example.surface, x + h * dx) - surface_area(example.surface, x - h * dx)) -
                                    (surface_area(example.surface, x + 2. * h * dx) - surface_area(example.surface, x - 2. * h * dx))) /
          (12. * h);
        EXPECT_NEAR(-f.cwiseProduct(dx).sum(), tension * area_change, 1e-8) << name;
      }
  }

  TEST(Shell, MembraneOnFirstDerivativesIsTheSame)
  {
    const Example            example;
    const SubdivisionSurface first(example.capsule.topology, triangle_quadrature(3), Derivatives::first);
    const Shell              lean(first, {}, {1., 0.}, example.capsule.control_points);
    ControlPoints            f, g;
    SparseMatrix             K, L;
    lean.force_and_tangent(example.x, f, K);
    example.shell({}, {1., 0.}).force_and_tangent(example.x, g, L);
    EXPECT_LT((f - g).norm(), 1e-14 * g.norm());
    EXPECT_LT(SparseMatrix(K - L).norm(), 1e-14 * L.norm());
  }

  TEST(Shell, WithoutMembraneThereIsBendingAlone)
  {
    const Example   example;
    ShellParameters parameters;
    const Shell     whole(example.surface, parameters, {3., 0.1}, example.capsule.control_points);
    const Shell     membrane(example.surface, parameters, {3., 0.}, example.capsule.control_points);
    parameters.law = MembraneLaw::none;
    const Shell   bending(example.surface, parameters, {3., 0.1}, example.capsule.control_points);
    ControlPoints f, f_membrane, f_bending;
    SparseMatrix  K, K_membrane, K_bending;
    whole.force_and_tangent(example.x, f, K);
    membrane.force_and_tangent(example.x, f_membrane, K_membrane);
    bending.force_and_tangent(example.x, f_bending, K_bending);
    EXPECT_EQ(bending.energy(example.x).membrane, 0.);
    EXPECT_DOUBLE_EQ(bending.energy(example.x).bending, whole.energy(example.x).bending);
    EXPECT_LT((f_bending - (f - f_membrane)).norm(), 1e-12 * f.norm());
    EXPECT_LT((K_bending - (K - K_membrane)).norm(), 1e-12 * K.norm());
    EXPECT_GT(f_bending.norm(), 1e-3);
  }


  TEST(ShellParameters, AreParsedAndChecked)
  {
    ShellParameters          parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    prm.parse_input_from_string("set Membrane law = Skalak\nset Area dilatation number = 20\nset Reference curvature = value\n"
                                "set Reference curvature value = -0.5\nset Bending form = moment-only\nset Thickness = 0\n");
    EXPECT_EQ(parameters.law, MembraneLaw::skalak);
    EXPECT_EQ(parameters.area_dilatation, 20.);
    EXPECT_EQ(parameters.reference, ReferenceCurvature::value);
    EXPECT_EQ(parameters.reference_curvature_value, -0.5);
    EXPECT_EQ(parameters.form, BendingForm::moment_only);
    EXPECT_NO_THROW(parameters.check());
    parameters.area_dilatation = -0.5;
    EXPECT_THROW(parameters.check(), InputError);
  }
} // namespace
