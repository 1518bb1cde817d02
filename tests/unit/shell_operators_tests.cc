// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about what the solver makes of the shells: forces and unknowns over the ranks, factors, the implicit operators, the
// motion in a step.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/surface/surface_operators.h>

#include "small_scene.h"

#include <cmath>
#include <iostream>

using namespace tanktread;

namespace
{
  SparseMatrix
  random_blocks(const SubdivisionSurface &surface, const double size)
  {
    SparseMatrix matrix = surface.pattern().block_matrix();
    for (Eigen::Index k = 0; k < matrix.nonZeros(); ++k)
      matrix.valuePtr()[k] = size * std::sin(1000. * k);
    return matrix;
  }

  ControlPoints
  smooth_field(const ControlPoints &x)
  {
    ControlPoints result(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      result.row(i) << std::sin(2. * x(i, 1)), std::cos(x(i, 2)), std::sin(x(i, 0) + x(i, 2));
    return result;
  }
} // namespace


TEST(DistributedShell, SumsTheFacesOfAllRanks)
{
  StartedScene scene(small_scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-8, 1e-8)));
  scene.x().col(0) += 0.1 * scene.x().col(2);
  const DistributedShell &shell   = scene.elasticity();
  const Shell            &serial  = scene.capsule().shell();
  const unsigned int      n_faces = shell.faces(0).size();
  EXPECT_EQ(dealii::Utilities::MPI::sum(n_faces, MPI_COMM_WORLD), scene.capsule().surface().n_faces());
  const Shell::Energy e = shell.energies({scene.x()})[0], serial_e = serial.energy(scene.x());
  EXPECT_NEAR(e.membrane, serial_e.membrane, 1e-13 * serial_e.membrane);
  EXPECT_NEAR(e.bending, serial_e.bending, 1e-13 * serial_e.bending);
  ShellFields               f;
  std::vector<SparseMatrix> K;
  ControlPoints             serial_f;
  SparseMatrix              serial_K;
  for (unsigned int again = 0; again < 2; ++again) // the second time with a matrix that has the pattern
    {
      shell.forces_and_tangents({scene.x()}, f, K);
      serial.force_and_tangent(scene.x(), serial_f, serial_K);
      EXPECT_LT((f[0] - serial_f).norm(), 1e-13 * serial_f.norm());
      EXPECT_LT((shell.forces({scene.x()})[0] - serial_f).norm(), 1e-13 * serial_f.norm());
      EXPECT_LT((K[0].coeffs() - serial_K.coeffs()).matrix().norm(), 1e-13 * serial_K.norm());
    }
}


TEST(DistributedShell, FailsOnAllRanksAlike)
{
  StartedScene scene(small_scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8)));
  scene.x()(3, 1) = std::nan(""); // in the faces of some ranks only
  EXPECT_THROW(scene.elasticity().forces({scene.x()}), NumericalError);
  EXPECT_THROW(scene.elasticity().energies({scene.x()}), NumericalError);
  EXPECT_THROW(scene.elasticity().tangents({scene.x()}), NumericalError);
}


namespace
{
  /** Spheres of 12 and 42 control points, one after the other. */
  Capsules
  two_kinds(const unsigned int n_capsules)
  {
    const CapsuleQuadrature                     rule{triangle_quadrature(3), triangle_quadrature(3)};
    std::vector<std::unique_ptr<const Capsule>> kinds;
    std::vector<unsigned int>                   kind_of;
    for (const unsigned int level : {0u, 1u})
      kinds.push_back(std::make_unique<Capsule>(make_capsule({}, level), rule, ShellParameters(), ShellModuli{1., 0.}));
    for (unsigned int c = 0; c < n_capsules; ++c)
      kind_of.push_back(c % 2);
    return {std::move(kinds), kind_of};
  }
} // namespace


TEST(ShellLayout, UnknownsOfACapsuleComeBackToItsTeam)
{
  StartedScene scene(small_scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8)));
  for (const unsigned int n_capsules : {1u, 2u, 5u})
    for (const unsigned int n_teams : {0u, 1u})
      {
        const Capsules     capsules = two_kinds(n_capsules);
        ShellLayout        layout(capsules, MPI_COMM_WORLD, n_teams);
        const unsigned int teams = layout.n_teams();
        EXPECT_EQ(teams, n_teams == 1 ? 1u : std::min(n_capsules, layout.n_ranks()));
        for (unsigned int turn = 0; turn < 2; ++turn)
          {
            if (turn == 1) // all capsules go to the next team
              {
                std::vector<unsigned int> team_of;
                for (unsigned int c = 0; c < n_capsules; ++c)
                  team_of.push_back((layout.team_of(c) + 1) % teams);
                layout.assign(team_of);
              }
            EXPECT_EQ(layout.sum(layout.n_own()), n_capsules);
            FluidBlockVector vector = layout.vector(scene.fluid().space());
            EXPECT_EQ(vector.block(shell_block).size(), n_capsules + 3 * capsules.n_control_points());
            const auto force = [&](const unsigned int c) -> ControlPoints {
              return ControlPoints::Constant(capsules[c].n_control_points(), 3, 0.5 * c) + ControlPoints::Identity(capsules[c].n_control_points(), 3);
            };
            for (unsigned int i = 0; i < layout.n_own(); ++i)
              layout.set(vector, i, 10. + layout.own()[i], force(layout.own()[i]));
            const std::vector<ShellUnknowns> unknowns = layout.unknowns(vector);
            ASSERT_EQ(unknowns.size(), layout.n_own());
            std::vector<double> numbers;
            for (unsigned int i = 0; i < layout.n_own(); ++i)
              {
                const unsigned int c = layout.own()[i];
                EXPECT_EQ(layout.team_of(c), layout.team_of_rank(layout.rank()));
                EXPECT_EQ(unknowns[i].pressure_jump, 10. + c);
                EXPECT_EQ(unknowns[i].density, force(c));
                numbers.insert(numbers.end(), {double(c), 0.5 * c});
              }
            const std::vector<double> all = layout.gathered(numbers, 2);
            for (unsigned int c = 0; c < n_capsules; ++c)
              {
                EXPECT_EQ(all[2 * c], c);
                EXPECT_EQ(all[2 * c + 1], 0.5 * c);
              }
          }
      }
}


TEST(BlockFactorisation, Solves)
{
  StartedScene              scene(small_scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8)));
  const SubdivisionSurface &surface = scene.capsule().surface();
  BlockFactorisation        factors;
  SparseMatrix              matrix = random_blocks(surface, 1.);
  for (const double shift : {20., 0.5}) // dominated by the diagonal, and not
    {
      matrix += SparseMatrix(shift * Eigen::VectorXd::Ones(matrix.rows()).asDiagonal().toDenseMatrix().sparseView());
      const Eigen::VectorXd b = flat(smooth_field(scene.x())), x = factors.solve((factors.factorise(matrix, "It"), b));
      EXPECT_LT((matrix * x - b).norm(), 1e-9 * b.norm());
    }
  try
    {
      factors.factorise(surface.pattern().block_matrix(), "It");
      ADD_FAILURE();
    }
  catch (const NumericalError &error)
    {
      EXPECT_STREQ(error.what(), "It is singular.");
    }
}


TEST(ImplicitShells, AreKeptWhileTheyServe)
{
  StartedScene        scene(without_coarser_control_meshes(small_scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8))));
  const ShellLayout  &layout = scene.layout();
  SolverMemory        memory;
  ImplicitShells      implicit_shells(layout, memory);
  const SparseMatrix &Z = scene.capsule().mass();
  const SparseMatrix  K = random_blocks(scene.capsule().surface(), 1e-3);
  EXPECT_FALSE(implicit_shells.serves(0.1));
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  g(0, 2)           = 3.;
  implicit_shells.renew({implicit_operator(Z, K, g, 0.1)}, 0.1);
  for (const auto &[tau, serves] : {std::pair<double, bool>{0.1, true}, {0.149, true}, {0.151, false}, {0.067, true}, {0.066, false}})
    EXPECT_EQ(implicit_shells.serves(tau), serves) << tau;

  // Z_tau (Z_tau + tau K)^{-1} with Z_tau = Z (1 - tau g), on the rank that owns the capsule
  const ControlPoints force = smooth_field(scene.x()), velocity = implicit_shells.velocity(0, force);
  if (layout.leads())
    {
      const ControlPoints resistance = Z * velocity * (Eigen::Matrix3d::Identity() - 0.1 * g).transpose();
      EXPECT_LT((resistance + nodal(0.1 * (K * flat(velocity))) - force).norm(), 1e-12 * force.norm());
      EXPECT_LT((implicit_shells.damped(0, force) - resistance).norm(), 1e-12 * force.norm());
    }
  else
    {
      EXPECT_EQ(velocity.norm() + implicit_shells.damped(0, force).norm(), 0.);
    }

  implicit_shells.watch({true, 10, 1., 1e-2});
  implicit_shells.watch({true, 24, 1., 1e-4}); // 22 + 1 allowed, but 5 a decade
  EXPECT_FALSE(implicit_shells.serves(0.1));
  implicit_shells.renew({implicit_operator(Z, K, g, 0.1)}, 0.1);
  implicit_shells.watch({true, 10, 1., 1e-2});
  implicit_shells.watch({true, 22, 1., 1e-4});
  EXPECT_TRUE(implicit_shells.serves(0.1));
  implicit_shells.discard();
  EXPECT_FALSE(implicit_shells.serves(0.1));
  EXPECT_EQ(implicit_shells.n_renewals(), 2u);

  SparseMatrix minus_Z = scene.capsule().surface().pattern().block_matrix();
  add_for_three_components(Z, minus_Z);
  minus_Z *= -1.;
  EXPECT_THROW(implicit_shells.renew({implicit_operator(Z, minus_Z, Eigen::Matrix3d::Zero(), 1.)}, 1.), NumericalError);
  EXPECT_FALSE(implicit_shells.serves(1.));
}


TEST(ImplicitShells, AreFactorsWhereAVCycleDoesNotConverge)
{
  StartedScene        scene(small_scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8)));
  const ShellLayout  &layout = scene.layout();
  SolverMemory        memory;
  ImplicitShells      implicit_shells(layout, memory);
  const SparseMatrix &Z      = scene.capsule().mass();
  const auto          defect = [&](const SparseMatrix &K) { // of S^{-1}
    const ControlPoints force = smooth_field(scene.x()), velocity = implicit_shells.velocity(0, force);
    return layout.leads() ? (Z * velocity + nodal(K * flat(velocity)) - force).norm() / force.norm() : 0.;
  };
  const SparseMatrix weak = random_blocks(scene.capsule().surface(), 1e-5);
  implicit_shells.renew({implicit_operator(Z, weak, Eigen::Matrix3d::Zero(), 1.)}, 1.);
  EXPECT_LT(defect(weak), 0.1);
  if (layout.leads())
    {
      EXPECT_GT(defect(weak), 1e-6);
    }
  EXPECT_FALSE(implicit_shells.serves(1.)); // a new one costs little

  // Indefinite: a membrane under pressure from its sides.
  SparseMatrix indefinite = scene.capsule().surface().pattern().block_matrix();
  add_for_three_components(laplace_beltrami(scene.capsule().surface(), scene.x()), indefinite);
  indefinite *= -0.03;
  implicit_shells.renew({implicit_operator(Z, indefinite, Eigen::Matrix3d::Zero(), 1.)}, 1.);
  EXPECT_LT(defect(indefinite), 1e-10);
  EXPECT_TRUE(implicit_shells.serves(1.));
}


TEST(ShellMotion, IsAsAccurateAsWanted)
{
  StartedScene        scene(small_scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8)));
  const ControlPoints f = scene.capsule().mass() * smooth_field(scene.x());
  scene.move_points();
  VelocityGradients gradients(scene.coupling().transfers()[0].n_points(), 9);
  for (Eigen::Index q = 0; q < gradients.rows(); ++q)
    gradients.row(q) << 0.5, 0.3, 1., std::sin(0.1 * q), -0.5, 0.4, 0.2, std::cos(0.1 * q), 0.;
  SparseMatrix gamma;
  gamma = scene.capsule().coupling_surface().pattern().block_matrix();
  scene.coupling().transfers()[0].add_gradient_matrix(gradients, gamma);
  scene.coupling().guests().sum({{gamma.valuePtr(), std::size_t(gamma.nonZeros())}});
  const auto motion_of = [&](const double tau, const double accuracy) {
    MotionTerms terms;
    terms.gradient = tau * gamma;
    terms.drift << 0.1, 0.2, 1., -0.3, 0.2, 0., 0.1, -0.1, -0.3;
    terms.drift *= tau;
    terms.volume_shift   = 0.01 * tau;
    terms.volume_hessian = &scene.level().shells(scene.state)[0]->volume_hessian();
    return ShellMotion(scene.capsule(), std::move(terms), accuracy);
  };
  const ShellMotion exact = motion_of(0.1, 0.);
  EXPECT_EQ(exact.n_terms(), 0u);
  const ControlPoints dx = exact.solve(f);
  EXPECT_LT((exact.times(dx) - f).norm(), 1e-12 * f.norm());
  MotionTerms constant;
  constant.drift << 0.1, 0.2, 1., -0.3, 0.2, 0., 0.1, -0.1, -0.3;
  const ShellMotion in_constant_gradient(scene.capsule(), constant, 0.);
  EXPECT_EQ(in_constant_gradient.n_terms(), 1u);
  EXPECT_LT((in_constant_gradient.times(in_constant_gradient.solve(f)) - f).norm(), 1e-12 * f.norm());

  unsigned int n_terms = 1;
  for (const double accuracy : {1e-2, 1e-4, 1e-6})
    {
      const ShellMotion motion = motion_of(0.1, accuracy);
      EXPECT_GT(motion.n_terms(), n_terms);
      n_terms            = motion.n_terms();
      const double error = (motion.solve(f) - dx).norm() / dx.norm();
      if (is_root())
        std::cout << "accuracy " << accuracy << ": " << n_terms << " terms, error on a smooth field " << error << std::endl;
      EXPECT_LT(error, accuracy);
      EXPECT_LT((motion.solve(2. * f + scene.x()) - 2. * motion.solve(f) - motion.solve(scene.x())).norm(), 1e-13 * dx.norm());
    }
  EXPECT_EQ(motion_of(5., 1e-2).n_terms(), 0u); // the series diverges
}
