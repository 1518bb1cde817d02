// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Navier-Stokes equations against a manufactured solution.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <cmath>
#include <iostream>

#include "inertia_examples.h"
#include "nodal_velocity.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** A function of one coordinate with derivatives. */
  struct Wave
  {
    double amplitude, k, phase, constant; // constant + amplitude sin(k x + phase)

    double
    operator()(const double x, const unsigned int derivative) const
    {
      return (derivative == 0 ? constant : 0.) + amplitude * std::pow(k, derivative) * std::sin(k * x + phase + 0.5 * pi * derivative);
    }
  };

  /**
   * A solution of the Navier-Stokes equations with a body force in a box of side 4: u_x = g dS/dz, u_z = -g dS/dx, u_y = g T with products of waves S and T, S
   * and dS/dz zero at
   * the walls, T too and independent of y, so that div u = 0. g is a function of time.
   */
  class Manufactured
  {
  public:
    Manufactured(const double reynolds_number, const FlowInTime &undisturbed, const bool linear_in_time)
      : reynolds_number(reynolds_number)
      , undisturbed(undisturbed)
      , linear_in_time_(linear_in_time)
    {}

    std::array<double, 3>
    velocity(const Point &x, const double t) const
    {
      return {{g(t) * u(0, x, 0, 0, 0), g(t) * u(1, x, 0, 0, 0), g(t) * u(2, x, 0, 0, 0)}};
    }

    /** Re (du/dt + (u_inf + u) . grad u + u . grad u_inf) + grad p - laplace u */
    std::array<double, 3>
    force(const Point &x, const double t) const
    {
      std::array<double, 3>       result;
      const std::array<double, 3> v        = velocity(x, t);
      const UndisturbedFlow       u_inf    = undisturbed.at(t);
      const dealii::Tensor<2, 3>  gradient = u_inf.gradient(x);
      const dealii::Tensor<1, 3>  wind     = u_inf.velocity(x) + Point(v[0], v[1], v[2]);
      for (unsigned int c = 0; c < 3; ++c)
        {
          const double convection = g(t) * (wind[0] * u(c, x, 1, 0, 0) + wind[1] * u(c, x, 0, 1, 0) + wind[2] * u(c, x, 0, 0, 1)) + gradient[c][0] * v[0] +
            gradient[c][1] * v[1] + gradient[c][2] * v[2];
          const double laplace = g(t) * (u(c, x, 2, 0, 0) + u(c, x, 0, 2, 0) + u(c, x, 0, 0, 2));
          result[c]            = reynolds_number * (dg(t) * u(c, x, 0, 0, 0) + convection) + g(t) * P(x, c == 0, c == 1, c == 2) - laplace;
        }
      return result;
    }

    const double     reynolds_number;
    const FlowInTime undisturbed;

  private:
    double
    g(const double t) const
    {
      return linear_in_time_ ? 1. + t : std::cos(2. * t);
    }
    double
    dg(const double t) const
    {
      return linear_in_time_ ? 1. : -2. * std::sin(2. * t);
    }
    static double
    product(const std::array<Wave, 3> &waves, const Point &x, const unsigned int i, const unsigned int j, const unsigned int k)
    {
      return waves[0](x[0], i) * waves[1](x[1], j) * waves[2](x[2], k);
    }
    static double
    P(const Point &x, const unsigned int i, const unsigned int j, const unsigned int k)
    {
      return product({{{1., pi / 2., 0.3, 0.}, {1., pi / 2., 0., 0.5}, {1., pi / 4., 0.2, 0.}}}, x, i, j, k);
    }
    /** Derivatives of component c. */
    static double
    u(const unsigned int c, const Point &x, const unsigned int i, const unsigned int j, const unsigned int k)
    {
      const std::array<Wave, 3> S = {{{1., pi / 2., 0., 0.}, {0.5, pi / 2., 0.4, 1.}, {0.5, pi / 2., 0.5 * pi, 0.5}}}; // (1 + cos(pi z / 2)) / 2
      const std::array<Wave, 3> T = {{{1., pi / 2., 0.8, 0.3}, {0., 0., 0., 1.}, {1., pi / 4., 0.5 * pi, 0.}}};        // cos(pi z / 4)
      return c == 0 ? product(S, x, i, j, k + 1) : c == 1 ? product(T, x, i, j, k) : -product(S, x, i + 1, j, k);
    }

    bool linear_in_time_;
  };

  /** The liquid alone, driven by the body force of a manufactured solution. */
  class DrivenLiquid
  {
  public:
    DrivenLiquid(const Manufactured &exact, const double coarsest_cell, const double finest_cell)
      : exact_(exact)
      , fluid_(MPI_COMM_WORLD, 4., mesh_parameters(coarsest_cell, finest_cell))
    {
      fluid_.adapt({Point(0.3, 0.2, 0.3), Point(-0.3, -0.4, -0.2)});
      inertia_ = std::make_unique<Inertia>(fluid_.space(), exact.reynolds_number, exact.undisturbed.at(0.));
      choose_points();
    }

    /** From the exact flow at time 0 to `end`; a first step of backward Euler and, if `second_order`, BDF2. Returns the flow. */
    FluidBlockVector
    run(const double end, const unsigned int n_steps, const bool second_order)
    {
      const double     dt     = end / n_steps;
      FluidBlockVector before = nodal_velocity(fluid_.space(), [&](const Point &x) { return exact_.velocity(x, 0.); }), u(before);
      for (unsigned int n = 1; n <= n_steps; ++n)
        {
          const bool       bdf2 = second_order && n > 1;
          FluidBlockVector uhat(u);
          if (bdf2)
            uhat.sadd(4. / 3., -1. / 3., before);
          before = u;
          step(uhat, bdf2 ? dt / 1.5 : dt, n * dt, u);
        }
      return u;
    }

    /** Difference from the exact flow, root of its square integral. */
    double
    error(const FluidBlockVector &u, const double t) const
    {
      std::vector<double> values;
      points_->values(u, values);
      double sum = 0.;
      for (unsigned int r = 0; r < values.size() / 3; ++r)
        {
          const unsigned int          q = points_->local_points()[r];
          const std::array<double, 3> v = exact_.velocity(positions_[q], t);
          for (unsigned int c = 0; c < 3; ++c)
            sum += weights_[q] * std::pow(values[3 * r + c] - v[c], 2);
        }
      return std::sqrt(dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD));
    }

    unsigned int largest_iterations = 0; // of a linear solve by 1e-6

  private:
    /** Gauss points of all cells, on all ranks. */
    void
    choose_points()
    {
      const dealii::QGauss<3> rule(4);
      std::vector<double>     local;
      for (const auto &cell : fluid_.mesh().triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          for (unsigned int q = 0; q < rule.size(); ++q)
            {
              const double h = fluid_.mesh().cell_size(cell->level());
              const Point  x = cell->vertex(0) + h * rule.point(q);
              local.insert(local.end(), {x[0], x[1], x[2], h * h * h * rule.weight(q)});
            }
      for (const auto &numbers : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, local))
        for (std::size_t i = 0; i < numbers.size(); i += 4)
          {
            positions_.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
            weights_.push_back(numbers[i + 3]);
          }
      points_ = std::make_unique<PointInterpolation>(fluid_.space());
      points_->reinit(positions_);
    }

    FluidBlockVector
    load(const double t) const
    {
      std::vector<double> forces;
      for (const unsigned int q : points_->local_points())
        for (const double f : exact_.force(positions_[q], t))
          forces.push_back(weights_[q] * f);
      FluidBlockVector result;
      fluid_.space().reinit(result);
      points_->add_load(forces, {}, result);
      return result;
    }

    struct Operator
    {
      const StokesMap &stokes;
      const Inertia   &inertia;

      void
      vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
      {
        stokes.vmult(dst, src);
        inertia.add_derivative(src, dst);
      }
    };

    void
    step(const FluidBlockVector &uhat, const double tau, const double t, FluidBlockVector &u)
    {
      inertia_->set_flow(exact_.undisturbed.at(t));
      inertia_->begin_step(uhat.block(velocity_block), tau);
      fluid_.set_shift(inertia_->mass());
      const FluidBlockVector f = load(t);
      FluidBlockVector       r(f), du;
      for (unsigned int iteration = 0;; ++iteration)
        {
          fluid_.stokes().vmult(r, u);
          inertia_->add_residual(u, r);
          r.sadd(-1., f);
          if (r.l2_norm() < 1e-9 * f.l2_norm())
            return;
          ASSERT_LT(iteration, 8u);
          inertia_->linearise(u);
          fluid_.space().reinit(du);
          const LinearReport report = solve_fgmres(Operator{fluid_.stokes(), *inertia_}, fluid_.preconditioner(), du, r, 1e-6, 200);
          ASSERT_TRUE(report.converged);
          largest_iterations = std::max(largest_iterations, report.iterations);
          u += du;
        }
    }

    const Manufactured                 &exact_;
    Fluid                               fluid_;
    std::unique_ptr<Inertia>            inertia_;
    std::vector<Point>                  positions_;
    std::vector<double>                 weights_;
    std::unique_ptr<PointInterpolation> points_;
  };
} // namespace


// With hanging nodes. The flow is linear in time, for which both schemes are exact: what is left is the error in space.
TEST(NavierStokes, ThirdOrderInSpace)
{
  for (const UndisturbedFlow &undisturbed : {simple_shear(), linear_in_all_directions(), quadratic_in_all_directions()})
    {
      const Manufactured exact(2., {undisturbed}, true);
      double             before = 0.;
      for (const double h : {1., 0.5})
        {
          DrivenLiquid           liquid(exact, h, 0.5 * h);
          const FluidBlockVector u     = liquid.run(0.2, 2, true);
          const double           error = liquid.error(u, 0.2);
          if (is_root())
            std::cout << "cells " << h << " and " << 0.5 * h << ": error " << error << ", order " << std::log2(before / error) << ", at most "
                      << liquid.largest_iterations << " linear iterations" << std::endl;
          if (before > 0.)
            {
              EXPECT_GT(std::log2(before / error), 2.8);
            }
          EXPECT_LT(liquid.largest_iterations, 25u);
          before = error;
        }
    }
}


// In a flow that swings.
TEST(NavierStokes, OrdersInTime)
{
  const Manufactured exact(2., {plane_poiseuille(2., 2.), 3.}, false);
  DrivenLiquid       liquid(exact, 1., 1.);
  for (const bool second_order : {false, true})
    {
      std::vector<FluidBlockVector> u;
      for (const unsigned int n_steps : {8, 16, 32})
        u.push_back(liquid.run(0.5, n_steps, second_order));
      u[0] -= u[1];
      u[1] -= u[2];
      const double coarse = norm(u[0]), fine = norm(u[1]), order = std::log2(coarse / fine);
      if (is_root())
        std::cout << (second_order ? "BDF2" : "backward Euler") << ": differences " << coarse << ", " << fine << ", order " << order << std::endl;
      EXPECT_NEAR(order, second_order ? 2. : 1., 0.15);
    }
}
