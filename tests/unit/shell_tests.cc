// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the shell layer.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/helfrich.h>
#include <tanktread/shell/neo_hookean.h>
#include <tanktread/shell/shell.h>
#include <tanktread/shell/skalak.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/face_partition.h>
#include <tanktread/surface/surface_geometry.h>

#include <deal.II/base/parameter_handler.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

namespace
{
  using namespace tanktread;
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  using Eigen::VectorXd;

  ControlPoints
  random_field(const Eigen::Index n, const double size, const unsigned int seed)
  {
    std::mt19937                           engine(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return ControlPoints::NullaryExpr(n, 3, [&]() { return uniform(engine); });
  }

  Eigen::Map<const VectorXd>
  flat(const ControlPoints &x)
  {
    return {x.data(), x.size()};
  }

  double
  total(const Shell::Energy &energy)
  {
    return energy.membrane + energy.bending;
  }

  double
  order(const double coarse, const double fine)
  {
    return std::log2(std::abs(coarse / fine));
  }

  /** A small capsule: reference is an ellipsoid with 42 control points, the state a random deformation of it. */
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
      shape.inclination = 0.15;
      return shape;
    }

    Shell
    shell(const ShellParameters &parameters, const ShellModuli &moduli = {1., 0.3}) const
    {
      return Shell(surface, parameters, moduli, capsule.control_points);
    }

    FittedShape        capsule;
    SubdivisionSurface surface;
    ControlPoints      x;
  };

  /** Every law with every reference curvature, with the name of the combination. */
  std::vector<std::pair<std::string, ShellParameters>>
  combinations(const BendingForm form)
  {
    std::vector<std::pair<std::string, ShellParameters>> result;
    for (const MembraneLaw law : {MembraneLaw::neo_hookean, MembraneLaw::skalak})
      for (const ReferenceCurvature reference : {ReferenceCurvature::flat, ReferenceCurvature::initial, ReferenceCurvature::value})
        {
          ShellParameters parameters;
          parameters.law                       = law;
          parameters.area_dilatation           = 3.;
          parameters.reference                 = reference;
          parameters.reference_curvature_value = -0.7;
          parameters.form                      = form;
          result.emplace_back("law " + std::to_string(int(law)) + ", reference " + std::to_string(int(reference)) + ", form " + std::to_string(int(form)),
                              parameters);
        }
    return result;
  }

  // ------------------------------------------------------------------------------------------------------------- pointwise laws

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

  // ------------------------------------------------------------------------------------------------------------ forces and tangent

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

  // --------------------------------------------------------------------------------------------------------------- bending spheres

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

  // -------------------------------------------------------------------------------------------------------- errors and parameters

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
    prm.parse_input_from_string("subsection Capsule\nset Membrane law = Skalak\nset Area dilatation number = 20\nset Reference curvature = value\n"
                                "set Reference curvature value = -0.5\nset Bending form = moment-only\nset Thickness = 0\nend\n");
    EXPECT_EQ(parameters.law, MembraneLaw::skalak);
    EXPECT_EQ(parameters.area_dilatation, 20.);
    EXPECT_EQ(parameters.reference, ReferenceCurvature::value);
    EXPECT_EQ(parameters.reference_curvature_value, -0.5);
    EXPECT_EQ(parameters.form, BendingForm::moment_only);
    EXPECT_NO_THROW(parameters.check());
    parameters.area_dilatation = -0.5;
    EXPECT_THROW(parameters.check(), InputError);
  }

  // ------------------------------------------------------------------------------------------------------------------------- speed

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
