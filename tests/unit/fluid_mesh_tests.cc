// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the fluid mesh.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>

#include "full_arrays.h"

#include <iostream>
#include <set>

using namespace tanktread;
using oracle::sphere_points;

namespace
{
  using Point = dealii::Point<3>;

  constexpr double side = 2.;
} // namespace


TEST(FluidMesh, IsFineAtTheShellAndForgetsItsHistory)
{
  FluidMesh  mesh(MPI_COMM_WORLD, side, cells(0.5, 0.0625)), fresh(MPI_COMM_WORLD, side, cells(0.5, 0.0625));
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
      FluidMesh mesh(MPI_COMM_WORLD, side, cells(side / e.asked, side / e.asked / 3.));
      EXPECT_EQ(mesh.n_rung_0(), (std::array<int, 3>{{e.n_rung_0, e.n_rung_0, e.n_rung_0}}));
      EXPECT_EQ(mesh.coarsest_level(), e.coarsest_level);
      EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.coarsest_level()), side / e.asked);
      EXPECT_DOUBLE_EQ(mesh.cell_size(mesh.finest_level()), side / e.asked / 4.); // the first level not coarser than asked for
      EXPECT_EQ(mesh.triangulation().n_global_active_cells(), std::pow(e.n_rung_0, 3));
      EXPECT_TRUE(mesh.adapt({}));
      EXPECT_EQ(mesh.triangulation().n_global_active_cells(), std::pow(e.asked, 3));
      EXPECT_FALSE(mesh.adapt({}));
    }
}


TEST(FluidMesh, NumberOfCoarseCellsCanBeHalved)
{
  // Whatever is asked for, the direct solver of the first rung has little to do, and the size of the cells is not far off.
  for (int asked = 2; asked <= 64; ++asked)
    {
      const BoxDivision division = divide(10., 10. / asked);
      EXPECT_LE(division.n_rung_0[0], 5);
      EXPECT_EQ(division.n_rung_0[1], division.n_rung_0[0]);
      EXPECT_EQ(division.n_rung_0[2], division.n_rung_0[0]);
      const double n = division.n_rung_0[0] << division.coarsest_level;
      EXPECT_LT(std::abs(std::log2(n / asked)), 0.23) << asked; // of an octave
    }
  const auto expect = [](const Box &box, const double coarsest, const std::array<int, 3> &n_rung_0, const unsigned int coarsest_level) {
    const BoxDivision division = divide(box, coarsest);
    EXPECT_EQ(division.n_rung_0, n_rung_0);
    EXPECT_EQ(division.coarsest_level, coarsest_level);
  };
  expect(closed_brick, 4., {{2, 3, 4}}, 0);
  expect(closed_brick, 2.5, {{2, 3, 4}}, 1); // cells of 2
  expect(brick_along_yz, 0.4, {{2, 3, 4}}, 3);
  expect({{{4., 4., 36.}}, {{Faces::prescribed, Faces::prescribed, Faces::periodic}}}, 2., {{1, 1, 9}}, 1);
  expect({{{4., 4., 36.}}, {{Faces::periodic, Faces::prescribed, Faces::periodic}}}, 2., {{2, 2, 18}}, 0); // no cell is its own neighbour
  expect({{{2., 2., 2.}}, {{Faces::prescribed, Faces::prescribed, Faces::prescribed}}}, 2., {{1, 1, 1}}, 0);
}


namespace
{
  /** The message of the error that `check` of these cells in the box throws. */
  std::string
  refusal(const FluidMeshParameters &parameters, const Box &box)
  {
    try
      {
        parameters.check(box);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace


TEST(FluidMesh, RefusesBoxesThatCubesDoNotFill)
{
  const auto refused = [](const Box &box, const double coarsest, const std::string &words) {
    const std::string message = refusal(cells(coarsest, 0.1), box);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const std::array<Faces, 3> walls_in_z = Box().faces;
  EXPECT_EQ(refusal(cells(2.5, 0.15), {{{10., 10., 10.}}, walls_in_z}), "");
  EXPECT_EQ(refusal(cells(2.5, 0.15), closed_brick), "");
  refused({{{10., 10., 11.}}, walls_in_z}, 2.5, "Scene/Box side is 10 x 10 x 11; allowed: multiples of one size of cells near Fluid mesh/Coarsest cell, 2.5");
  refused({{{10., 10., 11.}}, walls_in_z}, 2.5, "such as 10 x 10 x 10; cells of 1 would divide this box");
  EXPECT_EQ(refusal(cells(1., 0.15), {{{10., 10., 11.}}, walls_in_z}), "");
  refused({{{10., 10., std::sqrt(110.)}}, walls_in_z}, 2.5, "such as 10 x 10 x 10.");
  refused({{{10., 10., 10.}}, {{Faces::periodic, Faces::periodic, Faces::periodic}}}, 2.5, "periodic along all three axes; allowed: prescribed velocities");
  EXPECT_THROW(FluidMesh(MPI_COMM_WORLD, {{{10., 10., 10.}}, {{Faces::periodic, Faces::periodic, Faces::periodic}}}, cells(2.5, 1.)), InputError);
  refused(brick_along_z, 8.1, "Fluid mesh/Coarsest cell is 8.1; allowed: at most 8, ");
  refused(brick_along_yz, 6.1, "Fluid mesh/Coarsest cell is 6.1; allowed: at most 6, ");
  refused(closed_brick, 0.1, "Fluid mesh/Coarsest cell is 0.1; allowed: at least 0.18");
  EXPECT_NE(refusal(cells(2., 3.), closed_brick).find("Fluid mesh/Finest cell is 3; allowed: at most Fluid mesh/Coarsest cell, 2."), std::string::npos);
  EXPECT_NE(refusal(cells(2., 1e-5), closed_brick).find("Fluid mesh/Finest cell is 1e-05; allowed: at least 6.1"), std::string::npos);
}


TEST(FluidMesh, ClimbsOneLevelARung)
{
  FluidMesh  mesh(MPI_COMM_WORLD, side, cells(0.25, 0.0625)), whole(MPI_COMM_WORLD, side, cells(0.25, 0.0625));
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
  EXPECT_EQ(mesh.triangulation().n_global_active_cells(), std::pow(mesh.n_rung_0()[0], 3));
}


TEST(FluidMesh, IsDividedByWork)
{
  // Points in a corner of a box of few cells elsewhere; a cell with points counts as five.
  constexpr double work   = 4.;
  const auto       points = sphere_points(Point(-0.45, -0.4, -0.38), 0.45);
  const auto       uneven = [&](const bool by_work) {
    FluidMesh mesh(MPI_COMM_WORLD, side, cells(0.125, 0.0625)), reference(MPI_COMM_WORLD, side, cells(0.125, 0.0625));
    mesh.set_work_of_cells_with_points(by_work ? work : 0.);
    mesh.adapt(points);
    reference.adapt(points);
    EXPECT_EQ(mesh.triangulation().get_checksum(), reference.triangulation().get_checksum());
    std::set<std::uint64_t> with_points;
    for (const Point &point : points)
      with_points.insert(mesh.place(point, mesh.finest_level()).key.packed());
    double here = 0.;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        here += 1. + work * with_points.count(mesh.key(cell).packed());
    const double most = dealii::Utilities::MPI::max(here, MPI_COMM_WORLD), all = dealii::Utilities::MPI::sum(here, MPI_COMM_WORLD);
    return most * dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) / all;
  };
  const double plain = uneven(false), by_work = uneven(true);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "most work of a rank over the mean: " << plain << ", by work " << by_work << std::endl;
  EXPECT_LT(by_work, 1.02);
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    EXPECT_GT(plain, 1.1);
}


namespace
{
  /** Distance between two points in the coordinate in which it is largest, to the nearest image along periodic axes. */
  double
  largest_coordinate(const Box &box, const Point &x, const Point &y)
  {
    double result = 0.;
    for (unsigned int d = 0; d < 3; ++d)
      result = std::max(result, std::abs(box.is_periodic(d) ? std::remainder(x[d] - y[d], box.side[d]) : x[d] - y[d]));
    return result;
  }

  void
  expect_band(const Box &box, const double coarsest, const std::vector<Point> &points)
  {
    FluidMesh mesh(MPI_COMM_WORLD, box, cells(coarsest, coarsest / 8.));
    mesh.adapt(points);
    const double width        = 1.5 * mesh.cell_size(mesh.finest_level());
    unsigned int n_too_coarse = 0, n_fine = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const bool fine = static_cast<unsigned int>(cell->level()) == mesh.finest_level();
          n_fine += fine;
          for (const Point &x : points)
            n_too_coarse += !fine && largest_coordinate(box, x, cell->center()) - 0.5 * mesh.cell_size(cell->level()) < width;
        }
    EXPECT_EQ(dealii::Utilities::MPI::sum(n_too_coarse, MPI_COMM_WORLD), 0u);
    // Each band is four or so cells wide, rounded outwards to whole parents: at most six along each axis.
    EXPECT_LE(dealii::Utilities::MPI::sum(n_fine, MPI_COMM_WORLD), points.size() * 6 * 6 * 6);
    for (unsigned int d = 0; d < 3; ++d)
      {
        Point beyond;
        beyond[d] = 0.505 * box.side[d];
        if (box.is_periodic(d))
          EXPECT_TRUE(mesh.aim_at({beyond}));
        else
          EXPECT_THROW(mesh.aim_at({beyond}), NumericalError);
        beyond[d] = std::nan("");
        EXPECT_THROW(mesh.aim_at({beyond}), NumericalError);
      }
  }
} // namespace


TEST(FluidMesh, BandIsAsWideAsAskedFor)
{
  // Off the faces of cells, or rounding decides. Periodic faces are crossed, others are reached.
  expect_band(side, 0.5, {Point(0.013, -0.017, 0.011), Point(-0.99, 0.98, 0.3), Point(0.4, 5.41, 0.97)});
  for (const Box &box : {closed_brick, brick_along_z, brick_along_yz})
    expect_band(box, 2., {Point(0.013, -0.017, 0.011), Point(-3.99, 5.98, 1.3), Point(1.4, -5.97, 7.97)});
  expect_band(brick_along_z, 2., {Point(1.4, 2.7, 37.03)});
}


TEST(FluidMesh, GradingWidensTheBandOfEachSize)
{
  const std::vector<Point>  points     = {Point(0.013, -0.017, 0.011), Point(-0.99, 0.98, 0.3)};
  FluidMeshParameters       parameters = cells(0.5, 0.03125);
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
              Point        centre;
              for (unsigned int d = 0; d < 3; ++d)
                centre[d] = mesh.box().lower(d) + h * (place.key.position[d] + 0.5);
              const double gap = std::max(0., largest_coordinate(mesh.box(), cell->center(), centre) - 1.5 * h);
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
