// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about where points are and what velocity they see.

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/point_interpolation.h>

#include <algorithm>
#include <random>

#include "nodal_velocity.h"

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

  std::vector<Point>
  random_points(const unsigned int n)
  {
    std::mt19937                           random(1);
    std::uniform_real_distribution<double> coordinate(-0.999, 0.999);
    std::vector<Point>                     points;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
        points.emplace_back(x, y, z);
      }
    return points;
  }

  FluidMeshParameters
  cells(const double coarsest, const double finest)
  {
    FluidMeshParameters p;
    p.coarsest_cell = coarsest;
    p.finest_cell   = finest;
    return p;
  }

  /** A mesh with three sizes of cells that is fine around an edge of the box, so that it has hanging nodes on the periodic faces. */
  struct Problem
  {
    explicit Problem(const MPI_Comm comm)
      : mesh(comm, side, cells(0.5, 0.125))
      , adapted(mesh.adapt(sphere_points(Point(-1., 1., 0.1), 0.5)))
      , space(mesh)
    {}

    FluidMesh       mesh;
    bool            adapted;
    TaylorHoodSpace space;
  };

  /** Points all over the box, none on a face. */
  const std::vector<Point> &
  probes()
  {
    static const std::vector<Point> points = [] {
      std::vector<Point> result = random_points(300);
      for (const Point &x : sphere_points(Point(-0.93, 1.01, 0.1), 0.61))
        result.push_back(x);
      return result;
    }();
    return points;
  }

  std::vector<double>
  random_numbers(const std::size_t n, const unsigned int seed)
  {
    std::mt19937                     random(seed);
    std::normal_distribution<double> normal;
    std::vector<double>              result(n);
    std::generate(result.begin(), result.end(), [&]() { return normal(random); });
    return result;
  }

  /** Of an array of all points, width numbers a point, those of the points on this rank. */
  std::vector<double>
  local_part(const PointInterpolation &interpolation, const std::vector<double> &all, const unsigned int width)
  {
    std::vector<double> result;
    for (const unsigned int q : interpolation.local_points())
      result.insert(result.end(), all.begin() + width * q, all.begin() + width * (q + 1));
    return result;
  }

  double
  largest_difference(const std::vector<double> &a, const std::vector<double> &b)
  {
    double result = a.size() == b.size() ? 0. : 1e300;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      result = std::max(result, std::abs(a[i] - b[i]));
    return result;
  }

  /** The same field in deal.II's numbering, component by component: free nodes from the vector, all others from deal.II's constraints. */
  std::vector<FluidVector>
  in_dealii_numbering(const TaylorHoodSpace &space, const ScalarSpace &scalar, const FluidBlockVector &u)
  {
    const auto                                  &dofs  = scalar.dofs();
    const auto                                   order = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(2);
    std::vector<FluidVector>                     fields(3, FluidVector(scalar.partitioner()));
    std::vector<dealii::types::global_dof_index> indices(27);
    unsigned int                                 index = 0;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(indices);
          const unsigned int *const nodes = space.velocity->cell_nodes(index++);
          for (unsigned int a = 0; a < 27; ++a)
            if (nodes[a] < space.velocity->n_owned() && dofs.locally_owned_dofs().is_element(indices[order[a]]))
              for (unsigned int c = 0; c < 3; ++c)
                fields[c](indices[order[a]]) = u.block(velocity_block).local_element(3 * nodes[a] + c);
        }
    for (FluidVector &field : fields)
      {
        scalar.constraints().distribute(field);
        field.update_ghost_values();
      }
    return fields;
  }
} // namespace


TEST(CellLocator, FindsTheCellsDealiiFinds)
{
  FluidMesh mesh(MPI_COMM_SELF, side, cells(0.5, 0.125));
  mesh.adapt(sphere_points(Point(0.9, 0.2, 0.), 0.5));
  const CellLocator                                           locator(mesh);
  std::vector<dealii::Triangulation<3>::active_cell_iterator> cells;
  for (const auto &cell : mesh.triangulation().active_cell_iterators())
    cells.push_back(cell);
  for (const Point &x : random_points(300))
    {
      const auto expected = dealii::GridTools::find_active_cell_around_point(dealii::StaticMappingQ1<3>::mapping, mesh.triangulation(), x);
      const auto found    = locator.locate(x);
      ASSERT_GE(found.cell, 0);
      EXPECT_EQ(cells[found.cell], expected.first);
      EXPECT_LT(found.unit.distance(expected.second), 1e-10);
      const auto wrapped = locator.locate(x + Point(2. * side, -side, 0.));
      EXPECT_EQ(wrapped.cell, found.cell);
      EXPECT_LT(wrapped.unit.distance(found.unit), 1e-12);
    }
}


TEST(CellLocator, CellAndPositionAgreeWithinRoundingOfFaces)
{
  // Symmetric capsules have points within rounding of faces. Whichever cell is taken, the position in it must be that of the point; a box whose cells are not
  // powers of
  // two makes formulas that round differently disagree.
  for (const double box : {10., 7.3})
    {
      FluidMesh mesh(MPI_COMM_SELF, box, cells(2.5, 0.625));
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


TEST(PointInterpolation, EveryPointIsOnOneRank)
{
  const Problem      problem(MPI_COMM_WORLD);
  PointInterpolation interpolation(problem.space);
  // On faces, edges and corners too, of which some belong to cells of several ranks.
  std::vector<Point> points = probes();
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      for (int k = -7; k <= 7; ++k)
        points.emplace_back(0.125 * i, 0.125 * j, 0.125 * k);
  interpolation.reinit(points);
  std::vector<unsigned int> times(points.size(), 0);
  for (const unsigned int q : interpolation.local_points())
    ++times[q];
  dealii::Utilities::MPI::sum(times, MPI_COMM_WORLD, times);
  EXPECT_EQ(*std::min_element(times.begin(), times.end()), 1u);
  EXPECT_EQ(*std::max_element(times.begin(), times.end()), 1u);
  EXPECT_TRUE(std::is_sorted(interpolation.local_points().begin(), interpolation.local_points().end()));

  points.back()[2] = 1.01;
  EXPECT_THROW(interpolation.reinit(points), NumericalError);
  points.back()[2] = std::nan("");
  EXPECT_THROW(interpolation.reinit(points), NumericalError);
}


TEST(PointInterpolation, AgreesWithDealiiAtHangingNodesAndPeriodicFaces)
{
  const Problem          problem(MPI_COMM_WORLD);
  const TaylorHoodSpace &space = problem.space;
  const auto             u     = nodal_velocity(space, Waves(side));
  PointInterpolation     interpolation(space);
  interpolation.reinit(probes());
  std::vector<double> values, gradients, laplacians;
  interpolation.values_and_gradients(u, values, gradients);
  interpolation.laplacians(u, laplacians);

  const ScalarSpace              scalar(space.mesh, 2, true);
  const auto                    &dofs   = scalar.dofs();
  const std::vector<FluidVector> fields = in_dealii_numbering(space, scalar, u);

  const auto &mapping = dealii::StaticMappingQ1<3>::mapping;
  double      error = 0., gradient_error = 0., laplacian_error = 0., size = 0.;
  for (unsigned int r = 0; r < interpolation.local_points().size(); ++r)
    {
      Point x = probes()[interpolation.local_points()[r]];
      for (unsigned int d = 0; d < 2; ++d)
        x[d] -= side * std::floor(x[d] / side + 0.5);
      auto cell = dofs.begin_active();
      while (cell != dofs.end() && !(cell->is_locally_owned() && cell->point_inside(x)))
        ++cell;
      ASSERT_NE(cell, dofs.end());
      dealii::FEValues<3> shapes(mapping,
                                 dofs.get_fe(),
                                 dealii::Quadrature<3>(mapping.transform_real_to_unit_cell(cell, x)),
                                 dealii::update_values | dealii::update_gradients | dealii::update_hessians);
      shapes.reinit(cell);
      for (unsigned int c = 0; c < 3; ++c)
        {
          std::vector<double>               value(1);
          std::vector<dealii::Tensor<1, 3>> slope(1);
          std::vector<double>               laplacian(1);
          shapes.get_function_laplacians(fields[c], laplacian);
          laplacian_error = std::max(laplacian_error, std::abs(laplacians[3 * r + c] - laplacian[0]));
          shapes.get_function_values(fields[c], value);
          shapes.get_function_gradients(fields[c], slope);
          size  = std::max(size, std::abs(value[0]));
          error = std::max(error, std::abs(values[3 * r + c] - value[0]));
          for (unsigned int d = 0; d < 3; ++d)
            gradient_error = std::max(gradient_error, std::abs(gradients[9 * r + 3 * c + d] - slope[0][d]));
        }
    }
  EXPECT_GT(size, 0.5);
  EXPECT_LT(error, 1e-12);
  EXPECT_LT(gradient_error, 1e-11);
  EXPECT_LT(laplacian_error, 1e-9);

  std::vector<double> again;
  interpolation.values(u, again);
  EXPECT_LT(largest_difference(again, values), 1e-13);
  interpolation.gradients(u, again);
  EXPECT_LT(largest_difference(again, gradients), 1e-12);
}


TEST(PointInterpolation, GradientIsDerivativeAndLoadIsTranspose)
{
  const Problem      problem(MPI_COMM_WORLD);
  const auto        &points = probes();
  PointInterpolation interpolation(problem.space);
  interpolation.reinit(points);
  FluidBlockVector u;
  problem.space.reinit(u);
  const auto random = random_numbers(u.block(velocity_block).locally_owned_size(), 5 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  std::copy(random.begin(), random.end(), u.block(velocity_block).begin());

  std::vector<double> values, gradients, plus, minus;
  interpolation.values_and_gradients(u, values, gradients);
  const auto   local_points = interpolation.local_points();
  const double epsilon      = 1e-6;
  for (unsigned int d = 0; d < 3; ++d)
    {
      for (const double sign : {1., -1.})
        {
          auto moved = points;
          for (auto &x : moved)
            x[d] += sign * epsilon;
          interpolation.reinit(moved);
          ASSERT_EQ(interpolation.local_points(), local_points);
          interpolation.values(u, sign > 0 ? plus : minus);
        }
      for (unsigned int i = 0; i < values.size(); ++i)
        EXPECT_NEAR((plus[i] - minus[i]) / (2. * epsilon), gradients[3 * i + d], 1e-6);
    }

  interpolation.reinit(points);
  const auto forces  = random_numbers(values.size(), 2 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  const auto moments = random_numbers(gradients.size(), 12 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  double     power = 0., moment_power = 0., scale = 0.;
  for (unsigned int i = 0; i < forces.size(); ++i)
    {
      power += forces[i] * values[i];
      scale += std::abs(forces[i] * values[i]);
    }
  for (unsigned int i = 0; i < moments.size(); ++i)
    {
      moment_power += moments[i] * gradients[i];
      scale += std::abs(moments[i] * gradients[i]);
    }
  power        = dealii::Utilities::MPI::sum(power, MPI_COMM_WORLD);
  moment_power = dealii::Utilities::MPI::sum(moment_power, MPI_COMM_WORLD);
  scale        = dealii::Utilities::MPI::sum(scale, MPI_COMM_WORLD);
  FluidBlockVector load;
  problem.space.reinit(load);
  interpolation.add_load(forces, {}, load);
  EXPECT_NEAR(load * u, power, 1e-12 * scale);
  interpolation.add_load(forces, moments, load); // adds
  EXPECT_NEAR(load * u, 2. * power + moment_power, 1e-12 * scale);
  EXPECT_EQ(load.block(pressure_block).l2_norm(), 0.);
}


TEST(PointInterpolation, SameOnAnyNumberOfRanks)
{
  const Problem      together(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
  PointInterpolation at_together(together.space), at_alone(alone.space);
  at_together.reinit(probes());
  at_alone.reinit(probes());
  ASSERT_EQ(at_alone.local_points().size(), probes().size());
  std::vector<double> values, gradients, all_values, all_gradients;
  at_together.values_and_gradients(nodal_velocity(together.space, Waves(side)), values, gradients);
  at_alone.values_and_gradients(nodal_velocity(alone.space, Waves(side)), all_values, all_gradients);
  EXPECT_LT(largest_difference(values, local_part(at_together, all_values, 3)), 1e-12);
  EXPECT_LT(largest_difference(gradients, local_part(at_together, all_gradients, 9)), 1e-11);

  const auto       forces = random_numbers(3 * probes().size(), 3), moments = random_numbers(9 * probes().size(), 4);
  FluidBlockVector load, whole_load;
  together.space.reinit(load);
  alone.space.reinit(whole_load);
  at_together.add_load(local_part(at_together, forces, 3), local_part(at_together, moments, 9), load);
  at_alone.add_load(forces, moments, whole_load);
  EXPECT_NEAR(load.l2_norm(), whole_load.l2_norm(), 1e-12 * whole_load.l2_norm());
  for (const double phase : {0., 0.7, 1.9})
    {
      const auto v = nodal_velocity(together.space, Waves(side, phase)), w = nodal_velocity(alone.space, Waves(side, phase));
      EXPECT_NEAR(load * v, whole_load * w, 1e-12 * whole_load.l2_norm() * w.l2_norm());
    }
}
