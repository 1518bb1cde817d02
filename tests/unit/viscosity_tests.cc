// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes equations with a viscosity that varies.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/assembled_stokes.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/linear_solver.h>

#include <iostream>

#include "viscosity_examples.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  /** Periodic in x and y, zero at z = +-1, divergence-free: curl of (0, g, 0) with g = s(z) (cos(kx) + sin(ky)), s = (1 - z^2)^2; pressure sin(kx) z. */
  struct Manufactured
  {
    static constexpr double k = dealii::numbers::PI;

    static double
    s(const double z, const int derivative)
    {
      return derivative == 0 ? std::pow(1. - z * z, 2) : derivative == 1 ? -4. * z * (1. - z * z) : derivative == 2 ? 12. * z * z - 4. : 24. * z;
    }
    static std::array<double, 3>
    velocity(const Point &x)
    {
      return {{-s(x[2], 1) * (std::cos(k * x[0]) + std::sin(k * x[1])), 0., -k * std::sin(k * x[0]) * s(x[2], 0)}};
    }
    static dealii::Tensor<2, 3>
    gradient(const Point &x)
    {
      dealii::Tensor<2, 3> g;
      g[0][0] = k * s(x[2], 1) * std::sin(k * x[0]);
      g[0][1] = -k * s(x[2], 1) * std::cos(k * x[1]);
      g[0][2] = -s(x[2], 2) * (std::cos(k * x[0]) + std::sin(k * x[1]));
      g[2][0] = -k * k * std::cos(k * x[0]) * s(x[2], 0);
      g[2][2] = -k * std::sin(k * x[0]) * s(x[2], 1);
      return g;
    }
    static double
    viscosity(const Point &x)
    {
      return std::exp(1.1 * std::sin(k * (x[0] + 0.3)) * std::cos(k * x[1]) + 0.7 * x[2]);
    }
    static double
    pressure(const Point &x)
    {
      return std::sin(k * x[0]) * x[2];
    }
  };


  /** (sigma, grad v) for the stress of that solution, which is the load that has it as the weak solution. */
  FluidVector
  manufactured_load(const AssembledStokes &stokes, const TaylorHoodSpace &space)
  {
    ComponentVector load;
    stokes.reinit(load);
    const dealii::QGauss<3>                      quadrature(5);
    dealii::FEValues<3>                          values(stokes.velocity().dofs().get_fe(),
                               quadrature,
                               dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values);
    std::vector<dealii::types::global_dof_index> indices(27);
    for (const auto &cell : stokes.velocity().dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          cell->get_dof_indices(indices);
          for (unsigned int c = 0; c < 3; ++c)
            {
              dealii::Vector<double> local(27);
              for (const auto q : values.quadrature_point_indices())
                {
                  const Point &x = values.quadrature_point(q);
                  const auto   g = Manufactured::gradient(x);
                  for (unsigned int a = 0; a < 27; ++a)
                    for (unsigned int d = 0; d < 3; ++d)
                      local[a] += (Manufactured::viscosity(x) * (g[c][d] + g[d][c]) - (c == d ? Manufactured::pressure(x) : 0.)) * values.shape_grad(a, q)[d] *
                        values.JxW(q);
                }
              stokes.velocity().constraints().distribute_local_to_global(local, indices, load.block(c));
            }
        }
    load.compress(dealii::VectorOperation::add);
    FluidBlockVector result;
    space.reinit(result);
    stokes.to_nodes(load, result);
    return result.block(velocity_block);
  }


  /** L2 errors of velocity and pressure. */
  std::array<double, 2>
  errors(const AssembledStokes &stokes, ComponentVector &solution)
  {
    const dealii::QGauss<3> quadrature(5);
    const auto              flags = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    std::array<double, 2>   sums{};
    double                  mean = 0.;
    for (unsigned int b = 0; b < 4; ++b)
      {
        const ScalarSpace &space = b < 3 ? stokes.velocity() : stokes.pressure();
        space.constraints().distribute(solution.block(b));
        solution.block(b).update_ghost_values();
        dealii::FEValues<3> fe(space.dofs().get_fe(), quadrature, flags);
        std::vector<double> values(quadrature.size());
        for (const auto &cell : space.dofs().active_cell_iterators())
          if (cell->is_locally_owned())
            {
              fe.reinit(cell);
              fe.get_function_values(solution.block(b), values);
              for (const auto q : fe.quadrature_point_indices())
                {
                  const Point &x = fe.quadrature_point(q);
                  const double e = values[q] - (b < 3 ? Manufactured::velocity(x)[b] : Manufactured::pressure(x));
                  sums[b / 3] += e * e * fe.JxW(q);
                  mean += b == 3 ? e * fe.JxW(q) : 0.;
                }
            }
      }
    mean = dealii::Utilities::MPI::sum(mean, MPI_COMM_WORLD);
    return {
      {std::sqrt(dealii::Utilities::MPI::sum(sums[0], MPI_COMM_WORLD)), std::sqrt(dealii::Utilities::MPI::sum(sums[1], MPI_COMM_WORLD) - mean * mean / 8.)}};
  }


  /** Iterations to 1e-6 for a rough load. */
  LinearReport
  solve_rough(const Fluid &fluid, const double tolerance, FluidBlockVector &x)
  {
    FluidBlockVector rhs;
    fluid.space().reinit(rhs);
    fluid.space().reinit(x);
    oracle::set_rough(fluid.mesh(), *fluid.space().velocity, 1, rhs.block(velocity_block));
    return solve_fgmres(fluid.stokes(), fluid.preconditioner(), x, rhs, tolerance, 300);
  }

  /** Adds 2 (mu eps(u), eps(v)) - least (grad u^T, grad v) cell by cell, u being the velocity blocks of `y`. */
  void
  add_strain_form(const AssembledStokes &assembled, const Field &mu, const double least, const ComponentVector &y, ComponentVector &Ay)
  {
    const dealii::QGauss<3>                        quadrature(3);
    dealii::FEValues<3>                            fe(assembled.velocity().dofs().get_fe(),
                           quadrature,
                           dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values);
    std::vector<dealii::types::global_dof_index>   indices(27);
    std::vector<std::vector<dealii::Tensor<1, 3>>> g(3, std::vector<dealii::Tensor<1, 3>>(27));
    for (const auto &cell : assembled.velocity().dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          fe.reinit(cell);
          cell->get_dof_indices(indices);
          for (unsigned int c = 0; c < 3; ++c)
            fe.get_function_gradients(y.block(c), g[c]);
          for (unsigned int c = 0; c < 3; ++c)
            {
              dealii::Vector<double> local(27);
              for (unsigned int q = 0; q < 27; ++q)
                for (unsigned int a = 0; a < 27; ++a)
                  for (unsigned int d = 0; d < 3; ++d)
                    local[a] +=
                      (mu(fe.quadrature_point(q)) * g[c][q][d] + (mu(fe.quadrature_point(q)) - least) * g[d][q][c]) * fe.shape_grad(a, q)[d] * fe.JxW(q);
              assembled.velocity().constraints().distribute_local_to_global(local, indices, Ay.block(c));
            }
        }
    Ay.compress(dealii::VectorOperation::add);
  }
} // namespace


TEST(Viscosity, StrainFormIsThatOfDealii)
{
  for (const Point &centre : {Point(-1., 1., 0.1), Point(0.1, 0., -0.2), Point(0.9, 0.2, 0.55)})
    {
      Fluid fluid(MPI_COMM_WORLD, 2., cells(0.5, 0.125));
      fluid.adapt(oracle::sphere_points(centre, 0.4));
      const Field mu = sphere(7., centre, 0.4, 2.);
      fluid.set_viscosity(viscosity_from(fluid.mesh(), mu, 0.3));
      const TaylorHoodSpace &space = fluid.space();
      const AssembledStokes  assembled(fluid.space());
      FluidBlockVector       x, Ax, expected;
      for (auto *vector : {&x, &Ax, &expected})
        space.reinit(*vector);
      oracle::set_rough(fluid.mesh(), *space.velocity, 1, x.block(velocity_block));
      oracle::set_rough(fluid.mesh(), *space.pressure, 1, x.block(pressure_block));
      fluid.stokes().vmult(Ax, x);

      // 2 (mu eps(u), eps(v)) - 0.3 (grad u^T, grad v) cell by cell; the pressure's part is that of the assembled matrices.
      ComponentVector y, p_only, Ay;
      for (auto *vector : {&y, &p_only, &Ay})
        assembled.reinit(*vector);
      assembled.to_components(x, y);
      ComponentVector Dy(Ay);
      assembled.vmult(Dy, y); // its pressure block is -div u
      p_only.block(3) = y.block(3);
      assembled.vmult(Ay, p_only);
      Ay.block(3) = Dy.block(3);
      for (unsigned int c = 0; c < 3; ++c)
        {
          assembled.velocity().constraints().distribute(y.block(c));
          y.block(c).update_ghost_values();
        }
      add_strain_form(assembled, mu, 0.3, y, Ay);
      assembled.to_nodes(Ay, expected);
      expected -= Ax;
      for (const unsigned int b : {velocity_block, pressure_block})
        EXPECT_LT(expected.block(b).linfty_norm(), 1e-13 * Ax.block(b).linfty_norm()) << "block " << b << ", centre " << centre;
    }
}


TEST(Viscosity, OfOneIsTheLaplaceForm)
{
  Fluid fluid(MPI_COMM_WORLD, 2., cells(0.5, 0.125));
  fluid.adapt(oracle::sphere_points(Point(0.1, 0., -0.2), 0.4));
  FluidBlockVector   x, y;
  const LinearReport one = solve_rough(fluid, 1e-10, x);
  fluid.set_viscosity(viscosity_from(
    fluid.mesh(),
    [](const Point &) { return 1.; },
    1.));
  const LinearReport other = solve_rough(fluid, 1e-10, y);
  EXPECT_TRUE(one.converged && other.converged);
  EXPECT_EQ(one.iterations, other.iterations);
  y -= x;
  EXPECT_LT(y.block(velocity_block).linfty_norm(), 1e-9 * x.block(velocity_block).linfty_norm());
}


TEST(Viscosity, ManufacturedOrders)
{
  std::vector<std::array<double, 2>> e;
  for (const double h : {0.25, 0.125})
    {
      Fluid fluid(MPI_COMM_WORLD, 2., cells(h, 0.5 * h));
      fluid.adapt(oracle::sphere_points(Point(-1., 1., 0.1), 0.5));
      fluid.set_viscosity(viscosity_from(fluid.mesh(), Manufactured::viscosity, std::exp(-1.8)));
      const AssembledStokes assembled(fluid.space());
      FluidBlockVector      rhs, x;
      fluid.space().reinit(rhs);
      fluid.space().reinit(x);
      rhs.block(velocity_block) = manufactured_load(assembled, fluid.space());
      const LinearReport report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), x, rhs, 1e-8, 200);
      EXPECT_TRUE(report.converged);
      ComponentVector solution;
      assembled.reinit(solution);
      assembled.to_components(x, solution);
      e.push_back(errors(assembled, solution));
      if (is_root())
        std::cout << "coarsest cell " << h << ": error u " << e.back()[0] << ", p " << e.back()[1] << ", " << report.iterations << " iterations" << std::endl;
    }
  EXPECT_GT(std::log2(e[0][0] / e[1][0]), 2.75);
  EXPECT_GT(std::log2(e[0][1] / e[1][1]), 1.8);
}


TEST(CellAverages, KeepIntegralsAndLinearFunctions)
{
  FluidMesh mesh(MPI_COMM_WORLD, 10., cells(2.5, 0.3125));
  mesh.aim_at(oracle::sphere_points(Point(-5., 5., 0.1), 1.));
  const auto z_of_centres = [&]() {
    std::vector<double> result;
    for_cells(mesh, [&](const unsigned int, const auto &cell) { result.push_back(cell->center()[2]); });
    return result;
  };
  mesh.restart();
  auto coarse = std::make_unique<NodeSpace>(ScalarSpace(mesh, 2, true), 3);
  while (!mesh.on_last_rung())
    {
      const std::vector<double>  expected = z_of_centres();
      std::unique_ptr<NodeSpace> fine;
      const InterpolationRows    rows = climb_with_interpolation(mesh, *coarse, [&]() -> const NodeSpace    &{
        fine = std::make_unique<NodeSpace>(ScalarSpace(mesh, 2, true), 3);
        return *fine;
      });
      const CellAverages         average(rows.parent, *coarse, *fine);
      const std::vector<double>  found = average(z_of_centres());
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-13);
      coarse = std::move(fine);
    }
}


TEST(Viscosity, IterationsOverTheRatio)
{
  for (const double finest : {0.3125, 0.15625})
    {
      Fluid       fluid(MPI_COMM_WORLD, 10., cells(1.25, finest));
      const Point centre(0.1, 0., -0.2);
      fluid.adapt(oracle::sphere_points(centre, 1.));
      for (const auto &[ratio, allowed] :
           std::vector<std::pair<double, unsigned int>>{{0.01, 48}, {0.1, 21}, {0.2, 17}, {1., 13}, {5., 16}, {20., 29}, {100., 70}})
        {
          fluid.set_viscosity(viscosity_from(fluid.mesh(), sphere(ratio, centre), std::min(1., ratio)));
          FluidBlockVector   x;
          const LinearReport report = solve_rough(fluid, 1e-6, x);
          if (is_root())
            std::cout << "h = " << finest << ", ratio " << ratio << ": " << report.iterations << " iterations, largest eigenvalue "
                      << fluid.multigrid().largest_eigenvalue() << std::endl;
          EXPECT_TRUE(report.converged);
          EXPECT_LE(report.iterations, allowed);
        }
    }
}
