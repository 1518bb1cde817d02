// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the bending of spheres, and how fast a shell is.

#include <tanktread/surface/surface_geometry.h>

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include "shell_examples.h"
#include <cmath>
#include <cstdio>
#include <ctime>

namespace
{
  using namespace tanktread;
  using Eigen::Matrix3d;
  using Eigen::Vector3d;

  TEST(Shell, WillmoreEnergyOfASphereConverges)
  {
    // The rule with 12 points: with 3, errors of the rule and of the shape happen to cancel.
    double error[5], shifted[5];
    for (unsigned int level = 2; level < 5; ++level)
      {
        const FittedShape        capsule = make_capsule({}, level);
        const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12), Derivatives::second);
        ShellParameters          parameters;
        const double             R = 1.7; // does not matter without reference curvature
        error[level]               = Shell(surface, parameters, {0., 1.}, capsule.control_points).energy(R * capsule.control_points).bending / (8. * M_PI) - 1.;
        parameters.reference       = ReferenceCurvature::value;
        parameters.reference_curvature_value = -0.4;
        shifted[level] = Shell(surface, parameters, {0., 1.}, capsule.control_points).energy(capsule.control_points).bending / (8. * M_PI * 0.36) - 1.;
      }
    for (const double *e : {error, shifted})
      {
        std::printf("bending energy of a sphere, kappa^R = %g, relative error: %.2e %.2e %.2e (orders %.2f %.2f)\n",
                    e == error ? 0. : -0.4,
                    e[2],
                    e[3],
                    e[4],
                    order(e[2], e[3]),
                    order(e[3], e[4]));
        EXPECT_LT(std::abs(e[4]), 1e-5);
        EXPECT_GT(order(e[3], e[4]), 1.8);
      }
  }

  /** Virtual work of nodal forces on a smooth normal displacement of the unit sphere. */
  double
  work_on_smooth_field(const ControlPoints &x, const ControlPoints &f)
  {
    double work = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      {
        const Vector3d n = x.row(i).normalized();
        work += (n[0] * n[0] - 1.3 * n[2] * n[2] + n[0] * n[1] * n[2] + n[0] * n[0] * n[0]) * n.dot(f.row(i));
      }
    return work;
  }

  TEST(Shell, BendingForceOnASphereVanishes)
  {
    // Nodal forces are functionals: they vanish on smooth displacements. As a density they do not, because of the curvature at extraordinary vertices.
    double work[6];
    for (unsigned int level = 2; level < 6; ++level)
      {
        const FittedShape        capsule = make_capsule({}, level);
        const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
        work[level] = work_on_smooth_field(capsule.control_points, Shell(surface, {}, {0., 1.}, capsule.control_points).force(capsule.control_points));
      }
    std::printf("work of the variational bending force of a sphere on a smooth displacement: %.2e %.2e %.2e %.2e (orders %.2f %.2f %.2f)\n",
                work[2],
                work[3],
                work[4],
                work[5],
                order(work[2], work[3]),
                order(work[3], work[4]),
                order(work[4], work[5]));
    EXPECT_LT(std::abs(work[4]), 1e-4);
    EXPECT_GT(order(work[3], work[4]), 1.9);
    EXPECT_GT(order(work[4], work[5]), 1.9);
  }

  TEST(Shell, BendingForcesOfASphereMatchTheory)
  {
    // With kappa^R = k the variational force density is -4 kappa_B m k kappa_m n, m = kappa_m - k (theory, eq. 17); by (16) the moments do the work
    // 2 kappa_B m a^{alpha beta} delta kappa_{alpha beta} = -4 kappa_B m per area on a uniform radial growth of the unit sphere, delta kappa = -a.
    const FittedShape        capsule = make_capsule({}, 4);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    const ControlPoints     &x = capsule.control_points;
    for (const double k : {0., -0.4, 0.6})
      {
        const double    m = -1. - k;
        ShellParameters parameters;
        parameters.reference                 = ReferenceCurvature::value;
        parameters.reference_curvature_value = k;
        const ControlPoints f                = Shell(surface, parameters, {0., 1.}, x).force(x);
        parameters.form                      = BendingForm::moment_only;
        const ControlPoints g                = Shell(surface, parameters, {0., 1.}, x).force(x);
        EXPECT_NEAR(f.cwiseProduct(x).sum() / (4. * M_PI), 4. * m * k, 1e-4 * 4.);
        EXPECT_NEAR(g.cwiseProduct(x).sum() / (4. * M_PI), 4. * m, 1e-4 * 4.);
      }
  }

  TEST(Shell, InitialCurvatureOfASphereIsANumber)
  {
    // Reference 'initial' of a unit sphere beside 'value' -1, on the sphere stretched to an ellipsoid; beside 'flat' as a scale.
    const FittedShape        capsule = make_capsule({}, 3);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    const ControlPoints      x = capsule.control_points * Vector3d(1.2, 1., 0.9).asDiagonal();
    for (const BendingForm form : {BendingForm::variational, BendingForm::moment_only})
      {
        ShellParameters parameters;
        parameters.form                      = form;
        parameters.reference_curvature_value = -1.;
        const auto bending                   = [&](const ReferenceCurvature reference) {
          parameters.reference = reference;
          const Shell shell(surface, parameters, {0., 1.}, capsule.control_points);
          return std::make_pair(shell.energy(x).bending, work_on_smooth_field(x, shell.force(x)));
        };
        const auto flat = bending(ReferenceCurvature::flat), initial = bending(ReferenceCurvature::initial), value = bending(ReferenceCurvature::value);
        std::printf("reference curvature flat, initial, value -1, form %d: energy %.5f %.5f %.5f, work on a smooth displacement %.5f %.5f %.5f\n",
                    int(form),
                    flat.first,
                    initial.first,
                    value.first,
                    flat.second,
                    initial.second,
                    value.second);
        EXPECT_NEAR(initial.first, value.first, 1e-3 * std::abs(flat.first));
        EXPECT_NEAR(initial.second, value.second, 1e-3 * std::abs(flat.second));
        EXPECT_GT(std::abs(flat.first - value.first), 0.1 * std::abs(flat.first));
        EXPECT_GT(std::abs(flat.second - value.second), 0.1 * std::abs(flat.second));
      }
  }

  /** Milliseconds of this process's CPU time, the best of five calls: what others compute meanwhile does not count. */
  template <typename Work>
  double
  cpu_ms(const Work &work)
  {
    double shortest = 1e9;
    for (unsigned int i = 0; i < 5; ++i)
      {
        const std::clock_t start = std::clock();
        work();
        shortest = std::min(shortest, 1e3 * double(std::clock() - start) / CLOCKS_PER_SEC);
      }
    return shortest;
  }

  /** Milliseconds for the eigenvalues and vectors of n symmetric 3x3 matrices by Eigen: the measure of a processor. */
  double
  eigen_ms(const Eigen::Index n)
  {
    double       sum    = 0.;
    const double result = cpu_ms([&]() {
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const Matrix3d a =
            Vector3d(1., 0.3, -0.2) * Vector3d(1., 0.3, -0.2).transpose() + Vector3d(0.1, 0.5, 1e-3 * double(i % 100)).asDiagonal().toDenseMatrix();
          sum += Eigen::SelfAdjointEigenSolver<Matrix3d>(a).eigenvectors()(0, 0);
        }
    });
    EXPECT_TRUE(std::isfinite(sum));
    return result;
  }

  // In eigenvectors of a 3x3 matrix at every point of the quadrature the force costs at most 1.3, the tangent 9.5; about three times as much is allowed.
  TEST(Shell, IsFast)
  {
    const FittedShape        capsule = make_capsule({}, 4);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    const ControlPoints      x       = capsule.control_points + random_field(capsule.control_points.rows(), 1e-3, 1);
    const double             unit_ms = eigen_ms(15360);
    struct Case
    {
      const char *name;
      double      bending_modulus, thickness;
      BendingForm form;
    };
    for (const Case &c : {Case{"membrane only", 0., 0., BendingForm::variational},
                          Case{"bending, variational", 0.1, 0., BendingForm::variational},
                          Case{"bending, moment-only", 0.1, 0., BendingForm::moment_only},
                          Case{"finite thickness", 0., 0.05, BendingForm::variational},
                          Case{"finite thickness and bending, variational", 0.1, 0.05, BendingForm::variational}})
      {
        ShellParameters parameters;
        parameters.form      = c.form;
        parameters.thickness = c.thickness;
        const Shell   shell(surface, parameters, {1., c.bending_modulus}, capsule.control_points);
        ControlPoints f;
        SparseMatrix  K;
        const double  energy_ms = cpu_ms([&]() { shell.energy(x); }), force_ms = cpu_ms([&]() { f = shell.force(x); });
        const double  tangent_ms = cpu_ms([&]() { shell.force_and_tangent(x, f, K); });
        std::printf("2562 control points, 15360 points, %s: energy %.2f ms, force %.2f ms, force and tangent %.1f ms; eigenvectors %.2f ms\n",
                    c.name,
                    energy_ms,
                    force_ms,
                    tangent_ms,
                    unit_ms);
#ifdef NDEBUG
        EXPECT_LT(force_ms, 4. * unit_ms);
        EXPECT_LT(tangent_ms, 30. * unit_ms);
#endif
      }
  }
} // namespace
