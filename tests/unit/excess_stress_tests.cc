// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the stress of the undisturbed flow where the viscosity is not one, and weights of cut cells.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/assembled_stokes.h>
#include <tanktread/fluid/fluid.h>

#include "viscosity_examples.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

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

  const AssembledStokes assembled(fluid.space());
  ComponentVector       v;
  assembled.reinit(v);
  assembled.to_components(test, v);
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
