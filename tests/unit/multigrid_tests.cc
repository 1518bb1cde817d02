// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the numbering of nodes and the multigrid.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_cg.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <oracle/assembled_stokes.h>
#include <oracle/geometric_transfer.h>
#include <oracle/node_values.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/stokes_preconditioner.h>

#include <iostream>
#include <random>

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;
  template <typename Number>
  using Array = dealii::AlignedVector<Number>;

  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  FluidMeshParameters
  cells(const double coarsest, const double finest)
  {
    FluidMeshParameters parameters;
    parameters.coarsest_cell = coarsest;
    parameters.finest_cell   = finest;
    return parameters;
  }

  /** Boxes of side 10 and bands around spheres: in the middle, across both pairs of periodic faces, at a wall. */
  const std::vector<std::vector<Point>> bands = {oracle::sphere_points(Point(0.1, 0., -0.2), 1.),
                                                 oracle::sphere_points(Point(-5., 5., 0.1), 1.),
                                                 oracle::sphere_points(Point(4.5, 1., 3.7), 1.)};

  /** Full array with rough numbers at the owned nodes. */
  template <typename Number>
  Array<Number>
  rough_array(const FluidMesh &mesh, const NodeSpace &space, const unsigned int seed)
  {
    FluidVector vector(space.partitioner());
    oracle::set_rough(mesh, space, seed, vector);
    Array<Number> result(space.full_size());
    space.load(vector, result.data());
    return result;
  }

  /** Of the owned entries, summed over the ranks. */
  template <typename Number>
  double
  product(const NodeSpace &space, const Array<Number> &x, const Array<Number> &y)
  {
    double sum = 0.;
    for (std::size_t i = 0; i < std::size_t(space.stride()) * space.n_owned(); ++i)
      sum += double(x[i]) * y[i];
    return dealii::Utilities::MPI::sum(sum, space.partitioner()->get_mpi_communicator());
  }

  /** Largest magnitude of a x + b y + c z over the owned entries of all ranks. */
  template <typename Number>
  double
  largest_of_sum(const NodeSpace &space, const double a, const Array<Number> &x, const double b, const Array<Number> &y, const double c, const Array<Number> &z)
  {
    double result = 0.;
    for (std::size_t i = 0; i < std::size_t(space.stride()) * space.n_owned(); ++i)
      result = std::max(result, std::abs(a * x[i] + b * y[i] + c * z[i]));
    return dealii::Utilities::MPI::max(result, space.partitioner()->get_mpi_communicator());
  }

  template <typename Number>
  double
  largest(const NodeSpace &space, const Array<Number> &x)
  {
    return largest_of_sum(space, 1., x, 0., x, 0., x);
  }

  void
  expect_collect_is_transpose_of_update(const NodeSpace &space)
  {
    std::mt19937                           random(11 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Array<double>                          u(space.full_size()), w(space.full_size()), owned_w;
    for (auto *array : {&u, &w})
      for (double &x : *array)
        x = uniform(random);
    space.update(u.data());
    std::vector<double> sums(2, 0.);
    for (std::size_t i = 0; i < u.size(); ++i)
      {
        sums[0] += u[i] * w[i];
        sums[1] += std::abs(u[i] * w[i]);
      }
    space.collect(w.data());
    dealii::Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
    EXPECT_NEAR(product(space, u, w), sums[0], 1e-14 * sums[1]);
  }

  /** Sets f(z) at owned nodes, updates and returns the largest error at all nodes of all cells. */
  template <typename Function>
  double
  largest_error_of_interpolant(const FluidMesh &mesh, const NodeSpace &space, const Function &f)
  {
    const auto         positions = oracle::node_positions(mesh, space);
    const unsigned int n = space.nodes_per_cell() == 27 ? 3 : 2, stride = space.stride();
    Array<double>      u(space.full_size());
    for (unsigned int i = 0; i < space.n_owned(); ++i)
      u[stride * i + stride / 2] = f(positions[i][2]);
    space.update(u.data());
    double       result      = 0.;
    unsigned int cell_number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int *const nodes = space.cell_nodes(cell_number);
          EXPECT_DOUBLE_EQ(space.cell_sizes()[cell_number++], mesh.cell_size(cell->level()));
          for (unsigned int a = 0; a < space.nodes_per_cell(); ++a)
            {
              const double z = cell->vertex(0)[2] + mesh.cell_size(cell->level()) / (n - 1) * (a / (n * n));
              result         = std::max(result, std::abs(u[stride * nodes[a] + stride / 2] - f(z)));
            }
        }
    EXPECT_EQ(cell_number, space.n_cells());
    return dealii::Utilities::MPI::max(result, MPI_COMM_WORLD);
  }
} // namespace


TEST(NodeSpace, CollectIsTheTransposeOfUpdate)
{
  for (const auto &band : bands)
    {
      FluidMesh mesh(MPI_COMM_WORLD, 10., cells(2.5, 0.3125));
      mesh.adapt(band);
      const TaylorHoodSpace space(mesh);
      expect_collect_is_transpose_of_update(*space.velocity);
      expect_collect_is_transpose_of_update(*space.pressure);
    }
}


TEST(NodeSpace, FieldsAreContinuousAndZeroAtTheWalls)
{
  for (const auto &band : bands)
    {
      FluidMesh mesh(MPI_COMM_WORLD, 10., cells(2.5, 0.3125));
      mesh.adapt(band);
      const TaylorHoodSpace space(mesh);
      EXPECT_LT(largest_error_of_interpolant(mesh, *space.velocity, [](const double z) { return 25. - z * z; }), 1e-13);
      EXPECT_LT(largest_error_of_interpolant(mesh, *space.pressure, [](const double z) { return 1. + z; }), 1e-14);
      EXPECT_EQ(largest_error_of_interpolant(mesh, *space.pressure, [](const double) { return 1.; }), 0.);
    }
}


TEST(NodeSpace, DiagonalIsThatOfTheAssembledMatrix)
{
  const oracle::ReferenceMatrices reference;
  const std::vector<double>       laplace = oracle::lexicographic(reference.laplace, 2, 2), mass = oracle::lexicographic(reference.pressure_mass, 1, 1);
  const auto                      expect_equal = [](const std::vector<double> &found, const ScalarSpace &space, const NodeSpace &nodes, const auto &matrix) {
    const auto dofs = oracle::dofs_of_nodes(space, nodes);
    ASSERT_EQ(found.size(), dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i)
      {
        const double expected = matrix.diag_element(space.partitioner()->local_to_global(dofs[i]));
        EXPECT_NEAR(found[i], expected, 1e-13 * expected);
      }
  };
  for (const auto &band : bands)
    {
      FluidMesh mesh(MPI_COMM_WORLD, 10., cells(2.5, 0.3125));
      mesh.adapt(band);
      const TaylorHoodSpace         space(mesh);
      const oracle::AssembledStokes assembled(mesh);
      expect_equal(space.velocity->diagonal(laplace, 1), assembled.velocity(), *space.velocity, assembled.laplace());
      expect_equal(LaplaceOperator<double>(*space.velocity).diagonal(), assembled.velocity(), *space.velocity, assembled.laplace());
      expect_equal(space.pressure->diagonal(mass, 3), assembled.pressure(), *space.pressure, assembled.pressure_mass());
    }
}


namespace
{
  /** Differences between what two rungs say, relative to the numbers themselves. */
  struct TransferErrors
  {
    double energy = 0., transpose = 0., oracle = 0.;
  };

  /** Largest difference between P u and what deal.II makes of it, for each component. `coarse_mesh` is `mesh` one rung before. */
  double
  difference_to_oracle(const FluidMesh     &coarse_mesh,
                       const FluidMesh     &mesh,
                       const NodeSpace     &coarse,
                       const NodeSpace     &fine,
                       const Array<double> &u,
                       const Array<double> &Pu)
  {
    const ScalarSpace from(coarse_mesh, 2, true), to(mesh, 2, true);
    const auto        from_dofs = oracle::dofs_of_nodes(from, coarse), to_dofs = oracle::dofs_of_nodes(to, fine);
    double            result = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      {
        FluidVector vector(from.partitioner());
        for (unsigned int i = 0; i < from_dofs.size(); ++i)
          vector.local_element(from_dofs[i]) = u[4 * i + c];
        const FluidVector expected = oracle::prolongated(from, to, vector);
        for (unsigned int i = 0; i < to_dofs.size(); ++i)
          result = std::max(result, std::abs(expected.local_element(to_dofs[i]) - Pu[4 * i + c]));
      }
    return dealii::Utilities::MPI::max(result, MPI_COMM_WORLD);
  }

  TransferErrors
  transfer_errors(const double box, const double coarsest, const double finest, const std::vector<Point> &band)
  {
    TransferErrors errors;
    FluidMesh      mesh(MPI_COMM_WORLD, box, cells(coarsest, finest)), coarse_mesh(MPI_COMM_WORLD, box, cells(coarsest, finest));
    mesh.aim_at(band);
    coarse_mesh.aim_at(band);
    auto coarse = std::make_unique<NodeSpace>(ScalarSpace(mesh, 2, true), 3);
    for (bool first = true; !mesh.on_last_rung(); first = false)
      {
        if (!first)
          coarse_mesh.climb();
        std::unique_ptr<NodeSpace>    fine;
        const auto                    rows = climb_with_interpolation(mesh, *coarse, [&]() -> const NodeSpace                    &{
          fine = std::make_unique<NodeSpace>(ScalarSpace(mesh, 2, true), 3);
          return *fine;
        });
        const LevelTransfer<double>   transfer(rows, *coarse, *fine);
        const LaplaceOperator<double> A(*coarse), A_fine(*fine);

        Array<double> u = rough_array<double>(mesh, *coarse, 1), Au(u.size()), Pu(fine->full_size()), APu(Pu.size()), RAPu(u.size());
        transfer.prolongate(u.data(), Pu.data());
        A.apply(u.data(), Au.data());
        A_fine.apply(Pu.data(), APu.data());
        const double energy = product(*coarse, u, Au);
        errors.energy       = std::max(errors.energy, std::abs(product(*fine, Pu, APu) / energy - 1.));

        const Array<double> w = rough_array<double>(mesh, *fine, 2);
        transfer.restrict(w.data(), RAPu.data());
        const double scale = std::sqrt(product(*fine, w, w) * product(*fine, Pu, Pu));
        errors.transpose   = std::max(errors.transpose, std::abs(product(*fine, w, Pu) - product(*coarse, RAPu, u)) / scale);
        // Nested spaces: P^T A P is the coarse operator itself.
        transfer.restrict(APu.data(), RAPu.data());
        errors.energy = std::max(errors.energy, largest_of_sum(*coarse, 1., RAPu, -1., Au, 0., Au) / largest(*coarse, Au));

        errors.oracle = std::max(errors.oracle, difference_to_oracle(coarse_mesh, mesh, *coarse, *fine, u, Pu));
        coarse        = std::move(fine);
      }
    return errors;
  }
} // namespace


TEST(LevelTransfer, NestedSpacesAndDealiiAgree)
{
  TransferErrors largest;
  const auto     check = [&](const double box, const double coarsest, const double finest, const std::vector<Point> &band) {
    const TransferErrors errors = transfer_errors(box, coarsest, finest, band);
    EXPECT_LT(errors.energy, 1e-13) << "box " << box;
    EXPECT_LT(errors.transpose, 1e-14) << "box " << box;
    EXPECT_LT(errors.oracle, 1e-14) << "box " << box;
    largest = {std::max(largest.energy, errors.energy), std::max(largest.transpose, errors.transpose), std::max(largest.oracle, errors.oracle)};
  };
  for (const auto &band : bands)
    check(10., 2.5, 0.3125, band);
  check(20., 2.5, 0.625, oracle::sphere_points(Point(10., -10., 0.), 1.));
  check(10., 2., 1., bands[1]);
  if (is_root())
    std::cout << "relative differences: energy " << largest.energy << ", transpose " << largest.transpose << ", deal.II's transfer " << largest.oracle
              << std::endl;
}


TEST(CoarseSolver, InvertsTheOperatorOnTheFirstRung)
{
  for (const int n : {2, 3, 4, 5})
    {
      const FluidMesh               mesh(MPI_COMM_WORLD, 10., cells(10. / n, 10. / n));
      const NodeSpace               space(ScalarSpace(mesh, 2, true), 3);
      const LaplaceOperator<double> A(space);
      const CoarseSolver<double>    solver(mesh, space);
      const Array<double>           f = rough_array<double>(mesh, space, 1);
      Array<double>                 u(f.size()), Au(f.size());
      solver.solve(f.data(), u.data());
      A.apply(u.data(), Au.data());
      EXPECT_EQ(mesh.n_rung_0(), n);
      EXPECT_LT(largest_of_sum(space, 1., Au, -1., f, 0., f), 1e-13 * largest(space, f));
    }
}


namespace
{
  /** A finished mesh with everything that solves on it. */
  struct Ladder
  {
    Ladder(const MPI_Comm comm, const double box, const double coarsest, const double finest, const std::vector<Point> &band)
      : mesh(comm, box, cells(coarsest, finest))
    {
      mesh.aim_at(band);
      multigrid.start(mesh);
      while (!mesh.on_last_rung())
        multigrid.climb(mesh);
    }

    const NodeSpace &
    nodes() const
    {
      return *multigrid.space();
    }

    /** solution of one V-cycle. */
    Array<float>
    v_cycle(const Array<float> &f)
    {
      std::copy(f.begin(), f.begin() + 4 * std::size_t(nodes().n_owned()), multigrid.right_hand_side());
      multigrid.v_cycle();
      Array<float> result(f.size());
      std::copy(multigrid.solution(), multigrid.solution() + 4 * std::size_t(nodes().n_owned()), result.begin());
      return result;
    }

    FluidMesh        mesh;
    Multigrid<float> multigrid;
  };

  /** The velocities' Laplace operator in double precision and its preconditioner, for deal.II's solvers. */
  class Laplace
  {
  public:
    explicit Laplace(const NodeSpace &space)
      : space_(space)
      , laplace_(space)
      , x_(space.full_size())
      , y_(space.full_size())
    {}

    void
    vmult(FluidVector &dst, const FluidVector &src) const
    {
      space_.load(src, x_.data());
      laplace_.apply(x_.data(), y_.data());
      space_.store(y_.data(), dst, false);
    }

  private:
    const NodeSpace              &space_;
    const LaplaceOperator<double> laplace_;
    mutable Array<double>         x_, y_;
  };

  struct VCycle
  {
    void
    vmult(FluidVector &dst, const FluidVector &src) const
    {
      multigrid.space()->load(src, multigrid.right_hand_side());
      multigrid.v_cycle();
      multigrid.space()->store(multigrid.solution(), dst, false);
    }

    Multigrid<float> &multigrid;
  };

  struct Solve
  {
    unsigned int iterations;
    double       energy; // of the right-hand side: f A^{-1} f
  };

  /** Conjugate gradients until the residual has fallen by `tolerance`. */
  Solve
  solve_laplace(Ladder &ladder, const FluidVector &f, const double tolerance)
  {
    FluidVector                   u(f);
    dealii::SolverControl         control(100, tolerance * f.l2_norm(), false, false);
    dealii::SolverCG<FluidVector> solver(control);
    u = 0.;
    solver.solve(Laplace(ladder.nodes()), u, f, VCycle{ladder.multigrid});
    return {control.last_step(), u * f};
  }

  FluidVector
  rough_vector(const Ladder &ladder)
  {
    FluidVector result(ladder.nodes().partitioner());
    oracle::set_rough(ladder.mesh, ladder.nodes(), 1, result);
    return result;
  }

  /** Each cell puts its size to the power `power` at each of its nodes: a right-hand side that moves with the mesh. */
  FluidVector
  load_of_cells(const Ladder &ladder, const double power)
  {
    const NodeSpace &space = ladder.nodes();
    Array<double>    y(space.full_size());
    for (unsigned int cell = 0; cell < space.n_cells(); ++cell)
      for (unsigned int a = 0; a < 27; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          y[4 * space.cell_nodes(cell)[a] + c] += std::pow(space.cell_sizes()[cell], power) * (c + a);
    space.collect(y.data());
    FluidVector result(space.partitioner());
    space.store(y.data(), result, false);
    return result;
  }

  /** Iterations of the Stokes equations to 1e-6 with rough forces. */
  unsigned int
  stokes_iterations(Ladder &ladder)
  {
    const TaylorHoodSpace      space(ladder.mesh, ladder.multigrid.space());
    const StokesOperator       stokes(space);
    const StokesPreconditioner preconditioner(space, ladder.multigrid);
    FluidBlockVector           x, rhs;
    space.reinit(x);
    space.reinit(rhs);
    rhs.block(velocity_block) = rough_vector(ladder);
    const LinearReport report = solve_fgmres(stokes, preconditioner, x, rhs, 1e-6, 100);
    EXPECT_TRUE(report.converged);
    return report.iterations;
  }
} // namespace


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
  for (const auto &band : bands)
    {
      Ladder             ladder(MPI_COMM_WORLD, 10., 2.5, 0.3125, band);
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
          Ladder       ladder(MPI_COMM_WORLD, c.box, c.coarsest, c.finest, oracle::sphere_points(Point(0.1 + shift, 0.2 - shift, 0.3), 1.));
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


TEST(Multigrid, IterationsDependOnNeitherMeshNorRanks)
{
  struct Case
  {
    double       box, coarsest;
    unsigned int n_finest; // cells of the finest size along 10
    Point        centre;   // the band is a sphere of radius 1; on uniform meshes it does not matter
  };
  std::vector<Case> cases = {{10., 10. / 8, 8, Point()}, {10., 10. / 16, 16, Point()}, {20., 20. / 16, 8, Point()}, {10., 2., 20, Point(5., -5., 0.)}};
  for (const unsigned int n_finest : {16, 32, 64})
    for (const double box : {10., 20.})
      for (const Point &centre : {Point(), Point(0.5 * box, 0.5 * box, 0.)})
        cases.push_back({box, 2.5, n_finest, centre});
  for (const Case &c : cases)
    {
      const auto         band = oracle::sphere_points(c.centre, 1.);
      Ladder             ladder(MPI_COMM_WORLD, c.box, c.coarsest, 10. / c.n_finest, band);
      const unsigned int laplace = solve_laplace(ladder, rough_vector(ladder), 1e-8).iterations, stokes = stokes_iterations(ladder);
      EXPECT_LE(laplace, 7u);
      EXPECT_LE(stokes, 13u);
      if (is_root())
        std::cout << "box " << c.box << ", coarsest cell " << c.coarsest << ", finest 10/" << c.n_finest << ", centre " << c.centre << ": "
                  << ladder.mesh.triangulation().n_global_active_cells() << " cells, " << laplace << " iterations for the velocities, " << stokes
                  << " for Stokes, eigenvalue " << ladder.multigrid.largest_eigenvalue() << std::endl;
      if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1 && c.n_finest <= 32 && c.box == 10.)
        {
          Ladder alone(MPI_COMM_SELF, c.box, c.coarsest, 10. / c.n_finest, band);
          EXPECT_EQ(solve_laplace(alone, rough_vector(alone), 1e-8).iterations, laplace);
          EXPECT_EQ(stokes_iterations(alone), stokes);
        }
    }
}
