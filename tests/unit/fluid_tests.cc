// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the fluid mesh and the Stokes equations.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_solver.h>

#include <gtest/gtest.h>
#include <oracle/algebraic_preconditioner.h>
#include <oracle/assembled_stokes.h>
#include <oracle/node_values.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/compat.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/linear_solver.h>

#include <iostream>

using namespace tanktread;
using oracle::ComponentVector;
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

  /** The fluid and the assembled equations on its mesh. */
  struct Problem
  {
    Problem(const MPI_Comm comm, const double coarse, const double fine, const std::vector<Point> &band)
      : fluid(comm, side, parameters(coarse, fine))
      , adapted(fluid.adapt(band))
      , assembled(fluid.mesh())
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
    ComponentVector
    solve(LinearReport &report) const;

    Fluid                   fluid;
    bool                    adapted;
    oracle::AssembledStokes assembled;
  };

  /** Nodal interpolant at the wall nodes, zero elsewhere, constraints other than the walls' resolved. */
  template <typename Solution>
  ComponentVector
  wall_values(const oracle::AssembledStokes &stokes)
  {
    ComponentVector lift;
    stokes.reinit(lift);
    const auto                                  &dofs = stokes.velocity().dofs();
    std::vector<dealii::types::global_dof_index> indices(27);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(indices);
          for (unsigned int a = 0; a < 27; ++a)
            {
              const Point x = cell->vertex(0) + stokes.mesh().cell_size(cell->level()) * dofs.get_fe().unit_support_point(a);
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
  add_body_force(const oracle::AssembledStokes &stokes, ComponentVector &rhs)
  {
    const dealii::QGauss<3>                      quadrature(4);
    dealii::FEValues<3>                          values(stokes.velocity().dofs().get_fe(),
                               quadrature,
                               dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
    std::vector<dealii::types::global_dof_index> indices(27);
    for (const auto &cell : stokes.velocity().dofs().active_cell_iterators())
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
              stokes.velocity().constraints().distribute_local_to_global(load, indices, rhs.block(c));
            }
        }
    rhs.compress(dealii::VectorOperation::add);
  }

  template <typename Solution>
  ComponentVector
  Problem::solve(LinearReport &report) const
  {
    ComponentVector load, correction, result = wall_values<Solution>(assembled);
    assembled.reinit(load);
    assembled.reinit(correction);
    add_body_force<Solution>(assembled, load);
    assembled.subtract_applied(result, load);

    FluidBlockVector rhs, x;
    fluid.space().reinit(rhs);
    fluid.space().reinit(x);
    assembled.to_nodes(fluid.space(), load, rhs);
    // What the walls let in and out cancels only up to quadrature: take the part out that no velocity can balance.
    rhs.block(pressure_block).add(-rhs.block(pressure_block).mean_value());
    report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), x, rhs, 1e-12, 200);

    assembled.to_components(fluid.space(), x, correction);
    result.zero_out_ghost_values();
    for (unsigned int b = 0; b < 4; ++b)
      {
        (b < 3 ? assembled.velocity() : assembled.pressure()).constraints().distribute(correction.block(b));
        result.block(b) += correction.block(b);
      }
    result.update_ghost_values();
    return result;
  }

  /** L2 norms of the errors of velocity and pressure, the pressure's mean removed. */
  template <typename Solution>
  std::pair<double, double>
  errors(const oracle::AssembledStokes &stokes, const ComponentVector &solution)
  {
    const dealii::QGauss<3> quadrature(5);
    const auto              flags = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    dealii::FEValues<3>     u(stokes.velocity().dofs().get_fe(), quadrature, flags), p(stokes.pressure().dofs().get_fe(), quadrature, flags);
    std::vector<double>     values(quadrature.size());
    double                  eu = 0., ep = 0., mean = 0.;
    for (const auto &cell : stokes.velocity().dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          u.reinit(cell);
          for (unsigned int c = 0; c < 3; ++c)
            {
              u.get_function_values(solution.block(c), values);
              for (const auto q : u.quadrature_point_indices())
                eu += std::pow(values[q] - Solution::velocity(u.quadrature_point(q))[c], 2) * u.JxW(q);
            }
          p.reinit(dealii::DoFHandler<3>::active_cell_iterator(&stokes.mesh().triangulation(), cell->level(), cell->index(), &stokes.pressure().dofs()));
          p.get_function_values(solution.block(3), values);
          for (const auto q : p.quadrature_point_indices())
            {
              const double e = values[q] - Solution::pressure(p.quadrature_point(q));
              ep += e * e * p.JxW(q);
              mean += e * p.JxW(q);
            }
        }
    const MPI_Comm comm = stokes.mesh().communicator();
    mean                = dealii::Utilities::MPI::sum(mean, comm);
    ep                  = dealii::Utilities::MPI::sum(ep, comm) - mean * mean / (side * side * side);
    return {std::sqrt(dealii::Utilities::MPI::sum(eu, comm)), std::sqrt(ep)};
  }

  /** Sums over the free nodes of velocities and of pressures times random weights of their places, divided by the norms of both: almost any change of the solution changes them. */
  std::array<double, 2>
  rough_functionals(const Problem &problem, const ComponentVector &solution, const unsigned int seed)
  {
    const TaylorHoodSpace &space = problem.fluid.space();
    FluidBlockVector       weights, values;
    space.reinit(weights);
    space.reinit(values);
    oracle::set_rough(space.mesh, *space.velocity, seed, weights.block(velocity_block));
    oracle::set_rough(space.mesh, *space.pressure, seed, weights.block(pressure_block));
    problem.assembled.to_nodes(space, solution, values);
    for (auto *vector : {&weights, &values}) // pressures are known up to a constant
      vector->block(pressure_block).add(-vector->block(pressure_block).mean_value());
    std::array<double, 2> result;
    for (const unsigned int b : {velocity_block, pressure_block})
      result[b] = weights.block(b) * values.block(b) / (weights.block(b).l2_norm() * values.block(b).l2_norm());
    return result;
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
        e.push_back(errors<Manufactured>(problem.assembled, solution));
        if (is_root())
          std::cout << "coarse cell " << coarse << ": " << problem.fluid.mesh().triangulation().n_global_active_cells() << " cells, error u " << e.back().first
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
  const auto eu = errors<Manufactured>(together.assembled, u), ev = errors<Manufactured>(alone.assembled, v);
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
  const Problem problem(MPI_COMM_WORLD, 0.5, 0.125, sphere_points(Point(0.9, 0.2, 0.), 0.5));
  LinearReport  report;
  const auto    solution = problem.solve<Shear>(report);
  EXPECT_TRUE(report.converged);
  const auto e = errors<Shear>(problem.assembled, solution);
  EXPECT_LT(e.first, 1e-10);
  EXPECT_LT(e.second, 1e-9);
}


TEST(Stokes, EqualsTheAssembledOperator)
{
  for (const Point &centre : {Point(-1., 1., 0.1), Point(0.1, 0., -0.2), Point(0.9, 0.2, 0.55)}) // the last one is refined at a wall too
    for (const double coarse : {0.5, 0.4})
      {
        const Problem          problem(MPI_COMM_WORLD, coarse, coarse / 4., sphere_points(centre, 0.4));
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
            problem.assembled.to_components(space, x, y);
            EXPECT_NEAR(y.l2_norm(), x.l2_norm(), 1e-13 * x.l2_norm());
            problem.assembled.vmult(Ay, y);
            problem.assembled.to_nodes(space, Ay, difference);
            EXPECT_NEAR(Ay.l2_norm(), difference.l2_norm(), 1e-13 * Ay.l2_norm()); // nothing is left at constrained degrees of freedom
            difference -= Ax;
            for (const unsigned int b : {velocity_block, pressure_block})
              EXPECT_LT(difference.block(b).linfty_norm(), 1e-13 * Ax.block(b).linfty_norm()) << "block " << b << ", centre " << centre;
          }
      }
}


TEST(Stokes, AlgebraicMultigridFindsTheSameSolution)
{
  const Problem    problem(MPI_COMM_WORLD, 0.5, 0.125, sphere_points(Point(-1., 1., 0.1), 0.5));
  ComponentVector  load, y;
  FluidBlockVector rhs, x, difference;
  for (auto *vector : {&load, &y})
    problem.assembled.reinit(*vector);
  for (auto *vector : {&rhs, &x, &difference})
    problem.fluid.space().reinit(*vector);
  add_body_force<Manufactured>(problem.assembled, load);
  problem.assembled.to_nodes(problem.fluid.space(), load, rhs);
  const LinearReport report = solve_fgmres(problem.fluid.stokes(), problem.fluid.preconditioner(), x, rhs, 1e-12, 200);
  const LinearReport other  = solve_fgmres(problem.assembled, oracle::AlgebraicPreconditioner(problem.assembled), y, load, 1e-12, 400);
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(other.converged);
  if (is_root())
    std::cout << report.iterations << " iterations, with algebraic multigrid " << other.iterations << std::endl;
  problem.assembled.to_nodes(problem.fluid.space(), y, difference);
  difference -= x;
  EXPECT_LT(difference.block(velocity_block).linfty_norm(), 1e-10 * x.block(velocity_block).linfty_norm());
}


TEST(Stokes, AgreesWithDirectSolver)
{
  const Problem    problem(MPI_COMM_WORLD, 1., 0.5, sphere_points(Point(-0.9, 0.2, 0.), 0.2));
  const auto      &space = problem.fluid.space();
  FluidBlockVector rhs, x;
  ComponentVector  load;
  space.reinit(rhs);
  space.reinit(x);
  problem.assembled.reinit(load);
  add_body_force<Manufactured>(problem.assembled, load);
  problem.assembled.to_nodes(space, load, rhs);
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


TEST(FluidMesh, GrowsFromFewCells)
{
  struct Expected
  {
    int          asked, n_rung_0; // cells along each axis
    unsigned int coarsest_level;
  };
  for (const Expected &e : {Expected{2, 2, 0}, {3, 3, 0}, {4, 4, 0}, {5, 5, 0}, {6, 3, 1}, {8, 4, 1}, {10, 5, 1}, {16, 4, 2}})
    {
      FluidMesh mesh(MPI_COMM_WORLD, side, Problem::parameters(side / e.asked, side / e.asked / 3.));
      EXPECT_EQ(mesh.n_rung_0(), e.n_rung_0);
      EXPECT_EQ(mesh.coarsest_level(), e.coarsest_level);
      EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.coarsest_level()), side / e.asked);
      EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.finest_level()), side / e.asked / 4.); // the first level not coarser than asked for
      EXPECT_EQ(mesh.triangulation().n_global_active_cells(), std::pow(e.n_rung_0, 3));
      EXPECT_TRUE(mesh.adapt({}));
      EXPECT_EQ(mesh.triangulation().n_global_active_cells(), std::pow(e.asked, 3));
      EXPECT_FALSE(mesh.adapt({}));
    }
}


TEST(FluidMesh, ClimbsOneLevelARung)
{
  FluidMesh  mesh(MPI_COMM_WORLD, side, Problem::parameters(0.25, 0.0625)), whole(MPI_COMM_WORLD, side, Problem::parameters(0.25, 0.0625));
  const auto points = sphere_points(Point(-1., 0.9, 0.1), 0.3);
  whole.adapt(points);
  EXPECT_TRUE(mesh.aim_at(points));
  EXPECT_FALSE(mesh.aim_at(points));
  for (unsigned int rung = 0; rung < mesh.finest_level(); ++rung, mesh.climb())
    {
      EXPECT_FALSE(mesh.on_last_rung());
      EXPECT_EQ(mesh.triangulation().n_global_levels(), rung + 1);
    }
  EXPECT_TRUE(mesh.on_last_rung());
  EXPECT_EQ(mesh.triangulation().n_global_levels(), mesh.finest_level() + 1);
  EXPECT_EQ(mesh.triangulation().get_checksum(), whole.triangulation().get_checksum());
  mesh.restart();
  EXPECT_EQ(mesh.triangulation().n_global_active_cells(), std::pow(mesh.n_rung_0(), 3));
}


TEST(FluidMesh, BandIsAsWideAsAskedFor)
{
  FluidMesh mesh(MPI_COMM_WORLD, side, Problem::parameters(0.5, 0.0625));
  // Off the faces of cells, or rounding decides. The periodic faces are crossed, and the wall z = 1 is reached.
  const std::vector<Point> points = {Point(0.013, -0.017, 0.011), Point(-0.99, 0.98, 0.3), Point(0.4, 5.41, 0.97)};
  mesh.adapt(points);
  const double width        = 1.5 * mesh.cell_size(mesh.finest_level());
  unsigned int n_too_coarse = 0, n_fine = 0;
  for (const auto &cell : mesh.triangulation().active_cell_iterators())
    if (cell->is_locally_owned())
      {
        const bool fine = static_cast<unsigned int>(cell->level()) == mesh.finest_level();
        n_fine += fine;
        for (const Point &x : points)
          {
            double distance = 0.; // in the coordinate in which it is largest
            for (unsigned int d = 0; d < 3; ++d)
              {
                const double difference = x[d] - cell->center()[d];
                distance                = std::max(distance, std::abs(d < 2 ? std::remainder(difference, side) : difference));
              }
            n_too_coarse += !fine && distance - 0.5 * mesh.cell_size(cell->level()) < width;
          }
      }
  EXPECT_EQ(dealii::Utilities::MPI::sum(n_too_coarse, MPI_COMM_WORLD), 0u);
  // Each band is four or so cells wide, rounded outwards to whole parents: at most six along each axis.
  EXPECT_LE(dealii::Utilities::MPI::sum(n_fine, MPI_COMM_WORLD), 3u * 6 * 6 * 6);
  EXPECT_THROW(mesh.aim_at({Point(0., 0., 1.01)}), NumericalError);
  EXPECT_THROW(mesh.aim_at({Point(0., 0., std::nan(""))}), NumericalError);
}


TEST(FluidMesh, GradingWidensTheBandOfEachSize)
{
  const std::vector<Point>  points     = {Point(0.013, -0.017, 0.011), Point(-0.99, 0.98, 0.3)};
  FluidMeshParameters       parameters = Problem::parameters(0.5, 0.03125);
  std::vector<unsigned int> n_cells;
  for (const unsigned int grading : {0, 1, 3})
    {
      parameters.grading = grading;
      FluidMesh mesh(MPI_COMM_WORLD, side, parameters);
      mesh.adapt(points);
      unsigned int n_too_coarse = 0;
      for (const auto &cell : mesh.triangulation().active_cell_iterators())
        if (const unsigned int level = cell->level() + 1; cell->is_locally_owned() && level < mesh.finest_level())
          for (const Point &x : points)
            {
              // Gap between this cell and the cube half as large around the point.
              const auto   place = mesh.place(x, level);
              const double h     = mesh.cell_size(level);
              double       gap   = 0.;
              for (unsigned int d = 0; d < 3; ++d)
                {
                  const double difference = cell->center()[d] - (-0.5 * side + h * (place.key.position[d] + 0.5));
                  gap                     = std::max(gap, std::abs(d < 2 ? std::remainder(difference, side) : difference) - 1.5 * h);
                }
              n_too_coarse += gap < (grading > 0 ? grading : 3) * h - 1e-9;
            }
      if (grading > 0)
        EXPECT_EQ(dealii::Utilities::MPI::sum(n_too_coarse, MPI_COMM_WORLD), 0u);
      else
        EXPECT_GT(dealii::Utilities::MPI::sum(n_too_coarse, MPI_COMM_WORLD), 0u);
      n_cells.push_back(mesh.triangulation().n_global_active_cells());
      EXPECT_TRUE(mesh.covers(points));
      EXPECT_FALSE(mesh.adapt(points));
    }
  EXPECT_LT(n_cells[1], n_cells[2]);
}
