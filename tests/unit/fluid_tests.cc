// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the fluid mesh, the Stokes equations and point evaluation.

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/trilinos_solver.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/compat.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/fluid/stokes_preconditioner.h>

#include <iostream>
#include <random>

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  constexpr double side = 2.;

  /** Points on a sphere; with a centre at a corner of the box it crosses both periodic faces. */
  std::vector<Point>
  sphere_points(const Point &centre, const double radius)
  {
    std::vector<Point> points;
    const unsigned int n = 600;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double z = (2. * i + 1.) / n - 1., phi = i * 2.399963229728653, r = std::sqrt(1. - z * z);
        points.push_back(centre + radius * Point(r * std::cos(phi), r * std::sin(phi), z));
      }
    return points;
  }

  /** Divergence-free velocity, periodic in x and y, not zero at the walls, with a pressure: -laplace u + grad p = f. */
  struct Manufactured
  {
    static constexpr double k = dealii::numbers::PI, q = 1.3;

    static std::array<double, 3>
    velocity(const Point &x)
    {
      return {{-q * std::cos(k * x[0]) * std::cos(k * x[1]) * std::cos(q * x[2]),
               std::sin(k * x[0]) * std::cos(q * x[2]),
               -k * std::sin(k * x[0]) * std::cos(k * x[1]) * std::sin(q * x[2])}};
    }
    static double
    pressure(const Point &x)
    {
      return std::sin(k * x[0]) * std::cos(k * x[1]) * x[2] * x[2];
    }
    static std::array<double, 3>
    force(const Point &x)
    {
      const auto   u  = velocity(x);
      const double l2 = 2. * k * k + q * q;
      return {{l2 * u[0] + k * std::cos(k * x[0]) * std::cos(k * x[1]) * x[2] * x[2],
               (k * k + q * q) * u[1] - k * std::sin(k * x[0]) * std::sin(k * x[1]) * x[2] * x[2],
               l2 * u[2] + 2. * std::sin(k * x[0]) * std::cos(k * x[1]) * x[2]}};
    }
  };

  struct Shear
  {
    static std::array<double, 3>
    velocity(const Point &x)
    {
      return {{x[2], 0., 0.}};
    }
    static double
    pressure(const Point &)
    {
      return 0.;
    }
    static std::array<double, 3>
    force(const Point &)
    {
      return {{0., 0., 0.}};
    }
  };

  /** Mesh, spaces, operator and preconditioner in the order they need each other. */
  struct Problem
  {
    Problem(const MPI_Comm comm, const double coarse, const double fine, const std::vector<Point> &band)
      : mesh(comm, side, parameters(coarse, fine))
      , adapted(mesh.adapt(band))
      , space(mesh)
      , stokes(space)
      , preconditioner(stokes)
    {}

    static FluidMeshParameters
    parameters(const double coarse, const double fine)
    {
      FluidMeshParameters p;
      p.coarsest_cell = coarse;
      p.finest_cell   = fine;
      return p;
    }

    /** Solves for `Solution` given on the walls and returns nodal values with all constraints resolved and ghosts set. */
    template <typename Solution>
    FluidBlockVector
    solve(LinearReport &report) const;

    FluidMesh            mesh;
    bool                 adapted;
    TaylorHoodSpace      space;
    StokesOperator       stokes;
    StokesPreconditioner preconditioner;
  };

  /** Nodal interpolant at the wall nodes, zero elsewhere, constraints other than the walls' resolved. */
  template <typename Solution>
  FluidBlockVector
  wall_values(const TaylorHoodSpace &space)
  {
    FluidBlockVector lift;
    space.reinit(lift);
    const auto                                  &dofs = space.velocity.dofs();
    std::vector<dealii::types::global_dof_index> indices(27);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(indices);
          for (unsigned int a = 0; a < 27; ++a)
            {
              const Point x = cell->vertex(0) + space.mesh.cell_size(cell->level()) * dofs.get_fe().unit_support_point(a);
              if (std::abs(std::abs(x[2]) - 0.5 * side) < 1e-10)
                for (unsigned int c = 0; c < 3; ++c)
                  if (lift.block(c).locally_owned_elements().is_element(indices[a]))
                    lift.block(c)(indices[a]) = Solution::velocity(x)[c];
            }
        }
    // Hanging nodes on the walls follow their masters, or the lifted field would not be continuous.
    dealii::AffineConstraints<double> hanging;
    compat::reinit(hanging, dofs.locally_owned_dofs(), dealii::DoFTools::extract_locally_relevant_dofs(dofs));
    dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();
    for (unsigned int c = 0; c < 3; ++c)
      hanging.distribute(lift.block(c));
    lift.update_ghost_values();
    return lift;
  }

  template <typename Solution>
  void
  add_body_force(const TaylorHoodSpace &space, FluidBlockVector &rhs)
  {
    const dealii::QGauss<3>                      quadrature(4);
    dealii::FEValues<3>                          values(space.velocity.dofs().get_fe(),
                               quadrature,
                               dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
    std::vector<dealii::types::global_dof_index> indices(27);
    for (const auto &cell : space.velocity.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          cell->get_dof_indices(indices);
          for (unsigned int c = 0; c < 3; ++c)
            {
              dealii::Vector<double> load(27);
              for (const auto q : values.quadrature_point_indices())
                for (unsigned int a = 0; a < 27; ++a)
                  load[a] += Solution::force(values.quadrature_point(q))[c] * values.shape_value(a, q) * values.JxW(q);
              space.velocity.constraints().distribute_local_to_global(load, indices, rhs.block(c));
            }
        }
    rhs.compress(dealii::VectorOperation::add);
  }

  template <typename Solution>
  FluidBlockVector
  Problem::solve(LinearReport &report) const
  {
    FluidBlockVector rhs, correction;
    space.reinit(rhs);
    space.reinit(correction);
    add_body_force<Solution>(space, rhs);
    FluidBlockVector result = wall_values<Solution>(space);
    stokes.subtract_applied(result, rhs);
    // What the walls let in and out cancels only up to quadrature: take the part out that no velocity can balance.
    FluidVector constant(rhs.block(3));
    for (const auto i : constant.locally_owned_elements())
      constant(i) = space.pressure.constraints().is_constrained(i) ? 0. : 1.;
    rhs.block(3).add(-(rhs.block(3) * constant) / (constant * constant), constant);
    report = solve_fgmres(stokes, preconditioner, correction, rhs, 1e-12, 200);

    result.zero_out_ghost_values();
    for (unsigned int b = 0; b < 4; ++b)
      {
        (b < 3 ? space.velocity : space.pressure).constraints().distribute(correction.block(b));
        result.block(b) += correction.block(b);
      }
    result.block(3).add(-result.block(3).mean_value());
    result.update_ghost_values();
    return result;
  }

  /** L2 norms of the errors of velocity and pressure, the pressure's mean removed. */
  template <typename Solution>
  std::pair<double, double>
  errors(const TaylorHoodSpace &space, const FluidBlockVector &solution)
  {
    const dealii::QGauss<3> quadrature(5);
    const auto              flags = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    dealii::FEValues<3>     u(space.velocity.dofs().get_fe(), quadrature, flags), p(space.pressure.dofs().get_fe(), quadrature, flags);
    std::vector<double>     values(quadrature.size());
    double                  eu = 0., ep = 0., mean = 0.;
    for (const auto &cell : space.velocity.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          u.reinit(cell);
          for (unsigned int c = 0; c < 3; ++c)
            {
              u.get_function_values(solution.block(c), values);
              for (const auto q : u.quadrature_point_indices())
                eu += std::pow(values[q] - Solution::velocity(u.quadrature_point(q))[c], 2) * u.JxW(q);
            }
          p.reinit(dealii::DoFHandler<3>::active_cell_iterator(&space.mesh.triangulation(), cell->level(), cell->index(), &space.pressure.dofs()));
          p.get_function_values(solution.block(3), values);
          for (const auto q : p.quadrature_point_indices())
            {
              const double e = values[q] - Solution::pressure(p.quadrature_point(q));
              ep += e * e * p.JxW(q);
              mean += e * p.JxW(q);
            }
        }
    const MPI_Comm comm = space.mesh.communicator();
    mean                = dealii::Utilities::MPI::sum(mean, comm);
    ep                  = dealii::Utilities::MPI::sum(ep, comm) - mean * mean / (side * side * side);
    return {std::sqrt(dealii::Utilities::MPI::sum(eu, comm)), std::sqrt(ep)};
  }

  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  void
  expect_orders(const std::vector<double> &coarse_cells, const std::vector<Point> &band, const unsigned int levels_above_coarse)
  {
    std::vector<std::pair<double, double>> e;
    for (const double coarse : coarse_cells)
      {
        const Problem problem(MPI_COMM_WORLD, coarse, coarse / (1 << levels_above_coarse), band);
        LinearReport  report;
        const auto    solution = problem.solve<Manufactured>(report);
        EXPECT_TRUE(report.converged);
        e.push_back(errors<Manufactured>(problem.space, solution));
        if (is_root())
          std::cout << "coarse cell " << coarse << ": " << problem.mesh.triangulation().n_global_active_cells() << " cells, error u " << e.back().first
                    << ", p " << e.back().second << ", " << report.iterations << " iterations" << std::endl;
      }
    for (unsigned int i = 1; i < e.size(); ++i)
      {
        EXPECT_GT(std::log2(e[i - 1].first / e[i].first), 2.75);
        EXPECT_GT(std::log2(e[i - 1].second / e[i].second), 1.8);
      }
  }
} // namespace


TEST(StokesManufactured, OrdersOnUniformMesh)
{
  expect_orders({0.5, 0.25, 0.125}, {}, 0);
}


TEST(StokesManufactured, OrdersOnAdaptiveMeshAcrossPeriodicFaces)
{
  expect_orders({0.25, 0.125}, sphere_points(Point(-1., 1., 0.1), 0.5), 1);
}


TEST(StokesManufactured, SameAnswerOnAnyNumberOfRanks)
{
  const auto    band = sphere_points(Point(-1., 1., 0.1), 0.5);
  const Problem together(MPI_COMM_WORLD, 0.5, 0.125, band), alone(MPI_COMM_SELF, 0.5, 0.125, band);
  LinearReport  report;
  const auto    u = together.solve<Manufactured>(report);
  EXPECT_TRUE(report.converged);
  const auto v = alone.solve<Manufactured>(report);
  EXPECT_TRUE(report.converged);
  const auto eu = errors<Manufactured>(together.space, u), ev = errors<Manufactured>(alone.space, v);
  EXPECT_NEAR(eu.first, ev.first, 1e-10);
  EXPECT_NEAR(eu.second, ev.second, 1e-10);
  EXPECT_EQ(together.mesh.triangulation().n_global_active_cells(), alone.mesh.triangulation().n_global_active_cells());

  // Values at points, through the interpolation of condensed vectors (the part that is zero at the walls).
  PointInterpolation at_together(together.space), at_alone(alone.space);
  at_together.reinit(sphere_points(Point(0.9, -0.8, 0.), 0.7));
  at_alone.reinit(sphere_points(Point(0.9, -0.8, 0.), 0.7));
  std::vector<double> a, b;
  at_together.values(u, a);
  at_alone.values(v, b);
  double difference = 0.;
  for (unsigned int i = 0; i < a.size(); ++i)
    difference = std::max(difference, std::abs(a[i] - b[i]));
  EXPECT_LT(difference, 1e-10);
}


TEST(Stokes, UndisturbedShearIsExact)
{
  const Problem problem(MPI_COMM_WORLD, 0.5, 0.125, sphere_points(Point(0.9, 0.2, 0.), 0.5));
  LinearReport  report;
  const auto    solution = problem.solve<Shear>(report);
  EXPECT_TRUE(report.converged);
  const auto e = errors<Shear>(problem.space, solution);
  EXPECT_LT(e.first, 1e-10);
  EXPECT_LT(e.second, 1e-9);
}


TEST(Stokes, AgreesWithDirectSolver)
{
  const Problem    problem(MPI_COMM_WORLD, 1., 0.5, sphere_points(Point(-0.9, 0.2, 0.), 0.2));
  const auto      &space = problem.space;
  LinearReport     report;
  FluidBlockVector rhs, x;
  space.reinit(rhs);
  space.reinit(x);
  add_body_force<Manufactured>(space, rhs);
  report = solve_fgmres(problem.stokes, problem.preconditioner, x, rhs, 1e-12, 200);
  EXPECT_TRUE(report.converged);

  // One matrix of everything, built column by column from the operator itself on this tiny mesh; the free pressure constant is pinned by a rank-one term.
  const unsigned int n = rhs.size();
  dealii::IndexSet   owned(n);
  for (unsigned int b = 0, start = 0; b < 4; start += rhs.block(b).size(), ++b)
    {
      const auto range = rhs.block(b).get_partitioner()->local_range();
      owned.add_range(start + range.first, start + range.second);
    }
  dealii::TrilinosWrappers::SparseMatrix matrix(owned, owned, MPI_COMM_WORLD, n);
  FluidBlockVector                       unit, column;
  space.reinit(unit);
  space.reinit(column);
  for (unsigned int j = 0; j < n; ++j)
    {
      unit = 0.;
      if (owned.is_element(j))
        unit(j) = 1.;
      problem.stokes.vmult(column, unit);
      for (const auto i : owned)
        {
          const bool pressure = i >= n - rhs.block(3).size() && j >= n - rhs.block(3).size();
          const auto p_i = i - (n - rhs.block(3).size()), p_j = j - (n - rhs.block(3).size());
          double     entry = column(i);
          if (pressure && space.pressure.constraints().is_constrained(p_i) && i == j)
            entry = 1.;
          if (pressure && i == j && p_i == p_j && p_i == 0)
            entry -= 1.;
          if (entry != 0.)
            matrix.set(i, j, entry);
        }
    }
  matrix.compress(dealii::VectorOperation::insert);
  dealii::TrilinosWrappers::MPI::Vector b(owned, MPI_COMM_WORLD), y(owned, MPI_COMM_WORLD);
  for (const auto i : owned)
    b(i) = rhs(i);
  b.compress(dealii::VectorOperation::insert);
  dealii::SolverControl                  control(1, 1e-10, false, false);
  dealii::TrilinosWrappers::SolverDirect direct(control, dealii::TrilinosWrappers::SolverDirect::AdditionalData(false, "Amesos_Mumps"));
  direct.solve(matrix, y, b);

  double difference = 0., size = 0.;
  for (const auto i : owned)
    if (i < n - rhs.block(3).size())
      {
        difference = std::max(difference, std::abs(y(i) - x(i)));
        size       = std::max(size, std::abs(y(i)));
      }
  EXPECT_GT(dealii::Utilities::MPI::max(size, MPI_COMM_WORLD), 0.1);
  EXPECT_LT(difference, 1e-9);
}


TEST(FluidMesh, IsFineAtTheShellAndForgetsItsHistory)
{
  FluidMesh  mesh(MPI_COMM_WORLD, side, Problem::parameters(0.5, 0.0625)), fresh(MPI_COMM_WORLD, side, Problem::parameters(0.5, 0.0625));
  const auto first = sphere_points(Point(-0.5, 0.9, 0.), 0.4), second = sphere_points(Point(0.9, 0.9, 0.1), 0.3);
  EXPECT_TRUE(mesh.adapt(first));
  EXPECT_FALSE(mesh.adapt(first));
  EXPECT_TRUE(mesh.covers(first));
  EXPECT_FALSE(mesh.covers(second));
  EXPECT_TRUE(mesh.adapt(second));
  EXPECT_TRUE(mesh.covers(second));
  fresh.adapt(second);
  EXPECT_EQ(mesh.triangulation().n_global_active_cells(), fresh.triangulation().n_global_active_cells());
  EXPECT_EQ(mesh.triangulation().get_checksum(), fresh.triangulation().get_checksum());
}


TEST(PointInterpolation, FindsTheCellsDealiiFinds)
{
  const Problem                                               problem(MPI_COMM_SELF, 0.5, 0.125, sphere_points(Point(0.9, 0.2, 0.), 0.5));
  const CellLocator                                           locator(problem.mesh);
  std::vector<dealii::Triangulation<3>::active_cell_iterator> cells;
  for (const auto &cell : problem.mesh.triangulation().active_cell_iterators())
    cells.push_back(cell);
  std::mt19937                           random(1);
  std::uniform_real_distribution<double> coordinate(-0.999, 0.999);
  for (unsigned int i = 0; i < 300; ++i)
    {
      Point      x(coordinate(random), coordinate(random), coordinate(random));
      const auto expected = dealii::GridTools::find_active_cell_around_point(dealii::StaticMappingQ1<3>::mapping, problem.mesh.triangulation(), x);
      const auto found    = locator.locate(x);
      EXPECT_EQ(cells[found.cell], expected.first);
      EXPECT_LT(found.unit.distance(expected.second), 1e-10);
      const auto wrapped = locator.locate(x + Point(2. * side, -side, 0.));
      EXPECT_EQ(wrapped.cell, found.cell);
      EXPECT_LT(wrapped.unit.distance(found.unit), 1e-12);
    }
}


TEST(PointInterpolation, CellAndPositionAgreeWithinRoundingOfFaces)
{
  // Symmetric capsules have points within rounding of faces. Whichever cell is taken, the position in it must be that of the point; a box whose cells are not powers of
  // two makes formulas that round differently disagree.
  FluidMeshParameters parameters;
  parameters.coarsest_cell = 2.5;
  parameters.finest_cell   = 0.625;
  for (const double box : {10., 7.3})
    {
      FluidMesh mesh(MPI_COMM_SELF, box, parameters);
      mesh.adapt(sphere_points(Point(0.1, 0.2, 0.3), 1.));
      const CellLocator                                           locator(mesh);
      std::vector<dealii::Triangulation<3>::active_cell_iterator> cells;
      for (const auto &cell : mesh.triangulation().active_cell_iterators())
        cells.push_back(cell);
      for (int face = -3; face <= 3; ++face)
        for (int i = -100; i <= 100; ++i)
          {
            const double x     = face * mesh.cell_size(mesh.finest_level()) + i * 2e-17 * (1 + 5 * std::abs(face));
            const auto   found = locator.locate(Point(x, x, x));
            ASSERT_GE(found.cell, 0);
            const Point there = cells[found.cell]->vertex(0) + mesh.cell_size(cells[found.cell]->level()) * found.unit;
            ASSERT_LT(there.distance(Point(x, x, x)), 1e-13) << x << " in a box of " << box;
          }
    }
}


TEST(PointInterpolation, GradientIsDerivativeAndLoadIsTranspose)
{
  const Problem    problem(MPI_COMM_WORLD, 0.5, 0.125, sphere_points(Point(0.9, 0.2, 0.), 0.5));
  LinearReport     report;
  FluidBlockVector rhs, u;
  problem.space.reinit(rhs);
  problem.space.reinit(u);
  add_body_force<Manufactured>(problem.space, rhs);
  report = solve_fgmres(problem.stokes, problem.preconditioner, u, rhs, 1e-8, 200);
  ASSERT_TRUE(report.converged);

  auto               points = sphere_points(Point(0.93, 0.21, 0.), 0.61);
  PointInterpolation interpolation(problem.space);
  interpolation.reinit(points);
  std::vector<double> values, gradients, plus, minus;
  interpolation.values_and_gradients(u, values, gradients);
  const double epsilon = 1e-6;
  for (unsigned int d = 0; d < 3; ++d)
    {
      for (const double sign : {1., -1.})
        {
          auto moved = points;
          for (auto &x : moved)
            x[d] += sign * epsilon;
          interpolation.reinit(moved);
          interpolation.values(u, sign > 0 ? plus : minus);
        }
      for (unsigned int i = 0; i < values.size(); ++i)
        EXPECT_NEAR((plus[i] - minus[i]) / (2. * epsilon), gradients[3 * i + d], 1e-6);
    }

  interpolation.reinit(points);
  std::mt19937                     random(2);
  std::normal_distribution<double> normal;
  std::vector<double>              forces(values.size()), moments(gradients.size());
  for (double &f : forces)
    f = normal(random);
  for (double &m : moments)
    m = normal(random);
  FluidBlockVector load;
  problem.space.reinit(load);
  interpolation.add_load(forces, moments, load);
  double power = 0., scale = 0.;
  for (unsigned int i = 0; i < forces.size(); ++i)
    {
      power += forces[i] * values[i];
      scale += std::abs(forces[i] * values[i]);
    }
  for (unsigned int i = 0; i < moments.size(); ++i)
    {
      power += moments[i] * gradients[i];
      scale += std::abs(moments[i] * gradients[i]);
    }
  EXPECT_NEAR(load * u, power, 1e-12 * scale);
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ::testing::InitGoogleTest(&argc, argv);
  if (!is_root())
    delete ::testing::UnitTest::GetInstance()->listeners().Release(::testing::UnitTest::GetInstance()->listeners().default_result_printer());
  const int failed = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD);
}
