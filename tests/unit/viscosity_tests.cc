// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes equations with a viscosity that varies.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>
#include <oracle/assembled_stokes.h>
#include <oracle/node_values.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/linear_solver.h>

#include <functional>
#include <iostream>

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;
  using Field = std::function<double(const Point &)>;

  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }


  /** Calls f(number of the cell on this rank, cell). */
  template <typename Function>
  void
  for_cells(const FluidMesh &mesh, const Function &f)
  {
    unsigned int number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        f(number++, cell);
  }


  Viscosity
  viscosity_from(const FluidMesh &mesh, const Field &mu, const double least)
  {
    std::vector<double> values;
    for_cells(mesh, [&](const unsigned int, const auto &cell) {
      for (unsigned int q = 0; q < 27; ++q)
        values.push_back(
          mu(cell->vertex(0) + mesh.cell_size(cell->level()) * Point(gauss_abscissae()[q % 3], gauss_abscissae()[q / 3 % 3], gauss_abscissae()[q / 9])));
    });
    return {std::move(values), least};
  }


  Field
  sphere(const double ratio, const Point &centre, const double radius = 1., const double side = 10.)
  {
    return [=](const Point &x) {
      dealii::Tensor<1, 3> d = x - centre;
      for (unsigned int c = 0; c < 2; ++c)
        d[c] = std::remainder(d[c], side);
      return d.norm() < radius ? ratio : 1.;
    };
  }


  FluidMeshParameters
  cells(const double coarsest, const double finest)
  {
    FluidMeshParameters parameters;
    parameters.coarsest_cell = coarsest;
    parameters.finest_cell   = finest;
    return parameters;
  }


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
  manufactured_load(const oracle::AssembledStokes &stokes, const TaylorHoodSpace &space)
  {
    oracle::ComponentVector load;
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
    stokes.to_nodes(space, load, result);
    return result.block(velocity_block);
  }


  /** L2 errors of velocity and pressure. */
  std::array<double, 2>
  errors(const oracle::AssembledStokes &stokes, oracle::ComponentVector &solution)
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
} // namespace


TEST(Viscosity, StrainFormIsThatOfDealii)
{
  for (const Point &centre : {Point(-1., 1., 0.1), Point(0.1, 0., -0.2), Point(0.9, 0.2, 0.55)})
    {
      Fluid fluid(MPI_COMM_WORLD, 2., cells(0.5, 0.125));
      fluid.adapt(oracle::sphere_points(centre, 0.4));
      const Field mu = sphere(7., centre, 0.4, 2.);
      fluid.set_viscosity(viscosity_from(fluid.mesh(), mu, 0.3));
      const TaylorHoodSpace        &space = fluid.space();
      const oracle::AssembledStokes assembled(fluid.mesh());
      FluidBlockVector              x, Ax, expected;
      for (auto *vector : {&x, &Ax, &expected})
        space.reinit(*vector);
      oracle::set_rough(fluid.mesh(), *space.velocity, 1, x.block(velocity_block));
      oracle::set_rough(fluid.mesh(), *space.pressure, 1, x.block(pressure_block));
      fluid.stokes().vmult(Ax, x);

      // 2 (mu eps(u), eps(v)) - 0.3 (grad u^T, grad v) cell by cell; the pressure's part is that of the assembled matrices.
      oracle::ComponentVector y, p_only, Ay;
      for (auto *vector : {&y, &p_only, &Ay})
        assembled.reinit(*vector);
      assembled.to_components(space, x, y);
      oracle::ComponentVector Dy(Ay);
      assembled.vmult(Dy, y); // its pressure block is -div u
      p_only.block(3) = y.block(3);
      assembled.vmult(Ay, p_only);
      Ay.block(3) = Dy.block(3);
      for (unsigned int c = 0; c < 3; ++c)
        {
          assembled.velocity().constraints().distribute(y.block(c));
          y.block(c).update_ghost_values();
        }
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
                        (mu(fe.quadrature_point(q)) * g[c][q][d] + (mu(fe.quadrature_point(q)) - 0.3) * g[d][q][c]) * fe.shape_grad(a, q)[d] * fe.JxW(q);
                assembled.velocity().constraints().distribute_local_to_global(local, indices, Ay.block(c));
              }
          }
      Ay.compress(dealii::VectorOperation::add);
      assembled.to_nodes(space, Ay, expected);
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
      const oracle::AssembledStokes assembled(fluid.mesh());
      FluidBlockVector              rhs, x;
      fluid.space().reinit(rhs);
      fluid.space().reinit(x);
      rhs.block(velocity_block) = manufactured_load(assembled, fluid.space());
      const LinearReport report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), x, rhs, 1e-8, 200);
      EXPECT_TRUE(report.converged);
      oracle::ComponentVector solution;
      assembled.reinit(solution);
      assembled.to_components(fluid.space(), x, solution);
      e.push_back(errors(assembled, solution));
      if (is_root())
        std::cout << "coarsest cell " << h << ": error u " << e.back()[0] << ", p " << e.back()[1] << ", " << report.iterations << " iterations" << std::endl;
    }
  EXPECT_GT(std::log2(e[0][0] / e[1][0]), 2.75);
  EXPECT_GT(std::log2(e[0][1] / e[1][1]), 1.8);
}


namespace
{
  /** Not free of divergence, which is of no consequence; all numbers of the gradient differ. */
  UndisturbedFlow
  general_flow(const bool is_linear)
  {
    UndisturbedFlow flow;
    for (unsigned int c = 0; c < 3; ++c)
      {
        flow.constant[c] = 0.7 - 0.4 * c;
        for (unsigned int d = 0; d < 3; ++d)
          {
            flow.linear[c][d] = 0.6 - 0.35 * c + 0.25 * d;
            for (unsigned int e = 0; e < 3 && !is_linear; ++e)
              flow.quadratic[c][d][e] = 0.4 - 0.23 * c + 0.31 * (d + e) - 0.17 * d * e;
          }
      }
    return flow;
  }
} // namespace


TEST(Viscosity, ExcessStressIsTheStrainFormOfTheFlow)
{
  // The nodes hold the flow but at the faces of the box, far from the sphere: where mu - 1 is not zero both are the same. Also in cut cells, with weights of a
  // part of them.
  Fluid       fluid(MPI_COMM_WORLD, 10., cells(1.25, 0.3125));
  const Point centre(0.1, 0., -0.2);
  fluid.adapt(oracle::sphere_points(centre, 1.));
  CutCells cut;
  for_cells(fluid.mesh(), [&](const unsigned int number, const auto &cell) {
    if (std::abs(cell->center().distance(centre) - 1.) > 0.3)
      return;
    cut.cells.push_back(number);
    std::array<double, 27> phi;
    for (unsigned int a = 0; a < 27; ++a)
      phi[a] = 1.1 - 0.9 * (a % 3) + 0.3 * (a / 3 % 3) - 0.4 * (a / 9);
    for (const double weight : inside_weights(phi))
      cut.weights.push_back(3. * weight);
  });
  const Viscosity of_points = viscosity_from(fluid.mesh(), sphere(7., centre), 1.), mu(of_points.at_points(), 1., cut);
  const auto      positions = oracle::node_positions(fluid.mesh(), *fluid.space().velocity);
  for (const UndisturbedFlow &undisturbed : {simple_shear(), general_flow(true), plane_poiseuille(5., 4.), general_flow(false)})
    {
      FluidBlockVector load, flow, Ax, Bx;
      for (auto *vector : {&load, &flow, &Ax, &Bx})
        fluid.space().reinit(*vector);
      for (unsigned int i = 0; i < positions.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          flow.block(velocity_block).local_element(3 * i + c) = undisturbed.velocity(positions[i])[c];
      mu.add_excess_stress(fluid.space(), undisturbed, load.block(velocity_block));
      fluid.set_viscosity(mu);
      fluid.stokes().vmult(Ax, flow);
      fluid.set_viscosity(viscosity_from(
        fluid.mesh(),
        [](const Point &) { return 1.; },
        1.));
      fluid.stokes().vmult(Bx, flow);
      Ax -= Bx;
      EXPECT_GT(load.block(velocity_block).linfty_norm(), 0.1);
      load.block(velocity_block) -= Ax.block(velocity_block);
      EXPECT_LT(load.block(velocity_block).linfty_norm(), 1e-13 * Ax.block(velocity_block).linfty_norm());
    }
}


// Across faces, where the nodes cannot hold a flow that the box is not periodic in: against integrals by the cells' positions, for test functions of one
// component at a time.
TEST(Viscosity, ExcessStressOfAFlowThatIsNotPeriodic)
{
  Fluid       fluid(MPI_COMM_WORLD, 2., cells(0.5, 0.25));
  const Point centre(-1., 0.9, 0.1);
  fluid.adapt(oracle::sphere_points(centre, 0.4));
  const Field           mu          = sphere(7., centre, 0.4, 2.);
  const UndisturbedFlow undisturbed = general_flow(false);
  FluidVector           load(fluid.space().velocity->partitioner());
  viscosity_from(fluid.mesh(), mu, 1.).add_excess_stress(fluid.space(), undisturbed, load);
  FluidBlockVector test;
  fluid.space().reinit(test);
  oracle::set_rough(fluid.mesh(), *fluid.space().velocity, 1, test.block(velocity_block));

  const oracle::AssembledStokes assembled(fluid.mesh());
  oracle::ComponentVector       v;
  assembled.reinit(v);
  assembled.to_components(fluid.space(), test, v);
  for (unsigned int c = 0; c < 3; ++c)
    {
      assembled.velocity().constraints().distribute(v.block(c));
      v.block(c).update_ghost_values();
    }
  dealii::FEValues<3>               fe(assembled.velocity().dofs().get_fe(),
                         dealii::QGauss<3>(3),
                         dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values);
  std::vector<dealii::Tensor<1, 3>> g(27);
  double                            expected = 0.;
  for (const auto &cell : assembled.velocity().dofs().active_cell_iterators())
    if (cell->is_locally_owned())
      {
        fe.reinit(cell);
        for (unsigned int c = 0; c < 3; ++c)
          {
            fe.get_function_gradients(v.block(c), g);
            for (unsigned int q = 0; q < 27; ++q)
              {
                const dealii::Tensor<2, 3> gradient = undisturbed.gradient(fe.quadrature_point(q));
                expected += (mu(fe.quadrature_point(q)) - 1.) * ((gradient + transpose(gradient))[c] * g[q]) * fe.JxW(q);
              }
          }
      }
  expected = dealii::Utilities::MPI::sum(expected, MPI_COMM_WORLD);
  EXPECT_GT(std::abs(expected), 0.1);
  EXPECT_NEAR(load * test.block(velocity_block), expected, 1e-13 * load.l2_norm() * test.block(velocity_block).l2_norm());
}


TEST(Viscosity, WeightsOfWholeCellsAreViscosityAtThePoints)
{
  Fluid fluid(MPI_COMM_WORLD, 2., cells(0.5, 0.125));
  fluid.adapt(oracle::sphere_points(Point(0.9, 0.2, 0.1), 0.4));
  const unsigned int  n = fluid.space().velocity->n_cells();
  std::vector<double> with(27 * n, 1.), without(27 * n, 1.);
  CutCells            cut;
  for (unsigned int cell = 0; cell < n; cell += 3)
    {
      std::fill(&with[27 * cell], &with[27 * cell] + 27, 5.);
      cut.cells.push_back(cell);
      for (const double w : whole_weights())
        cut.weights.push_back(4. * w);
    }
  FluidBlockVector x, y, difference;
  for (auto *vector : {&x, &y, &difference})
    fluid.space().reinit(*vector);
  oracle::set_rough(fluid.mesh(), *fluid.space().velocity, 1, x.block(velocity_block));
  const UndisturbedFlow flow         = general_flow(false);
  const auto            expect_equal = [&]() {
    EXPECT_GT(y.block(velocity_block).linfty_norm(), 0.01);
    difference -= y;
    EXPECT_LT(difference.block(velocity_block).linfty_norm(), 1e-13 * y.block(velocity_block).linfty_norm());
  };
  const Viscosity a(with, 1.), b(without, 1., cut);
  for (unsigned int cell = 0; cell < n; ++cell)
    EXPECT_NEAR(a.means()[cell], b.means()[cell], 1e-13);
  a.add_excess_stress(fluid.space(), flow, y.block(velocity_block));
  b.add_excess_stress(fluid.space(), flow, difference.block(velocity_block));
  expect_equal();
  fluid.set_viscosity(a);
  fluid.stokes().vmult(y, x);
  fluid.set_viscosity(b);
  fluid.stokes().vmult(difference, x);
  expect_equal();
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
           std::vector<std::pair<double, unsigned int>>{{0.01, 160}, {0.1, 45}, {0.2, 35}, {1., 13}, {5., 28}, {20., 52}, {100., 125}})
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
