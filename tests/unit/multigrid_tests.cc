// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the multigrid.

#include <Eigen/Eigenvalues>
#include <tanktread/fluid/fluid.h>

#include <iostream>

#include "ladder.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;
} // namespace


namespace
{
  /** Of A C f - f relative to f, C being the direct solver. */
  double
  error_of_direct_solver(const FluidMesh &mesh, const NodeSpace &space, const double shift)
  {
    LaplaceOperator<double> A(space);
    CoarseSolver<double>    solver(mesh, space);
    A.set_shift(shift);
    solver.set_shift(shift);
    Array<double> f = rough_array<double>(mesh, space, 1), u(f.size()), Au(f.size());
    if (space.nodes_per_cell() == 8)
      { // What linear functions can balance: the constant is in the kernel.
        A.apply(f.data(), u.data());
        f = u;
      }
    solver.vmult(u.data(), f.data());
    A.apply(u.data(), Au.data());
    return largest_of_sum(space, 1., Au, -1., f, 0., f) / largest(space, f);
  }
} // namespace


TEST(CoarseSolver, InvertsTheOperatorOnTheFirstRung)
{
  std::vector<std::pair<Box, double>> boxes =
    {{10., 5.}, {10., 10. / 3.}, {10., 2.5}, {10., 2.}, {closed_brick, 4.}, {brick_along_z, 4.}, {brick_along_yz, 4.}};
  boxes.push_back({{{{1., 1., 1.}}, {{Faces::prescribed, Faces::prescribed, Faces::prescribed}}}, 1.}); // one cell, one node
  boxes.push_back({{{{1., 2., 3.}}, {{Faces::prescribed, Faces::periodic, Faces::prescribed}}}, 1.});
  for (const auto &[box, coarsest] : boxes)
    {
      const FluidMesh mesh(MPI_COMM_WORLD, box, cells(coarsest, coarsest));
      for (unsigned int d = 0; d < 3; ++d)
        EXPECT_EQ(mesh.n_rung_0()[d], std::lround(box.side[d] / coarsest));
      const NodeSpace quadratic(ScalarSpace(mesh, 2, true), 3), linear(ScalarSpace(mesh, 1, false), 3);
      for (const double shift : {0., 0.7})
        EXPECT_LT(error_of_direct_solver(mesh, quadratic, shift), 1e-13);
      EXPECT_LT(error_of_direct_solver(mesh, linear, 0.), 1e-13);
    }
}


TEST(FirstRungSolver, ReducesErrorsByTen)
{
  const FluidMesh mesh(MPI_COMM_WORLD, closed_brick, cells(4., 4.));
  const NodeSpace space(ScalarSpace(mesh, 2, true), 3);
  for (const double shift : {0., 0.7})
    for (const double ratio : {0.05, 1., 8.})
      {
        LaplaceOperator<double> A(space);
        FirstRungSolver<double> solver(mesh, A);
        std::vector<double>     viscosities;
        for (const auto &cell : mesh.triangulation().active_cell_iterators())
          if (cell->is_locally_owned())
            viscosities.push_back(cell->center()[0] + cell->center()[2] > 0. ? ratio : 1.);
        A.set_viscosity(viscosities);
        A.set_shift(shift);
        solver.set_viscosity(viscosities);
        solver.set_shift(shift);
        Array<double> u = rough_array<double>(mesh, space, 1), f(u.size()), found(u.size()), Af(u.size());
        A.apply(u.data(), f.data());
        solver.vmult(found, f);
        for (std::size_t j = 0; j < f.size(); ++j)
          found[j] -= u[j];
        // In the norm of the direct solver's inverse, that of viscosity 1 and the same shift.
        LaplaceOperator<double> inverse(space);
        inverse.set_shift(shift);
        const auto norm = [&](Array<double> &x) {
          inverse.apply(x.data(), Af.data());
          return std::sqrt(product(space, x, Af));
        };
        EXPECT_LT(norm(found), (ratio == 1. ? 1e-13 : 0.1) * norm(u)) << ratio;
      }
}


TEST(Chebyshev, LargestEigenvalueOfATridiagonalMatrix)
{
  for (const unsigned int n : {1, 2, 7, 12})
    EXPECT_NEAR(largest_tridiagonal_eigenvalue(std::vector<double>(n, 2.), std::vector<double>(n - 1, 1.)),
                2. + 2. * std::cos(dealii::numbers::PI / (n + 1)),
                1e-5);
  EXPECT_NEAR(largest_tridiagonal_eigenvalue({1., 3., 2.}, {0., 0.}), 3., 1e-5);
}


TEST(Chebyshev, LargestEigenvalueIsJustBelowTheExactOne)
{
  // Meshes small enough for a dense matrix, uniform and not.
  for (const double coarsest : {5., 10. / 3.})
    {
      FluidMesh mesh(MPI_COMM_SELF, 10., cells(coarsest, 0.5 * coarsest));
      mesh.adapt({Point(4.9, 0.1, 1.8)});
      EXPECT_EQ(mesh.triangulation().has_hanging_nodes(), coarsest < 5.);
      const NodeSpace               space(ScalarSpace(mesh, 2, true), 3);
      const LaplaceOperator<double> A(space);
      const std::vector<double>     diagonal = A.diagonal();
      const unsigned int            n        = space.n_owned();
      Array<double>                 x(space.full_size()), Ax(x.size());
      Eigen::MatrixXd               scaled(n, n); // D^{-1/2} A D^{-1/2} of one component
      for (unsigned int j = 0; j < n; ++j)
        {
          x.fill(0.);
          x[4 * j] = 1.;
          A.apply(x.data(), Ax.data());
          for (unsigned int i = 0; i < n; ++i)
            scaled(i, j) = Ax[4 * i] / std::sqrt(diagonal[i] * diagonal[j]);
        }
      EXPECT_LT((scaled - scaled.transpose()).cwiseAbs().maxCoeff(), 1e-14);
      const double expected = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[n - 1];

      const auto estimate = [&](auto number, const unsigned int n_steps) {
        using Number = decltype(number);
        std::vector<Number> inverse_diagonal;
        for (const double d : diagonal)
          inverse_diagonal.push_back(1. / d);
        Array<Number>                 x_n(x.size()), b_n(x.size()), Ax_n(x.size()), direction_n(x.size());
        const LaplaceOperator<Number> A_n(space);
        const auto                    apply = [&](Number *u, Number *y) { A_n.apply(u, y); };
        return largest_eigenvalue<4>(apply, space, ChebyshevArrays<Number>{inverse_diagonal, x_n, b_n, Ax_n, direction_n}, n_steps);
      };
      EXPECT_GT(estimate(0.f, 12), 0.96 * expected);
      EXPECT_LT(estimate(0.f, 12), expected);
      // Where directions run out nothing goes wrong.
      EXPECT_NEAR(estimate(0., 300), expected, 1e-5);
      EXPECT_NEAR(estimate(0.f, 300), expected, 1e-5);
    }
}


TEST(Chebyshev, ReducesWhatIsInItsRange)
{
  // With A = D the error after p steps is the polynomial itself: 1 / T_p(3/2) for range 5 at both ends of [lower, upper].
  FluidMesh       mesh(MPI_COMM_WORLD, 10., cells(2.5, 2.5));
  const NodeSpace space(ScalarSpace(mesh, 2, true), 3);
  for (const double eigenvalue : {0.4, 2.})
    for (const bool from_zero : {true, false})
      {
        const std::vector<double> inverse_diagonal(space.n_owned(), 0.5);
        Array<double>             x(space.full_size()), b(x.size()), Ax(x.size()), direction(x.size());
        for (std::size_t j = 0; j < x.size(); ++j)
          b[j] = from_zero ? 2. * eigenvalue : 0.; // solution one, or zero from one
        x.fill(from_zero ? 77. : 1.);
        const auto apply = [&](const double *u, double *y) {
          for (std::size_t j = 0; j < x.size(); ++j)
            y[j] = 2. * eigenvalue * u[j];
        };
        chebyshev<4>(apply, {2, 0.4, 2.}, ChebyshevArrays<double>{inverse_diagonal, x, b, Ax, direction}, from_zero);
        const double T_2 = 2. * 1.5 * 1.5 - 1.;
        for (unsigned int j = 0; j < 4 * space.n_owned(); ++j)
          ASSERT_NEAR(x[j], from_zero ? 1. - 1. / T_2 : 1. / T_2, 1e-14);
      }
}


TEST(Multigrid, VCycleIsLinearSymmetricAndPositive)
{
  for (const Scene &scene : scenes())
    {
      Ladder             ladder(MPI_COMM_WORLD, scene);
      const NodeSpace   &space = ladder.nodes();
      const Array<float> f = rough_array<float>(ladder.mesh, space, 1), g = rough_array<float>(ladder.mesh, space, 2);
      const Array<float> u = ladder.v_cycle(f), v = ladder.v_cycle(g);
      const double       scale = std::sqrt(product(space, f, u) * product(space, g, v));
      EXPECT_GT(product(space, f, u), 0.);
      EXPECT_NEAR(product(space, g, u) / scale, product(space, f, v) / scale, 1e-6);

      Array<float> sum(f.size());
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] = 2.f * f[i] - 0.75f * g[i];
      EXPECT_LT(largest_of_sum(space, 1., ladder.v_cycle(sum), -2., u, 0.75, v), 2e-6 * largest(space, u));
      // No memory of the calls before.
      EXPECT_EQ(largest_of_sum(space, 1., ladder.v_cycle(f), -1., u, 0., u), 0.);
    }
}


namespace
{
  /** A V-cycle on a mesh around `points`, with inertia and two viscosities, after `prepare(fluid)`. */
  template <typename Prepare>
  Array<float>
  v_cycle_with_two_viscosities(const std::vector<Point> &points, const Prepare &prepare)
  {
    Multigrid<float> multigrid;
    FluidMesh        mesh(MPI_COMM_WORLD, brick_along_z, cells(4., 1.));
    const auto       climb = [&] {
      mesh.restart();
      multigrid.start(mesh);
      while (!mesh.on_last_rung())
        multigrid.climb(mesh);
    };
    mesh.aim_at(points);
    prepare(multigrid, climb);
    std::vector<double> viscosities;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        viscosities.push_back(cell->center()[0] + cell->center()[2] > 0. ? 5. : 1.);
    multigrid.set_viscosity(viscosities);
    const Array<float> f = rough_array<float>(mesh, *multigrid.space(), 1);
    const std::size_t  n = 4 * std::size_t(multigrid.space()->n_owned());
    std::copy(f.begin(), f.begin() + n, multigrid.right_hand_side());
    multigrid.v_cycle();
    Array<float> result(n);
    std::copy(multigrid.solution(), multigrid.solution() + n, result.begin());
    return result;
  }
} // namespace


TEST(Multigrid, KeepsTheShiftWhenTheMeshChanges)
{
  const std::vector<Point> points        = {Point(1., 2., 3.)};
  const Array<float>       climbed_first = v_cycle_with_two_viscosities(points, [](Multigrid<float> &multigrid, const auto &climb) {
    climb();
    multigrid.set_shift(30.);
  });
  const Array<float>       shifted_first = v_cycle_with_two_viscosities(points, [](Multigrid<float> &multigrid, const auto &climb) {
    climb();
    multigrid.set_shift(30.);
    climb();
  });
  ASSERT_EQ(climbed_first.size(), shifted_first.size());
  for (std::size_t j = 0; j < climbed_first.size(); ++j)
    ASSERT_EQ(climbed_first[j], shifted_first[j]);
}


TEST(Multigrid, MovesWithTheBandAcrossPeriodicFaces)
{
  struct Case
  {
    double box, coarsest, finest;
  };
  for (const Case &c : {Case{10., 2.5, 0.3125}, {10., 2., 0.5}, {20., 2.5, 0.625}})
    {
      std::vector<Solve>  solves;
      std::vector<double> largest_eigenvalues;
      for (const int n : {0, 1, 2})
        {
          const double shift = n * c.coarsest;
          Ladder       ladder(MPI_COMM_WORLD, {c.box, c.coarsest, c.finest, oracle::sphere_points(Point(0.1 + shift, 0.2 - shift, 0.3), 1.)});
          solves.push_back(solve_laplace(ladder, load_of_cells(ladder, 1.), 1e-10));
          largest_eigenvalues.push_back(ladder.multigrid.largest_eigenvalue());
        }
      for (const int n : {1, 2})
        {
          EXPECT_EQ(solves[n].iterations, solves[0].iterations);
          EXPECT_NEAR(solves[n].energy, solves[0].energy, 1e-12 * solves[0].energy);
          EXPECT_NEAR(largest_eigenvalues[n], largest_eigenvalues[0], 0.03 * largest_eigenvalues[0]);
        }
      if (is_root())
        std::cout << "box " << c.box << ": " << solves[0].iterations << " iterations, largest eigenvalues " << largest_eigenvalues[0] << ' '
                  << largest_eigenvalues[1] << ' ' << largest_eigenvalues[2] << std::endl;
    }
}


namespace
{
  /** What is allowed for Stokes. */
  struct Allowed
  {
    unsigned int iterations = 13, difference_between_ranks = 0;
  };

  /** Iterations for velocities and for Stokes on a mesh, with all ranks and, if asked for, on each rank alone. */
  void
  expect_few_iterations(const Scene &scene, const bool alone_too, const Allowed &allowed = {})
  {
    Ladder             ladder(MPI_COMM_WORLD, scene);
    const unsigned int laplace = solve_laplace(ladder, rough_vector(ladder), 1e-8).iterations, stokes = stokes_iterations(ladder);
    EXPECT_LE(laplace, 7u);
    EXPECT_LE(stokes, allowed.iterations);
    if (is_root())
      std::cout << "box " << scene.box.side[0] << " x " << scene.box.side[1] << " x " << scene.box.side[2] << ", coarsest cell " << scene.coarsest
                << ", finest " << scene.finest << ": " << ladder.mesh.triangulation().n_global_active_cells() << " cells, " << laplace
                << " iterations for the velocities, " << stokes << " for Stokes, eigenvalue " << ladder.multigrid.largest_eigenvalue() << std::endl;
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1 && alone_too)
      {
        Ladder alone(MPI_COMM_SELF, scene);
        EXPECT_EQ(solve_laplace(alone, rough_vector(alone), 1e-8).iterations, laplace);
        EXPECT_NEAR(stokes_iterations(alone), stokes, allowed.difference_between_ranks);
      }
  }
} // namespace


TEST(Multigrid, IterationsDependOnNeitherMeshNorRanks)
{
  const auto band = oracle::sphere_points(Point(), 1.); // on uniform meshes it does not matter
  expect_few_iterations({10., 10. / 8, 10. / 8, band}, true);
  expect_few_iterations({10., 10. / 16, 10. / 16, band}, true);
  expect_few_iterations({20., 20. / 16, 10. / 8, band}, false);
  expect_few_iterations({10., 2., 0.5, oracle::sphere_points(Point(5., -5., 0.), 1.)}, true);
  for (const unsigned int n_finest : {16, 32, 64})
    for (const double box : {10., 20.})
      for (const Point &centre : {Point(), Point(0.5 * box, 0.5 * box, 0.)})
        expect_few_iterations({box, 2.5, 10. / n_finest, oracle::sphere_points(centre, 1.)}, n_finest <= 32 && box == 10.);
}


TEST(Multigrid, IterationsInBricks)
{
  // For the velocities as in the cube. For Stokes they depend on the box, through the inf-sup constant, not on the mesh; where there
  // are more, the last one may depend on the numbering (through the estimate of the largest eigenvalue).
  struct Case
  {
    Box          box;
    unsigned int stokes_allowed;
  };
  for (const Case &c : {Case{closed_brick, 24}, {brick_along_z, 19}, {brick_along_yz, 14}})
    for (const Point &centre : {Point(0.1, 0.2, 0.3), Point(2.9, -4.9, 6.9)})
      for (const double finest : {1., 0.5, 0.25})
        expect_few_iterations({c.box, 2., finest, oracle::sphere_points(centre, 1.)}, finest == 0.5, {c.stokes_allowed, 1});
  // Long channels: rung 0 has 2 x 1 x 16 and 1 x 1 x 9 cells.
  expect_few_iterations({{{{4., 2., 32.}}, {{Faces::periodic, Faces::prescribed, Faces::prescribed}}}, 2., 0.25, {Point(0.1, 0.3, 15.7)}}, true, {47, 1});
  expect_few_iterations({{{{4., 4., 36.}}, {{Faces::prescribed, Faces::prescribed, Faces::periodic}}}, 2., 0.5, {Point(1.9, 1.7, 17.9)}}, true, {37, 1});
}
