// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the distances from the shell, of the cells near it and of those that it encloses.

#include <tanktread/base/exceptions.h>
#include <tanktread/coupling/surface_distance.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/interior.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace tanktread;

namespace
{
  constexpr double h = 0.15625;

  /** A mesh of which the size of the finest cells is all that matters. */
  FluidMesh
  mesh()
  {
    FluidMeshParameters parameters;
    parameters.finest_cell = h;
    return FluidMesh(MPI_COMM_WORLD, 10., parameters);
  }

  /** A tilted capsule of some shape, points 0.3 h apart. */
  struct Scene
  {
    explicit Scene(const Shape kind, const double size = 1., const Eigen::RowVector3d &shift = Eigen::RowVector3d::Zero())
      : shape(make_capsule(parameters(kind), 3))
      , surface(shape.topology, triangle_quadrature(3, 1), Derivatives::second)
      , x((size * shape.control_points).rowwise() + (Eigen::RowVector3d(0.1, -4.8, 0.3) + shift))
    {}

    static CapsuleShapeParameters
    parameters(const Shape kind)
    {
      CapsuleShapeParameters result;
      result.shape       = kind;
      result.axes        = {{3., 2., 1.}};
      result.inclination = 0.17;
      return result;
    }

    SurfaceDistance
    distance() const
    {
      return SurfaceDistance(mesh(), quadratic_patches(surface, x));
    }

    FittedShape        shape;
    SubdivisionSurface surface;
    ControlPoints      x;
  };

  Lattice
  cell_of(const Eigen::Vector3d &y)
  {
    Lattice cell;
    for (unsigned int d = 0; d < 3; ++d)
      cell[d] = std::floor((y[d] + 5.) / h);
    return cell;
  }
} // namespace

TEST(SurfaceDistance, IsThatFromTheNearestPoint)
{
  const Scene           scene(Shape::ellipsoid);
  const SurfaceDistance distance = scene.distance();
  unsigned int          n_far    = 0;
  for (const Lattice &cell : distance.cells_nearby())
    for (int a = 0; a < 27; a += 4)
      {
        const Lattice         node = {{2 * cell[0] + a % 3, 2 * cell[1] + a / 3 % 3, 2 * cell[2] + a / 9}};
        const Eigen::Vector3d y(-5. + 0.5 * h * node[0], -5. + 0.5 * h * node[1], -5. + 0.5 * h * node[2]);
        double                nearest = std::numeric_limits<double>::infinity(), wanted = nearest;
        for (const QuadraticPatch &patch : distance.patches())
          {
            // Points of cells that are at most one cell away in each direction.
            const Lattice other = cell_of(patch.X);
            bool          near  = true;
            for (unsigned int d = 0; d < 3; ++d)
              near = near && std::abs(2 * other[d] + 1 - node[d]) <= 3;
            if (near && (patch.X - y).squaredNorm() < nearest)
              {
                nearest = (patch.X - y).squaredNorm();
                wanted  = signed_distance(patch, y);
              }
          }
        EXPECT_EQ(distance.at(node), wanted);
        n_far += std::isinf(wanted);
      }
  EXPECT_LT(n_far, 100u);
  EXPECT_TRUE(std::isinf(distance.at({0, 0, 0})));
  EXPECT_TRUE(std::isinf(distance.at({-1, -100, 1000})));
}

TEST(SurfaceDistance, NearbyCellsContainPointsOrTouchSome)
{
  const Scene           scene(Shape::biconcave);
  const SurfaceDistance distance = scene.distance();
  std::set<Lattice>     wanted;
  for (const QuadraticPatch &patch : distance.patches())
    for (int n = 0; n < 27; ++n)
      {
        const Lattice cell = cell_of(patch.X);
        wanted.insert({{cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1}});
      }
  const std::vector<Lattice> cells = distance.cells_nearby();
  EXPECT_EQ(cells.size(), wanted.size());
  EXPECT_EQ(std::set<Lattice>(cells.begin(), cells.end()), wanted);
  EXPECT_EQ(distance.runs_nearby().n_cells(), wanted.size());
  for (unsigned int d = 0; d < 3; ++d)
    EXPECT_EQ(distance.low()[d], (*std::min_element(cells.begin(), cells.end(), [d](const Lattice &a, const Lattice &b) { return a[d] < b[d]; }))[d]);

  // The order depends on the points alone: those of another order are sorted first.
  std::vector<QuadraticPatch> reversed(distance.patches().rbegin(), distance.patches().rend());
  EXPECT_EQ(SurfaceDistance(mesh(), reversed).cells_nearby(), cells);
}

TEST(SurfaceDistance, EnclosedCellsAreThoseInside)
{
  for (const Shape kind : {Shape::sphere, Shape::biconcave})
    {
      const Scene       scene(kind);
      const auto        distance = scene.distance();
      const CellSides   sides(distance.runs_nearby());
      const Interior    interior(scene.surface, scene.x);
      const auto        cells = distance.cells_nearby();
      std::set<Lattice> near(cells.begin(), cells.end());
      unsigned int      n_inside = 0;
      Lattice           cell;
      const Lattice    &low = distance.low();
      for (cell[2] = low[2] - 3; cell[2] < low[2] + 25; ++cell[2])
        for (cell[1] = low[1] - 3; cell[1] < low[1] + 25; ++cell[1])
          for (cell[0] = low[0] - 3; cell[0] < low[0] + 25; ++cell[0])
            {
              const Side side   = sides.at(cell);
              const bool inside = interior.contains(Eigen::Vector3d(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5) * h - Eigen::Vector3d::Constant(5.));
              EXPECT_EQ(side, near.count(cell) ? Side::near : inside ? Side::inside : Side::outside);
              n_inside += side == Side::inside;
            }
      EXPECT_GT(n_inside, 20u);
    }
}

TEST(CellSides, AGapThatLeadsOutIsNotEnclosed)
{
  // A box of 5 x 5 x 5 cells without its inside, closed; then with a hole in one face, of cells that touch by faces or by an edge alone.
  const auto box = [](const std::set<Lattice> &holes) {
    CellRuns                   runs({10, 20, 5, 5});
    std::vector<CellRuns::Run> row;
    for (int z = 0; z < 5; ++z)
      for (int y = 0; y < 5; ++y)
        {
          row.clear();
          for (int x = 0; x < 5; ++x)
            if ((x % 4 == 0 || y % 4 == 0 || z % 4 == 0) && !holes.count({{x, y, z}}))
              {
                if (!row.empty() && row.back().end == -7 + x)
                  ++row.back().end;
                else
                  row.push_back({-7 + x, -6 + x});
              }
          runs.add_row(row);
        }
    return CellSides(runs);
  };
  const Lattice middle = {{-5, 12, 22}};
  EXPECT_EQ(box({}).at(middle), Side::inside);
  EXPECT_EQ(box({}).at({{-7, 12, 22}}), Side::near);
  EXPECT_EQ(box({}).at({{-8, 12, 22}}), Side::outside);
  EXPECT_EQ(box({}).at({{-5, 30, 22}}), Side::outside);
  for (const Lattice &hole : {Lattice{{0, 2, 2}}, Lattice{{4, 1, 1}}, Lattice{{2, 0, 3}}, Lattice{{2, 4, 1}}, Lattice{{1, 1, 0}}, Lattice{{3, 2, 4}}})
    EXPECT_EQ(box({hole}).at(middle), Side::outside);
  EXPECT_EQ(box({{{0, 0, 2}}}).at(middle), Side::inside); // an edge of the box
}

TEST(SurfaceDistance, MemoryGoesWithThePointsAndNotWithTheVolumeAroundThem)
{
  const Scene           scene(Shape::sphere, 200.);
  const SurfaceDistance distance = scene.distance(); // of 1.7e10 cells
  EXPECT_EQ(distance.cells_nearby().size(), 27 * distance.patches().size());
  const Lattice cell = cell_of(distance.patches()[7].X);
  EXPECT_LT(std::abs(distance.at({{2 * cell[0] + 1, 2 * cell[1] + 1, 2 * cell[2] + 1}})), h);
}

TEST(SurfaceDistance, DriftThroughManyBoxes)
{
  const std::int64_t    far = std::int64_t(1) << 36; // cells, beyond 32 bits
  const Scene           here(Shape::ellipsoid), there(Shape::ellipsoid, 1., Eigen::RowVector3d(far * h, -h * far, 0.));
  const SurfaceDistance distance = here.distance(), moved = there.distance();
  const auto            cells = distance.cells_nearby(), moved_cells = moved.cells_nearby();
  // Positions there are rounded to 2e-6.
  EXPECT_NEAR(double(moved_cells.size()) / cells.size(), 1., 0.01);
  const CellSides sides(distance.runs_nearby()), moved_sides(moved.runs_nearby());
  const Lattice   middle = cell_of(Eigen::Vector3d(0.1, -4.8, 0.3));
  const Lattice   moved_middle{{middle[0] + far, middle[1] - far, middle[2]}};
  EXPECT_EQ(sides.at(middle), Side::inside);
  EXPECT_EQ(moved_sides.at(moved_middle), Side::inside);
  for (const Lattice &cell : cells)
    {
      const double there_value = moved.at({{2 * (cell[0] + far), 2 * (cell[1] - far), 2 * cell[2]}}),
                   here_value  = distance.at({{2 * cell[0], 2 * cell[1], 2 * cell[2]}});
      EXPECT_TRUE(std::abs(here_value) > h || std::abs(there_value - here_value) < 1e-4) << here_value << ' ' << there_value;
    }
}

TEST(SurfaceDistance, RefusesPointsThatHaveLeftTheShell)
{
  const Scene scene(Shape::sphere);
  for (const double place : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -1e9})
    for (unsigned int d = 0; d < 3; ++d)
      {
        auto patches    = quadratic_patches(scene.surface, scene.x);
        patches[3].X[d] = place;
        EXPECT_THROW(SurfaceDistance(mesh(), patches), NumericalError);
      }
}
