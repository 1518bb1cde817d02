// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of shells whose stress-free shape is not the initial one.

#include <tanktread/surface/surface_geometry.h>

#include <gtest/gtest.h>

#include <cmath>

#include "shell_examples.h"

namespace
{
  using namespace tanktread;

  TEST(RestState, AnInflatedCapsuleIsUnderTheTensionOfItsStretch)
  {
    // Stretched by l = 1 + alpha_p in all directions, a membrane has an isotropic tension T per current length, theory (20g): it pulls like a soap film, with
    // any work
    // -f . dx = T dA, whatever the shape. Balanced by a pressure jump it is at rest if it is a sphere: 3 pi V = -f . x = 2 T A.
    CapsuleShapeParameters shape;
    shape.prestress = 0.05;
    ShellParameters parameters;
    parameters.area_dilatation = 3.;
    const double G_s = 1. / 3., l_2 = 1.05 * 1.05, h = 1e-4;
    for (const Shape kind : {Shape::sphere, Shape::biconcave})
      for (const MembraneLaw law : {MembraneLaw::neo_hookean, MembraneLaw::skalak})
        {
          shape.shape                      = kind;
          parameters.law                   = law;
          const double             T       = G_s * (law == MembraneLaw::skalak ? l_2 - 1. + 3. * l_2 * (l_2 * l_2 - 1.) : 1. - std::pow(l_2, -3.));
          const FittedShape        capsule = make_capsule(shape, 2);
          const ControlPoints     &x       = capsule.control_points;
          const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::first);
          const Shell              shell(surface, parameters, {1., 0.}, make_stress_free_shape(shape, capsule), x);
          const ControlPoints      f = shell.force(x);
          EXPECT_NEAR(-f.cwiseProduct(x).sum(), 2. * T * surface_area(surface, x), 1e-12);
          const ControlPoints dx          = random_field(x.rows(), 1., 40);
          const auto          area        = [&](const double t) { return surface_area(surface, x + t * dx); };
          const double        area_change = (8. * (area(h) - area(-h)) - (area(2. * h) - area(-2. * h))) / (12. * h);
          EXPECT_NEAR(-f.cwiseProduct(dx).sum(), T * area_change, 1e-8);
          if (kind == Shape::sphere)
            {
              EXPECT_NEAR(-f.cwiseProduct(x).sum() / (3. * enclosed_volume(surface, x)), 2. * T, 1e-3 * T);
            }
        }
  }

  TEST(RestState, EnergyVanishesInTheStressFreeShapeAlone)
  {
    CapsuleShapeParameters shape;
    shape.shape                      = Shape::biconcave;
    shape.stress_free                = StressFreeShape::oblate;
    const FittedShape        capsule = make_capsule(shape, 2);
    const ControlPoints      x       = make_stress_free_shape(shape, capsule);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    ShellParameters          parameters;
    for (const MembraneLaw law : {MembraneLaw::neo_hookean, MembraneLaw::skalak})
      for (const double thickness : {0., 0.05})
        {
          parameters.law       = law;
          parameters.thickness = law == MembraneLaw::skalak ? 0. : thickness;
          const Shell shell(surface, parameters, {1., 0.}, x, capsule.control_points);
          EXPECT_NEAR(shell.energy(x).membrane, 0., 1e-14);
          EXPECT_LT(shell.force(x).norm(), 1e-13);
          EXPECT_GT(shell.energy(capsule.control_points).membrane, 0.1);
          EXPECT_GT(shell.force(capsule.control_points).norm(), 1e-2);
          EXPECT_NEAR(shell.reference_weights().sum(), surface_area(surface, x), 1e-12);
        }
  }

  TEST(RestState, InitialCurvatureIsThatOfTheInitialShape)
  {
    CapsuleShapeParameters shape;
    shape.shape                      = Shape::biconcave;
    shape.stress_free                = StressFreeShape::sphere;
    shape.prestress                  = 0.1;
    const FittedShape        capsule = make_capsule(shape, 2);
    const ControlPoints      rest    = make_stress_free_shape(shape, capsule);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    ShellParameters          parameters;
    parameters.reference = ReferenceCurvature::initial;
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      {
        parameters.form = form;
        const Shell shell(surface, parameters, {0., 1.}, rest, capsule.control_points);
        EXPECT_NEAR(shell.energy(capsule.control_points).bending, 0., 1e-14);
        EXPECT_LT(shell.force(capsule.control_points).norm(), 1e-12);
        EXPECT_GT(shell.energy(rest).bending, 1.);
        const Shell without_initial(surface, parameters, {0., 1.}, rest);
        EXPECT_NEAR(without_initial.energy(rest).bending, 0., 1e-14);
      }
  }

  TEST(RestState, ForcesAndTangentAreDerivativesOfTheEnergy)
  {
    CapsuleShapeParameters shape = Example::ellipsoid();
    shape.stress_free            = StressFreeShape::oblate;
    shape.prestress              = 0.1;
    const Example       example;
    const ControlPoints rest = make_stress_free_shape(shape, example.capsule), dx = random_field(42, 1., 10);
    const double        h = 1e-4;
    for (const auto &[name, parameters] : combinations(BendingForm::variational))
      {
        const Shell   shell(example.surface, parameters, {1., 0.3}, rest, example.capsule.control_points);
        ControlPoints f;
        SparseMatrix  K;
        shell.force_and_tangent(example.x, f, K);
        const auto   E     = [&](const double t) { return total(shell.energy(example.x + t * dx)); };
        const double slope = (8. * (E(h) - E(-h)) - (E(2. * h) - E(-2. * h))) / (12. * h);
        EXPECT_NEAR(slope, -f.cwiseProduct(dx).sum(), 1e-8 * f.norm() * dx.norm()) << name;
        const auto          force  = [&](const double t) { return shell.force(example.x + t * dx); };
        const ControlPoints change = (8. * (force(h) - force(-h)) - (force(2. * h) - force(-2. * h))) / (12. * h);
        EXPECT_LT((K * flat(dx) + flat(change)).norm(), 1e-8 * change.norm()) << name;
        // Another shell than the one that is free of stress in the initial shape.
        EXPECT_GT((example.shell(parameters).force(example.x) - f).norm(), 0.1 * f.norm()) << name;
      }
  }
} // namespace
