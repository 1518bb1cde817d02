// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the terms of inertia, flows carried from mesh to mesh, and the Navier-Stokes equations against a manufactured solution.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/field_transfer.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/fluid/inertia.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <cmath>
#include <iostream>

#include "nodal_velocity.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  constexpr double pi = dealii::numbers::PI;

  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  FluidMeshParameters
  mesh_parameters(const double coarsest, const double finest)
  {
    FluidMeshParameters p;
    p.coarsest_cell = coarsest;
    p.finest_cell   = finest;
    p.band_width    = 1.;
    return p;
  }

  double
  norm(const FluidBlockVector &u)
  {
    return u.block(velocity_block).l2_norm();
  }

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

  /** Along x, y and z, and changing along all of them. Where the box is periodic the wind jumps, which the terms do not mind: they are sums over cells. */
  UndisturbedFlow
  linear_in_all_directions()
  {
    UndisturbedFlow flow = uniaxial_extension(0.4);
    flow.constant[1]     = 0.2;
    flow.linear[0][1]    = 0.3;
    flow.linear[1][2]    = -0.5;
    flow.linear[2][0]    = 0.6;
    return flow;
  }

  /** Two parabolas and (yz, 0, 0) on top of it. */
  UndisturbedFlow
  quadratic_in_all_directions()
  {
    UndisturbedFlow flow    = linear_in_all_directions();
    flow.quadratic          = plane_poiseuille(2., 1.1).quadratic;
    flow.quadratic[2][0][0] = 0.3;
    flow.quadratic[0][1][2] = flow.quadratic[0][2][1] = 0.2;
    return flow;
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


namespace
{
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
      , fluid_(MPI_COMM_WORLD, 4., mesh_parameters(coarsest_cell, finest_cell), true)
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
      const StokesOperator &stokes;
      const Inertia        &inertia;

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
