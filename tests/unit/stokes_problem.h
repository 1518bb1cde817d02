// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Stokes flows with a known solution in any box, for tests.

#ifndef tanktread_tests_stokes_problem_h
#define tanktread_tests_stokes_problem_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/assembled_stokes.h>
#include <tanktread/fluid/compat.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/linear_solver.h>

#include <cmath>
#include <iostream>

namespace tanktread
{
  /** The fluid and the assembled equations on its mesh. */
  struct Problem
  {
    Problem(const MPI_Comm comm, const Box &box, const double coarse, const double fine, const std::vector<dealii::Point<3>> &band)
      : fluid(comm, box, parameters(coarse, fine))
      , adapted(fluid.adapt(band))
      , assembled(fluid.space())
    {}

    static FluidMeshParameters
    parameters(const double coarse, const double fine)
    {
      FluidMeshParameters p;
      p.coarsest_cell = coarse;
      p.finest_cell   = fine;
      return p;
    }

    /** Solves for `solution`, given on the faces with prescribed velocity, and returns nodal values with all constraints resolved and ghosts set. */
    template <typename Solution>
    ComponentVector
    solve(const Solution &solution, LinearReport &report) const;

    Fluid           fluid;
    bool            adapted;
    AssembledStokes assembled;
  };

  inline bool
  is_on_prescribed_face(const Box &box, const dealii::Point<3> &x)
  {
    bool result = false;
    for (unsigned int d = 0; d < 3; ++d)
      result = result || (!box.is_periodic(d) && std::abs(std::abs(x[d]) - 0.5 * box.side[d]) < 1e-10);
    return result;
  }

  /** Nodal interpolant at the nodes of faces with prescribed velocity, zero elsewhere, constraints other than those of the faces resolved. */
  template <typename Solution>
  ComponentVector
  face_values(const Solution &solution, const AssembledStokes &stokes)
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
              const dealii::Point<3> x = cell->vertex(0) + stokes.mesh().cell_size(cell->level()) * dofs.get_fe().unit_support_point(a);
              if (is_on_prescribed_face(stokes.mesh().box(), x))
                for (unsigned int c = 0; c < 3; ++c)
                  if (lift.block(c).locally_owned_elements().is_element(indices[a]))
                    lift.block(c)(indices[a]) = solution.velocity(x)[c];
            }
        }
    // Hanging nodes on the faces follow their masters, also those across periodic faces, or the lifted field would not be continuous.
    dealii::AffineConstraints<double> hanging;
    compat::reinit(hanging, dofs.locally_owned_dofs(), dealii::DoFTools::extract_locally_relevant_dofs(dofs));
    dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
    for (unsigned int d = 0; d < 3; ++d)
      if (stokes.mesh().box().is_periodic(d))
        dealii::DoFTools::make_periodicity_constraints(dofs, 2 * d, 2 * d + 1, d, hanging);
    hanging.close();
    for (unsigned int c = 0; c < 3; ++c)
      hanging.distribute(lift.block(c));
    lift.update_ghost_values();
    return lift;
  }

  template <typename Solution>
  void
  add_body_force(const Solution &solution, const AssembledStokes &stokes, ComponentVector &rhs)
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
                  load[a] += solution.force(values.quadrature_point(q))[c] * values.shape_value(a, q) * values.JxW(q);
              stokes.velocity().constraints().distribute_local_to_global(load, indices, rhs.block(c));
            }
        }
    rhs.compress(dealii::VectorOperation::add);
  }

  /**
   * rhs -= operator applied to a field with its own wall values.
   *
   * @param field full nodal values, all constraints resolved, ghost values up to date; need not vanish at the walls.
   */
  inline void
  subtract_applied(const AssembledStokes &stokes, const ComponentVector &field, ComponentVector &rhs)
  {
    const ReferenceMatrices                      reference;
    std::vector<dealii::types::global_dof_index> u_dofs(27), p_dofs(8);
    dealii::Vector<double>                       u_local(27), u_load(27), p_load(8), p_local(8), product(8);
    for (const auto &cell : stokes.velocity().dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const double h = stokes.mesh().cell_size(cell->level());
          cell->get_dof_indices(u_dofs);
          dealii::DoFHandler<3>::active_cell_iterator(&stokes.mesh().triangulation(), cell->level(), cell->index(), &stokes.pressure().dofs())
            ->get_dof_indices(p_dofs);
          p_load = 0.;
          for (unsigned int j = 0; j < 8; ++j)
            p_local[j] = field.block(3)(p_dofs[j]);
          for (unsigned int c = 0; c < 3; ++c)
            {
              for (unsigned int a = 0; a < 27; ++a)
                u_local[a] = field.block(c)(u_dofs[a]);
              reference.laplace.vmult(u_load, u_local);
              u_load *= -h;
              reference.divergence[c].vmult(product, u_local);
              p_load.add(h * h, product);
              dealii::Vector<double> gradient(27);
              reference.divergence[c].Tvmult(gradient, p_local);
              u_load.add(h * h, gradient);
              stokes.velocity().constraints().distribute_local_to_global(u_load, u_dofs, rhs.block(c));
            }
          stokes.pressure().constraints().distribute_local_to_global(p_load, p_dofs, rhs.block(3));
        }
    rhs.compress(dealii::VectorOperation::add);
  }

  template <typename Solution>
  ComponentVector
  Problem::solve(const Solution &solution, LinearReport &report) const
  {
    ComponentVector load, correction, result = face_values(solution, assembled);
    assembled.reinit(load);
    assembled.reinit(correction);
    add_body_force(solution, assembled, load);
    subtract_applied(assembled, result, load);

    FluidBlockVector rhs, x;
    fluid.space().reinit(rhs);
    fluid.space().reinit(x);
    assembled.to_nodes(load, rhs);
    // What the faces let in and out cancels only up to quadrature: take the part out that no velocity can balance.
    rhs.block(pressure_block).add(-rhs.block(pressure_block).mean_value());
    report = solve_fgmres(fluid.stokes(), fluid.preconditioner(), x, rhs, 1e-12, 200);

    assembled.to_components(x, correction);
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
  errors(const Solution &exact, const AssembledStokes &stokes, const ComponentVector &solution)
  {
    const dealii::QGauss<3> quadrature(5);
    const auto              flags = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    dealii::FEValues<3>     u(stokes.velocity().dofs().get_fe(), quadrature, flags), p(stokes.pressure().dofs().get_fe(), quadrature, flags);
    std::vector<double>     values(quadrature.size()), pressure_errors, weights;
    double                  eu = 0., ep = 0., mean = 0.;
    for (const auto &cell : stokes.velocity().dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          u.reinit(cell);
          for (unsigned int c = 0; c < 3; ++c)
            {
              u.get_function_values(solution.block(c), values);
              for (const auto q : u.quadrature_point_indices())
                eu += std::pow(values[q] - exact.velocity(u.quadrature_point(q))[c], 2) * u.JxW(q);
            }
          p.reinit(dealii::DoFHandler<3>::active_cell_iterator(&stokes.mesh().triangulation(), cell->level(), cell->index(), &stokes.pressure().dofs()));
          p.get_function_values(solution.block(3), values);
          for (const auto q : p.quadrature_point_indices())
            {
              pressure_errors.push_back(values[q] - exact.pressure(p.quadrature_point(q)));
              weights.push_back(p.JxW(q));
              mean += pressure_errors.back() * weights.back();
            }
        }
    const MPI_Comm comm = stokes.mesh().communicator();
    mean                = dealii::Utilities::MPI::sum(mean, comm) / stokes.mesh().box().volume();
    for (std::size_t i = 0; i < weights.size(); ++i) // in a second pass: squares minus the square of a mean may be nothing but rounding
      ep += std::pow(pressure_errors[i] - mean, 2) * weights[i];
    return {std::sqrt(dealii::Utilities::MPI::sum(eu, comm)), std::sqrt(dealii::Utilities::MPI::sum(ep, comm))};
  }

  /**
   * Errors with cells of the sizes of `coarse_cells`, `levels_above_coarse` times halved at `band`, fall as third order for velocities and second order for
   * pressures.
   */
  template <typename Solution>
  void
  expect_orders(const Solution                      &exact,
                const Box                           &box,
                const std::vector<double>           &coarse_cells,
                const std::vector<dealii::Point<3>> &band,
                const unsigned int                   levels_above_coarse)
  {
    std::vector<std::pair<double, double>> e;
    for (const double coarse : coarse_cells)
      {
        const Problem problem(MPI_COMM_WORLD, box, coarse, coarse / (1 << levels_above_coarse), band);
        LinearReport  report;
        const auto    solution = problem.solve(exact, report);
        EXPECT_TRUE(report.converged);
        EXPECT_NEAR(problem.fluid.mesh().cell_size(problem.fluid.mesh().coarsest_level()), coarse, 1e-12);
        e.push_back(errors(exact, problem.assembled, solution));
        if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          std::cout << "coarse cell " << coarse << ": " << problem.fluid.mesh().triangulation().n_global_active_cells() << " cells, error u " << e.back().first
                    << ", p " << e.back().second << ", " << report.iterations << " iterations" << std::endl;
      }
    for (unsigned int i = 1; i < e.size(); ++i)
      {
        EXPECT_GT(std::log2(e[i - 1].first / e[i].first), 2.75);
        EXPECT_GT(std::log2(e[i - 1].second / e[i].second), 1.8);
      }
  }
} // namespace tanktread

#endif
