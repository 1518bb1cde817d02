// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the terms of inertia, and flows carried from mesh to mesh.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/fluid/undisturbed_flow.h>
#include <tanktread/fluid/velocity_products.h>

#include <cmath>

#include "inertia_examples.h"
#include "nodal_velocity.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  double
  scalar_product(const FluidBlockVector &u, const FluidBlockVector &v)
  {
    return u.block(velocity_block) * v.block(velocity_block);
  }

  /** The terms without the time derivative. */
  FluidBlockVector
  convection(const TaylorHoodSpace &space, const UndisturbedFlow &undisturbed, const FluidBlockVector &u)
  {
    Inertia          inertia(space, 1., undisturbed);
    FluidBlockVector zero, result;
    space.reinit(zero);
    space.reinit(result);
    inertia.begin_step(zero.block(velocity_block), 1e300);
    inertia.add_residual(u, result);
    return result;
  }
} // namespace


TEST(Inertia, DerivativeIsThatOfTheResidual)
{
  FluidMesh mesh(MPI_COMM_WORLD, 4., mesh_parameters(1., 0.5));
  mesh.adapt({Point(0.1, 0.2, 0.3), Point(1.9, -1.9, -1.6)});
  const TaylorHoodSpace space(mesh);
  Inertia               inertia(space, 1.7, quadratic_in_all_directions());
  FluidBlockVector      u = nodal_velocity(space, Waves(4.)), du = nodal_velocity(space, Waves(4., 0.7)), uhat = nodal_velocity(space, Waves(4., 1.3));
  inertia.begin_step(uhat.block(velocity_block), 0.3);
  inertia.linearise(u);
  FluidBlockVector derivative, difference, back;
  for (auto *vector : {&derivative, &difference, &back})
    space.reinit(*vector);
  inertia.add_derivative(du, derivative);
  u.add(0.5, du);
  inertia.add_residual(u, difference);
  u.add(-1., du);
  inertia.add_residual(u, back);
  difference.add(-1., back); // exact for the quadratic terms
  difference.add(-1., derivative);
  EXPECT_LT(norm(difference), 1e-13 * norm(derivative));
}


TEST(Inertia, ProductsOfVelocitiesAreIntegratedExactly)
{
  // u = (1 - (z/2)^2) c vanishes at the walls z = -2, 2 and is among the functions of the cells, of which there are two sizes: c_i c_j times the integral
  // of (1 - (z/2)^2)^2.
  FluidMesh mesh(MPI_COMM_WORLD, 4., mesh_parameters(1., 0.5));
  mesh.adapt({Point(0.1, 0.2, 0.3), Point(1.9, -1.9, -1.6)});
  const TaylorHoodSpace      space(mesh);
  const dealii::Tensor<1, 3> c({0.7, -1.1, 0.4});
  const FluidBlockVector     u        = nodal_velocity(space, [&](const Point &x) {
    const dealii::Tensor<1, 3> v = (1. - x[2] * x[2] / 4.) * c;
    return std::array<double, 3>{{v[0], v[1], v[2]}};
  });
  const auto                 products = integral_of_products(space, u.block(velocity_block));
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      EXPECT_NEAR(products[i][j], 16. * 32. / 15. * c[i] * c[j], 1e-12) << i << j;
}


TEST(Inertia, UndisturbedFlowIsThatOfTheDisturbance)
{
  // Where it vanishes at the walls the flow may be given either way: i(u + w) = i(w) + i(u) with w undisturbed, here with w = (4 - z^2, 0, 0), which
  // convects nothing.
  FluidMesh mesh(MPI_COMM_WORLD, 4., mesh_parameters(1., 0.5));
  mesh.adapt({Point(0.1, 0.2, 0.3), Point(1.9, -1.9, -1.6)});
  const TaylorHoodSpace  space(mesh);
  const UndisturbedFlow  parabola = plane_poiseuille(2., 4.);
  const FluidBlockVector w        = nodal_velocity(space, [&](const Point &x) {
    const dealii::Tensor<1, 3> v = parabola.velocity(x);
    return std::array<double, 3>{{v[0], v[1], v[2]}};
  });
  FluidBlockVector       u        = nodal_velocity(space, Waves(4.)), zero(w);
  zero                            = 0.;
  const FluidBlockVector in_flow  = convection(space, parabola, u);
  FluidBlockVector       sum      = u;
  sum += w;
  FluidBlockVector together = convection(space, UndisturbedFlow(), sum);
  together -= in_flow;
  EXPECT_GT(norm(in_flow), 1.);
  EXPECT_LT(norm(together), 1e-13 * norm(in_flow));

  Inertia          inertia(space, 1., simple_shear());
  FluidBlockVector later;
  space.reinit(later);
  inertia.set_flow(parabola);
  inertia.begin_step(zero.block(velocity_block), 1e300);
  inertia.add_residual(u, later);
  later -= in_flow;
  EXPECT_EQ(norm(later), 0.);
}


TEST(Inertia, ParallelFlowsKeepTheirMomentum)
{
  FluidMesh mesh(MPI_COMM_WORLD, 4., mesh_parameters(1., 0.5));
  mesh.adapt({Point(0.1, 0.2, 0.3)});
  const TaylorHoodSpace space(mesh);
  // u = (f(z), 0, 0) convects nothing: only the time derivative is left.
  const FluidBlockVector u = nodal_velocity(space, [](const Point &x) { return std::array<double, 3>{{4. - x[2] * x[2], 0., 0.}}; });
  FluidBlockVector       uhat(u), r;
  space.reinit(r);
  Inertia inertia(space, 2., plane_poiseuille(2.));
  inertia.begin_step(uhat.block(velocity_block), 0.1);
  inertia.add_residual(u, r);
  const double rest = norm(r);
  uhat *= 0.5;
  inertia.begin_step(uhat.block(velocity_block), 0.1);
  space.reinit(r);
  inertia.add_residual(u, r);
  EXPECT_LT(rest, 1e-13 * norm(r));
}


TEST(Inertia, ConvectionOfASolenoidalFlowDoesNoWork)
{
  FluidMesh mesh(MPI_COMM_WORLD, 4., mesh_parameters(0.5, 0.5));
  mesh.adapt({Point(0.1, 0.2, 0.3)});
  const TaylorHoodSpace space(mesh);
  // Products of functions of one coordinate whose interpolants are as solenoidal; the integrals over x and y that have to vanish are exact.
  const auto flow = [&](const double other) {
    return nodal_velocity(space, [&](const Point &x) {
      const double k = pi / 2., wall = std::cos(pi * x[2] / 4.);
      return std::array<double, 3>{{wall * std::sin(k * x[1]) + other * std::cos(2. * k * x[0]) * wall, wall * (1.3 + x[2]) * std::cos(k * x[0] + 0.4), 0.}};
    });
  };
  const FluidBlockVector solenoidal = flow(0.), other = flow(0.5), c_solenoidal = convection(space, simple_shear(1.2), solenoidal),
                         c_other = convection(space, simple_shear(1.2), other);
  EXPECT_LT(std::abs(scalar_product(c_solenoidal, solenoidal)), 1e-14 * norm(c_solenoidal) * norm(solenoidal));
  EXPECT_GT(std::abs(scalar_product(c_other, other)), 1e-3 * norm(c_other) * norm(other));
}


TEST(FieldTransfer, InterpolatesTheOldFlowAtNewNodes)
{
  FluidMesh mesh(MPI_COMM_WORLD, 4., mesh_parameters(1., 0.25));
  mesh.adapt({Point(0.1, 0.2, 0.3), Point(-1.95, 1.9, -1.7)});
  std::unique_ptr<const TaylorHoodSpace> space = std::make_unique<TaylorHoodSpace>(mesh);
  FluidBlockVector                       u = nodal_velocity(*space, Waves(4.)), v = nodal_velocity(*space, Waves(4., 0.7));
  auto                                  &p = u.block(pressure_block);
  for (unsigned int i = 0; i < p.locally_owned_size(); ++i)
    p.local_element(i) = std::sin(1. + (p.get_partitioner()->local_range().first + i) % 100);
  const double        pressure_norm = p.l2_norm();
  const FieldTransfer back_and_forth(*space, {&u, &v});

  // At random points of the old mesh, which are to be nodes of no mesh in particular: compare where the new cells are the smaller ones.
  const std::vector<Point> points = {{0.11, 0.23, 0.31}, {-1.93, 1.91, -1.71}, {1.9, 0.3, 1.97}, {-0.4, 0.8, -0.6}};
  const auto               at     = [&](const TaylorHoodSpace &where, const FluidBlockVector &field) {
    PointInterpolation points_of(where);
    points_of.reinit(points);
    std::vector<double> local, all(3 * points.size(), 0.);
    points_of.values(field, local);
    for (unsigned int r = 0; r < points_of.local_points().size(); ++r)
      for (unsigned int c = 0; c < 3; ++c)
        all[3 * points_of.local_points()[r] + c] = local[3 * r + c];
    dealii::Utilities::MPI::sum(all, MPI_COMM_WORLD, all);
    return all;
  };
  const std::vector<double> u_before = at(*space, u), v_before = at(*space, v);

  // More fine cells than before: nothing is lost. Back to the first mesh: nothing is changed.
  space.reset();
  ASSERT_TRUE(mesh.adapt({Point(0.1, 0.2, 0.3), Point(-1.95, 1.9, -1.7), Point(-0.5, 0.9, -0.7), Point(1.2, 1.1, 1.8)}));
  space = std::make_unique<TaylorHoodSpace>(mesh);
  back_and_forth.interpolate(*space, {&u, &v});
  const std::vector<double> u_after = at(*space, u), v_after = at(*space, v);
  for (unsigned int i = 0; i < u_before.size(); ++i)
    {
      EXPECT_NEAR(u_after[i], u_before[i], 1e-13);
      EXPECT_NEAR(v_after[i], v_before[i], 1e-13);
    }
  const FieldTransfer back(*space, {&u});
  space.reset();
  ASSERT_TRUE(mesh.adapt({Point(0.1, 0.2, 0.3), Point(-1.95, 1.9, -1.7)}));
  space = std::make_unique<TaylorHoodSpace>(mesh);
  back.interpolate(*space, {&u});
  const FluidBlockVector w = nodal_velocity(*space, Waves(4.));
  u.block(velocity_block) -= w.block(velocity_block);
  EXPECT_LT(norm(u), 1e-13 * norm(w));
  EXPECT_NEAR(u.block(pressure_block).l2_norm(), pressure_norm, 1e-12 * pressure_norm);
}
