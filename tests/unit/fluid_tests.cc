// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the Stokes equations.

#include <deal.II/lac/trilinos_solver.h>

#include <tanktread/fluid/algebraic_preconditioner.h>

#include "full_arrays.h"
#include "stokes_problem.h"

using namespace tanktread;
using oracle::sphere_points;

namespace
{
  using Point = dealii::Point<3>;

  constexpr double side = 2.;

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

  /**
   * Sums over the free nodes of velocities and of pressures times random weights of their places, divided by the norms of both: almost any change of the
   * solution changes them.
   */
  std::array<double, 2>
  rough_functionals(const Problem &problem, const ComponentVector &solution, const unsigned int seed)
  {
    const TaylorHoodSpace &space = problem.fluid.space();
    FluidBlockVector       weights, values;
    space.reinit(weights);
    space.reinit(values);
    oracle::set_rough(space.mesh, *space.velocity, seed, weights.block(velocity_block));
    oracle::set_rough(space.mesh, *space.pressure, seed, weights.block(pressure_block));
    problem.assembled.to_nodes(solution, values);
    for (auto *vector : {&weights, &values}) // pressures are known up to a constant
      vector->block(pressure_block).add(-vector->block(pressure_block).mean_value());
    std::array<double, 2> result;
    for (const unsigned int b : {velocity_block, pressure_block})
      result[b] = weights.block(b) * values.block(b) / (weights.block(b).l2_norm() * values.block(b).l2_norm());
    return result;
  }
} // namespace


TEST(StokesManufactured, OrdersOnUniformMesh)
{
  expect_orders(Manufactured(), side, {0.5, 0.25, 0.125}, {}, 0);
}


TEST(StokesManufactured, OrdersOnAdaptiveMeshAcrossPeriodicFaces)
{
  expect_orders(Manufactured(), side, {0.25, 0.125}, sphere_points(Point(-1., 1., 0.1), 0.5), 1);
}


TEST(StokesManufactured, SameAnswerOnAnyNumberOfRanks)
{
  const auto    band = sphere_points(Point(-1., 1., 0.1), 0.5);
  const Problem together(MPI_COMM_WORLD, side, 0.5, 0.125, band), alone(MPI_COMM_SELF, side, 0.5, 0.125, band);
  LinearReport  report;
  const auto    u = together.solve(Manufactured(), report);
  EXPECT_TRUE(report.converged);
  const auto v = alone.solve(Manufactured(), report);
  EXPECT_TRUE(report.converged);
  const auto eu = errors(Manufactured(), together.assembled, u), ev = errors(Manufactured(), alone.assembled, v);
  EXPECT_NEAR(eu.first, ev.first, 1e-10);
  EXPECT_NEAR(eu.second, ev.second, 1e-10);
  EXPECT_EQ(together.fluid.mesh().triangulation().n_global_active_cells(), alone.fluid.mesh().triangulation().n_global_active_cells());
  for (const unsigned int seed : {1, 2, 3})
    {
      const auto a = rough_functionals(together, u, seed), b = rough_functionals(alone, v, seed);
      EXPECT_NEAR(a[velocity_block], b[velocity_block], 1e-12);
      EXPECT_NEAR(a[pressure_block], b[pressure_block], 1e-10); // residuals of 1e-12 come divided by the volume of a cell
    }
}


TEST(Stokes, UndisturbedShearIsExact)
{
  const Problem problem(MPI_COMM_WORLD, side, 0.5, 0.125, sphere_points(Point(0.9, 0.2, 0.), 0.5));
  LinearReport  report;
  const auto    solution = problem.solve(Shear(), report);
  EXPECT_TRUE(report.converged);
  const auto e = errors(Shear(), problem.assembled, solution);
  EXPECT_LT(e.first, 1e-10);
  EXPECT_LT(e.second, 1e-9);
}


namespace
{
  void
  expect_equals_the_assembled_operator(const Problem &problem)
  {
    const TaylorHoodSpace &space = problem.fluid.space();
    FluidBlockVector       x, Ax, difference;
    ComponentVector        y, Ay;
    for (auto *vector : {&x, &Ax, &difference})
      space.reinit(*vector);
    problem.assembled.reinit(y);
    problem.assembled.reinit(Ay);
    for (const unsigned int seed : {1, 2})
      {
        oracle::set_rough(space.mesh, *space.velocity, seed, x.block(velocity_block));
        oracle::set_rough(space.mesh, *space.pressure, seed, x.block(pressure_block));
        problem.fluid.stokes().vmult(Ax, x);
        problem.assembled.to_components(x, y);
        EXPECT_NEAR(y.l2_norm(), x.l2_norm(), 1e-13 * x.l2_norm());
        problem.assembled.vmult(Ay, y);
        problem.assembled.to_nodes(Ay, difference);
        EXPECT_NEAR(Ay.l2_norm(), difference.l2_norm(), 1e-13 * Ay.l2_norm()); // nothing is left at constrained degrees of freedom
        difference -= Ax;
        for (const unsigned int b : {velocity_block, pressure_block})
          EXPECT_LT(difference.block(b).linfty_norm(), 1e-13 * Ax.block(b).linfty_norm()) << "block " << b;
      }
  }
} // namespace


TEST(Stokes, EqualsTheAssembledOperator)
{
  for (const Point &centre : {Point(-1., 1., 0.1), Point(0.1, 0., -0.2), Point(0.9, 0.2, 0.55)}) // the last one is refined at a wall too
    for (const double coarse : {0.5, 0.4})
      {
        SCOPED_TRACE(centre);
        expect_equals_the_assembled_operator(Problem(MPI_COMM_WORLD, side, coarse, coarse / 4., sphere_points(centre, 0.4)));
      }
  for (const Scene &scene : scenes())
    {
      SCOPED_TRACE(scene.box.side[1]);
      expect_equals_the_assembled_operator(Problem(MPI_COMM_WORLD, scene.box, scene.coarsest, scene.finest, scene.band));
    }
}


TEST(Stokes, AlgebraicMultigridFindsTheSameSolution)
{
  const Problem    problem(MPI_COMM_WORLD, side, 0.5, 0.125, sphere_points(Point(-1., 1., 0.1), 0.5));
  ComponentVector  load, y;
  FluidBlockVector rhs, x, difference;
  for (auto *vector : {&load, &y})
    problem.assembled.reinit(*vector);
  for (auto *vector : {&rhs, &x, &difference})
    problem.fluid.space().reinit(*vector);
  add_body_force(Manufactured(), problem.assembled, load);
  problem.assembled.to_nodes(load, rhs);
  const LinearReport report = solve_fgmres(problem.fluid.stokes(), problem.fluid.preconditioner(), x, rhs, 1e-12, 200);
  const LinearReport other  = solve_fgmres(problem.assembled, AlgebraicPreconditioner(problem.assembled), y, load, 1e-12, 400);
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(other.converged);
  if (is_root())
    std::cout << report.iterations << " iterations, with algebraic multigrid " << other.iterations << std::endl;
  problem.assembled.to_nodes(y, difference);
  difference -= x;
  EXPECT_LT(difference.block(velocity_block).linfty_norm(), 1e-10 * x.block(velocity_block).linfty_norm());
}


TEST(AlgebraicStokes, EqualsTheMatrixFreeOperator)
{
  Fluid fluid(MPI_COMM_WORLD, side, cells(0.5, 0.125));
  fluid.adapt(sphere_points(Point(-1., 1., 0.1), 0.5));
  const AlgebraicStokes  algebraic(fluid.space());
  FluidBlockVector       x, y, z;
  const TaylorHoodSpace &space = fluid.space();
  for (auto *vector : {&x, &y, &z})
    space.reinit(*vector);
  oracle::set_rough(space.mesh, *space.velocity, 1, x.block(velocity_block));
  oracle::set_rough(space.mesh, *space.pressure, 1, x.block(pressure_block));
  fluid.stokes().vmult(y, x);
  algebraic.map().vmult(z, x);
  z -= y;
  for (const unsigned int b : {velocity_block, pressure_block})
    EXPECT_LT(z.block(b).linfty_norm(), 1e-12 * y.block(b).linfty_norm()) << "block " << b;
}


TEST(AlgebraicStokes, IterationsInAFluid)
{
  Fluid fluid(MPI_COMM_WORLD, side, cells(0.5, 0.125), StokesMethod::assembled);
  for (const Point &centre : {Point(0.1, 0., -0.2), Point(-1., 1., 0.1)}) // its meshes change
    {
      fluid.adapt(sphere_points(centre, 0.5));
      FluidBlockVector x, rhs, residual;
      for (auto *vector : {&x, &rhs, &residual})
        fluid.space().reinit(*vector);
      oracle::set_rough(fluid.mesh(), *fluid.space().velocity, 1, rhs.block(velocity_block));
      const LinearReport report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), x, rhs, 1e-6, 200);
      EXPECT_TRUE(report.converged);
      EXPECT_LT(report.iterations, 40u);
      StokesOperator(fluid.space()).vmult(residual, x);
      residual -= rhs;
      EXPECT_LT(residual.l2_norm(), 2e-6 * rhs.l2_norm());
      if (is_root())
        std::cout << report.iterations << " iterations" << std::endl;
    }
  fluid.set_shift(0.);
  EXPECT_THROW(fluid.set_shift(1.), std::logic_error);
  EXPECT_THROW(fluid.set_viscosity(Viscosity(std::vector<double>(27 * fluid.space().velocity->n_cells(), 2.), 1., {})), std::logic_error);
}


TEST(Stokes, SolverDoesNotDependOnTheSizeOfTheLoad)
{
  // With loads of any size the solver takes the same iterations; a residual of 1e14 is no reason to start again after each of them.
  const Problem    problem(MPI_COMM_WORLD, side, 1., 0.5, sphere_points(Point(-0.9, 0.2, 0.), 0.2));
  const auto      &space = problem.fluid.space();
  FluidBlockVector rhs;
  ComponentVector  load;
  space.reinit(rhs);
  problem.assembled.reinit(load);
  add_body_force(Manufactured(), problem.assembled, load);
  problem.assembled.to_nodes(load, rhs);
  std::vector<unsigned int> iterations;
  for (const double size : {1., 1e14, 1e-14})
    {
      FluidBlockVector x, scaled(rhs);
      space.reinit(x);
      scaled *= size / rhs.l2_norm();
      const LinearReport report = solve_fgmres(problem.fluid.stokes(), problem.fluid.preconditioner(), x, scaled, 1e-6, 200);
      EXPECT_TRUE(report.converged) << size;
      iterations.push_back(report.iterations);
    }
  EXPECT_EQ(iterations[1], iterations[0]);
  EXPECT_EQ(iterations[2], iterations[0]);
}


TEST(Stokes, AgreesWithDirectSolver)
{
  const Problem    problem(MPI_COMM_WORLD, side, 1., 0.5, sphere_points(Point(-0.9, 0.2, 0.), 0.2));
  const auto      &space = problem.fluid.space();
  FluidBlockVector rhs, x;
  ComponentVector  load;
  space.reinit(rhs);
  space.reinit(x);
  problem.assembled.reinit(load);
  add_body_force(Manufactured(), problem.assembled, load);
  problem.assembled.to_nodes(load, rhs);
  const LinearReport report = solve_fgmres(problem.fluid.stokes(), problem.fluid.preconditioner(), x, rhs, 1e-12, 200);
  EXPECT_TRUE(report.converged);

  // One matrix of everything, built column by column from the operator itself on this tiny mesh; the free pressure constant is pinned at one node.
  const unsigned int n = rhs.size(), n_u = rhs.block(velocity_block).size();
  dealii::IndexSet   owned(n);
  for (unsigned int b = 0, start = 0; b < 2; start += rhs.block(b).size(), ++b)
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
      problem.fluid.stokes().vmult(column, unit);
      for (const auto i : owned)
        {
          const double entry = column(i) - (i == j && i == n_u ? 1. : 0.);
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
    if (i < n_u)
      {
        difference = std::max(difference, std::abs(y(i) - x(i)));
        size       = std::max(size, std::abs(y(i)));
      }
  EXPECT_GT(dealii::Utilities::MPI::max(size, MPI_COMM_WORLD), 0.1);
  EXPECT_LT(difference, 1e-9);
}
