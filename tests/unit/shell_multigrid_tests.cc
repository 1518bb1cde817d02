// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: matrices of the shell on Loop's control meshes, and the V-cycle made of them.

#include <deal.II/base/mpi.h>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <tanktread/shell/capsule.h>
#include <tanktread/solver/block_factorisation.h>
#include <tanktread/solver/shell_multigrid.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <iostream>
#include <set>
#include <tuple>

using namespace tanktread;

namespace
{
  int
  n_ranks()
  {
    return int(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
  }
  int
  rank()
  {
    return int(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  }

  Capsule
  capsule(const unsigned int level)
  {
    return {make_capsule({}, level), {triangle_quadrature(3), triangle_quadrature(3)}, {}, {1., 1.}};
  }

  struct Stiffness
  {
    double stretching, bending; // tau E_s/(mu a) and tau kappa_B/(mu a^3)
  };

  /** S of LinearisedShell at the control points x, with some shear in the drift. */
  SparseMatrix
  implicit_matrix(const Capsule &capsule, const ControlPoints &x, const Stiffness &stiffness, const Tangent tangent)
  {
    const SubdivisionSurface &surface = capsule.surface();
    const Shell               shell(surface, {}, {stiffness.stretching, stiffness.bending}, capsule.initial());
    ControlPoints             force;
    SparseMatrix              S;
    shell.force_and_tangent(x, force, S, tangent);
    const double k1 = 2., k2 = 10. * std::sqrt(double(capsule.n_control_points()) / 642.) * 2.;
    SparseMatrix Z = mass_matrix(surface, 4. * k1 * k2 / (k1 + k2) * area_weights(surface, x));
    Z.coeffs() += 4. / (k1 + k2) * laplace_beltrami(surface, x).coeffs();
    Eigen::Matrix3d drift = Eigen::Matrix3d::Identity();
    drift(0, 2)           = -0.1;
    add_for_three_components(Z, S, drift);
    return S;
  }

  /** A matrix of full blocks as a dense one, by the places of a hierarchy's finest level. */
  Eigen::MatrixXd
  dense_in_order(const SparseMatrix &matrix, const std::vector<int> &order)
  {
    const Eigen::MatrixXd dense = matrix;
    Eigen::MatrixXd       result(dense.rows(), dense.cols());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = 0; j < order.size(); ++j)
        result.block(3 * i, 3 * j, 3, 3) = dense.block(3 * order[i], 3 * order[j], 3, 3);
    return result;
  }

  Eigen::MatrixXd
  dense(const BlockPattern &pattern, const std::vector<double> &values)
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * pattern.n_rows(), 3 * pattern.n_rows());
    for (int i = 0; i < pattern.n_rows(); ++i)
      for (int k = 0; k < pattern.length(i); ++k)
        for (int c = 0; c < 3; ++c)
          for (int d = 0; d < 3; ++d)
            result(3 * i + c, 3 * pattern.columns[pattern.starts[i] + k] + d) = values[pattern.value_starts[i] + 3 * (c * pattern.length(i) + k) + d];
    return result;
  }

  PaddedField
  some_field(const int n)
  {
    PaddedField result(4 * n, 0.);
    for (int i = 0; i < 4 * n; ++i)
      result[i] = i % 4 == 3 ? 0. : std::sin(1. + i * i);
    return result;
  }

  Eigen::VectorXd
  without_padding(const PaddedField &field)
  {
    Eigen::VectorXd result(field.size() / 4 * 3);
    for (Eigen::Index i = 0; i < result.size(); ++i)
      result[i] = field[4 * (i / 3) + i % 3];
    return result;
  }

  ControlPoints
  some_forces(const Eigen::Index n)
  {
    return ControlPoints::NullaryExpr(n, 3, [](const Eigen::Index i, const Eigen::Index c) { return std::sin(1. + 3. * i + c * c); });
  }
} // namespace


TEST(LoopHierarchy, GoesDownToTheFirstMesh)
{
  const Capsule       example = capsule(4);
  const LoopHierarchy hierarchy(example.topology(), example.surface().pattern(), n_ranks(), rank());
  ASSERT_EQ(hierarchy.levels().size(), 4u);
  EXPECT_TRUE(hierarchy.ends_coarse());
  for (std::size_t l = 0; l < 4; ++l)
    {
      const LoopLevel &level = hierarchy.levels()[l];
      EXPECT_EQ(level.n, 10 * (1 << (2 * (4 - l))) + 2);
      const int n_own = dealii::Utilities::MPI::sum(level.end - level.begin, MPI_COMM_WORLD);
      EXPECT_EQ(n_own, level.n * (level.is_divided ? 1 : n_ranks()));
      EXPECT_EQ(level.is_divided, n_ranks() > 1 && level.n >= 300 * n_ranks());
    }
}


TEST(GalerkinProduct, IsThatOfTheMatrices)
{
  const Capsule         example = capsule(2);
  const LoopHierarchy   hierarchy(example.topology(), example.surface().pattern(), 1, 0);
  const SparseMatrix    S     = implicit_matrix(example, example.initial(), {1., 0.1}, Tangent::exact);
  const LoopLevel      &level = hierarchy.levels()[0];
  const Eigen::MatrixXd P = level.prolongation, of_fine = dense_in_order(S, hierarchy.order());
  Eigen::MatrixXd       P3 = Eigen::MatrixXd::Zero(3 * P.rows(), 3 * P.cols());
  for (Eigen::Index i = 0; i < P.rows(); ++i)
    for (Eigen::Index j = 0; j < P.cols(); ++j)
      P3.block(3 * i, 3 * j, 3, 3) = P(i, j) * Eigen::Matrix3d::Identity();
  const Eigen::MatrixXd expected = P3.transpose() * of_fine * P3;
  Eigen::MatrixXd       sum      = Eigen::MatrixXd::Zero(expected.rows(), expected.cols());
  const BlockPattern   &coarse   = hierarchy.levels()[1].pattern;
  for (const auto &[begin, end] : {std::pair<int, int>{0, 50}, {50, level.n}})
    {
      std::vector<double> values;
      GalerkinProduct(level.prolongation, level.pattern, begin, end, coarse).compute(S.valuePtr(), values);
      sum += dense(coarse, values);
    }
  EXPECT_LT((sum - expected).norm(), 1e-13 * expected.norm());
}


TEST(PatchInverses, AreTheSumOfInverses)
{
  const Capsule              example = capsule(2);
  const LoopHierarchy        hierarchy(example.topology(), example.surface().pattern(), 1, 0);
  const SparseMatrix         S        = implicit_matrix(example, example.initial(), {1., 0.1}, Tangent::exact);
  const LoopLevel           &level    = hierarchy.levels()[0];
  const Eigen::MatrixXd      of_fine  = dense_in_order(S, hierarchy.order());
  Eigen::MatrixXd            expected = Eigen::MatrixXd::Zero(3 * level.n, 3 * level.n);
  std::vector<std::set<int>> patches(level.n);
  std::vector<int>           place(level.n);
  for (int i = 0; i < level.n; ++i)
    place[hierarchy.order()[i]] = i;
  for (const auto &face : example.topology().faces)
    for (const int a : face)
      for (const int b : face)
        patches[place[a]].insert(place[b]);
  for (const std::set<int> &patch : patches)
    {
      std::vector<int> entries;
      for (const int point : patch)
        entries.insert(entries.end(), {3 * point, 3 * point + 1, 3 * point + 2});
      expected(entries, entries) += of_fine(entries, entries).inverse().eval();
    }
  const PaddedField x = some_field(level.n);
  PaddedField       y(x.size(), 0.);
  for (const auto &[begin, end] : {std::pair<int, int>{0, 50}, {50, level.n}})
    {
      std::vector<std::vector<int>> neighbours(level.n);
      for (int i = 0; i < level.n; ++i)
        for (const int j : patches[i])
          if (j != i)
            neighbours[i].push_back(j);
      const PatchInverses inverses(neighbours, level.pattern, begin, end);
      BlockRows           B = inverses.matrix();
      inverses.compute(level.pattern.starts, S.valuePtr(), B);
      B.multiply(x, y);
    }
  const Eigen::VectorXd wanted = expected * without_padding(x);
  EXPECT_LT((without_padding(y) - wanted).norm(), 1e-6 * wanted.norm());
}


TEST(ShellMultigrid, ConvergesForStiffAndSoftShells)
{
  const Capsule       example   = capsule(4);
  const auto          hierarchy = std::make_shared<LoopHierarchy>(example.topology(), example.surface().pattern(), n_ranks(), rank());
  ShellMultigrid      multigrid(hierarchy, MPI_COMM_WORLD);
  const ControlPoints deformed = example.initial() * Eigen::Vector3d(1.3, 0.9, 1. / 1.17).asDiagonal();
  for (const auto &[name, x, tangent] :
       {std::tuple<std::string, ControlPoints, Tangent>{"sphere", example.initial(), Tangent::exact}, {"ellipsoid", deformed, Tangent::positive}})
    for (const Stiffness &stiffness : {Stiffness{1., 0.}, {10., 0.}, {0., 0.1}, {10., 1.}, {10., 10.}})
      {
        const SparseMatrix S = implicit_matrix(example, x, stiffness, tangent);
        multigrid.set_up(S);
        const double factor = multigrid.convergence_factor();
        if (rank() == 0)
          std::cout << name << " (" << stiffness.stretching << ", " << stiffness.bending << "): " << factor << std::endl;
        EXPECT_LT(factor, 0.3);

        // A linear map, near the inverse.
        const ControlPoints f = some_forces(x.rows()), v = multigrid.solve(f), both = multigrid.solve(2. * f + x), of_x = multigrid.solve(x);
        EXPECT_LT((both - 2. * v - of_x).norm(), 1e-12 * both.norm());
        BlockFactorisation factors;
        factors.factorise(S, "S");
        const Eigen::VectorXd exact = factors.solve(Eigen::Map<const Eigen::VectorXd>(f.data(), f.size()));
        EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(v.data(), v.size()) - exact).norm(), 0.1 * exact.norm());
      }
  multigrid.set_up(implicit_matrix(example, deformed, {0., 100.}, Tangent::exact)); // indefinite
  EXPECT_FALSE(multigrid.convergence_factor() < 0.5);
}


TEST(ShellMultigrid, DoesNotDependOnTheNumberOfRanks)
{
  const Capsule      example = capsule(4);
  const SparseMatrix S       = implicit_matrix(example, example.initial(), {5., 0.2}, Tangent::exact);
  ControlPoints      results[2];
  for (unsigned int i = 0; i < 2; ++i)
    {
      const bool     alone = i == 1;
      ShellMultigrid multigrid(std::make_shared<LoopHierarchy>(example.topology(), example.surface().pattern(), alone ? 1 : n_ranks(), alone ? 0 : rank()),
                               alone ? MPI_COMM_SELF : MPI_COMM_WORLD);
      multigrid.set_up(S);
      results[i] = multigrid.solve(some_forces(example.n_control_points()));
    }
  EXPECT_LT((results[0] - results[1]).norm(), 1e-7 * results[1].norm());
}
