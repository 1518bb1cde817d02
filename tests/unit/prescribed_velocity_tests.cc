// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: given velocities on the faces of the box: flows that the discrete space holds, their net flux, the order of convergence.

#include <gtest/gtest.h>
#include <oracle/node_values.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/prescribed_velocity.h>

#include "nodal_velocity.h"

#include <iostream>

using namespace tanktread;
using Vector = dealii::Tensor<1, 3>;

namespace
{
  const Box box({{4., 6., 4.}}, {{Faces::prescribed, Faces::prescribed, Faces::prescribed}});

  FluidMeshParameters
  cells(const double coarsest, const double finest)
  {
    FluidMeshParameters result;
    result.coarsest_cell = coarsest;
    result.finest_cell   = finest;
    return result;
  }

  /** Cells of two sizes, the small ones reaching a face and an edge, so that nodes on the faces hang too. */
  struct SmallFluid
  {
    explicit SmallFluid(const double coarsest = 1.)
      : fluid(MPI_COMM_WORLD, box, cells(coarsest, 0.5 * coarsest))
    {
      fluid.adapt(oracle::sphere_points({1.3, 1.1, 0.2}, 0.5));
      faces = std::make_unique<PrescribedVelocity>(fluid.space());
    }

    template <typename Formula>
    Columns
    on_faces(const Formula &formula) const
    {
      Columns        result;
      const Columns &x = faces->places();
      for (std::size_t i = 0; i < x[0].size(); ++i)
        {
          const auto u = formula(dealii::Point<3>(x[0][i], x[1][i], x[2][i]));
          for (unsigned int c = 0; c < 3; ++c)
            result[c].push_back(u[c]);
        }
      return result;
    }

    Fluid                               fluid;
    std::unique_ptr<PrescribedVelocity> faces;
  };

  std::array<double, 3>
  entries(const Vector &v)
  {
    return {{v[0], v[1], v[2]}};
  }

  /** Of degree two with all components, kept up by a pressure with the gradient of its Laplacian. */
  UndisturbedFlow
  quadratic_flow()
  {
    UndisturbedFlow result = plane_poiseuille(1.7, 0.6);
    result.constant        = Vector({0.3, -0.1, 0.2});
    result.linear          = dealii::Tensor<2, 3>({{0.4, 0.1, -0.7}, {0.2, -0.6, 0.3}, {0.5, 0.9, 0.2}});
    return result;
  }

  /** Nodal values of a pressure slope x. */
  void
  add_pressure(const SmallFluid &f, const double slope, FluidBlockVector &fields)
  {
    const auto positions = oracle::node_positions(f.fluid.mesh(), *f.fluid.space().pressure);
    for (std::size_t i = 0; i < positions.size(); ++i)
      fields.block(pressure_block).local_element(i) += slope * positions[i][0];
  }
} // namespace


TEST(PrescribedVelocity, FlowsOfDegreeTwoAreExact)
{
  const SmallFluid      f;
  const UndisturbedFlow flow    = quadratic_flow();
  const auto            formula = [&](const dealii::Point<3> &x) { return entries(flow.velocity(x)); };
  EXPECT_NEAR(f.faces->set(f.on_faces(formula)), 0., 1e-11); // without divergence, and Simpson's rule is exact
  FluidBlockVector fields = nodal_velocity(f.fluid.space(), formula), result;
  add_pressure(f, flow.quadratic[0][2][2], fields); // the Laplacian
  f.fluid.space().reinit(result);
  f.faces->vmult(result, fields);
  EXPECT_GT(fields.l2_norm(), 1.);
  EXPECT_LT(result.linfty_norm(), 1e-12);
}


TEST(PrescribedVelocity, WithZeroVelocitiesIsTheOperator)
{
  const SmallFluid f;
  FluidBlockVector fields, result, wanted;
  f.fluid.space().reinit(fields);
  f.fluid.space().reinit(result);
  f.fluid.space().reinit(wanted);
  oracle::set_rough(f.fluid.mesh(), *f.fluid.space().velocity, 1, fields.block(velocity_block));
  oracle::set_rough(f.fluid.mesh(), *f.fluid.space().pressure, 2, fields.block(pressure_block));
  StokesOperator      stokes(f.fluid.space());
  const unsigned int  n_cells = f.fluid.space().velocity->n_cells();
  std::vector<double> at_points(27 * n_cells);
  for (std::size_t i = 0; i < at_points.size(); ++i)
    at_points[i] = 0.5 + 0.1 * (i % 7);
  const Viscosity viscosity(at_points, 0.5);
  for (const bool varies : {false, true})
    {
      if (varies)
        {
          stokes.set_viscosity(viscosity);
          f.faces->set_viscosity(viscosity);
        }
      stokes.vmult(wanted, fields);
      f.faces->vmult(result, fields);
      EXPECT_GT(wanted.l2_norm(), 1.);
      result -= wanted;
      EXPECT_LT(result.linfty_norm(), 1e-12 * wanted.linfty_norm());
    }
}


TEST(PrescribedVelocity, NetFluxIsTakenOut)
{
  // Of x + L x the flux is three times the volume; what is left is L x. Rough velocities leave pressure equations that add up to nothing.
  const SmallFluid           f;
  const dealii::Tensor<2, 3> L = quadratic_flow().linear;
  EXPECT_NEAR(f.faces->set(f.on_faces([&](const dealii::Point<3> &x) { return x + L * x; })), 3. * box.volume(), 1e-10);
  FluidBlockVector fields = nodal_velocity(f.fluid.space(), [&](const dealii::Point<3> &x) { return entries(L * x); }), result(fields);
  f.faces->vmult(result, fields);
  EXPECT_LT(result.linfty_norm(), 1e-12);

  const auto rough = [&](const dealii::Point<3> &x) {
    return Vector({oracle::rough_value(f.fluid.mesh(), x, 0, 3), oracle::rough_value(f.fluid.mesh(), x, 1, 3), oracle::rough_value(f.fluid.mesh(), x, 2, 3)});
  };
  EXPECT_GT(std::abs(f.faces->set(f.on_faces(rough))), 1e-2);
  fields = 0.;
  f.faces->vmult(result, fields);
  EXPECT_GT(result.block(pressure_block).linfty_norm(), 1e-3);
  EXPECT_NEAR(result.block(pressure_block).mean_value(), 0., 1e-14);
}


TEST(PrescribedVelocity, OrderOfTheFlowOfAPointForceBeyondTheBox)
{
  const Vector force({1., 2., -3.}), place({4.5, 0.4, -0.5});
  const auto   exact = [&](const dealii::Point<3> &x) {
    const Vector y = x - place;
    return entries((force / y.norm() + y * (y * force) / std::pow(y.norm(), 3)) / (8. * dealii::numbers::PI));
  };
  std::vector<double> errors;
  for (const double coarsest : {1., 0.5, 0.25})
    {
      const SmallFluid f(coarsest);
      const double     flux = f.faces->set(f.on_faces(exact));
      FluidBlockVector zero, rhs, x;
      f.fluid.space().reinit(zero);
      f.fluid.space().reinit(rhs);
      f.fluid.space().reinit(x);
      f.faces->vmult(rhs, zero);
      rhs *= -1.;
      const LinearReport report = solve_fgmres(f.fluid.stokes(), f.fluid.preconditioner(), x, rhs, 1e-9, 200);
      EXPECT_TRUE(report.converged);
      const FluidBlockVector wanted = nodal_velocity(f.fluid.space(), exact);
      x.block(velocity_block) -= wanted.block(velocity_block);
      errors.push_back(x.block(velocity_block).l2_norm() / wanted.block(velocity_block).l2_norm());
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << "cells " << coarsest << ": error " << errors.back() << ", flux " << flux << ", " << report.iterations << " iterations" << std::endl;
    }
  EXPECT_GT(0.5 * std::log2(errors[0] / errors[2]), 2.75);
}


TEST(PrescribedVelocity, RefusesPeriodicFaces)
{
  Fluid fluid(MPI_COMM_WORLD, Box(4.), cells(1., 1.));
  fluid.adapt({dealii::Point<3>()});
  EXPECT_THROW(PrescribedVelocity faces(fluid.space()), std::logic_error);
}
