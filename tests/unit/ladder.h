// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a mesh with all that solves on it, for tests of the multigrid.

#ifndef tanktread_tests_ladder_h
#define tanktread_tests_ladder_h

#include <deal.II/lac/solver_cg.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/stokes_preconditioner.h>

#include "full_arrays.h"

namespace tanktread
{
  /** A finished mesh with everything that solves on it. */
  struct Ladder
  {
    Ladder(const MPI_Comm comm, const Scene &scene)
      : mesh(comm, scene.box, cells(scene.coarsest, scene.finest))
    {
      mesh.aim_at(scene.band);
      multigrid.start(mesh);
      while (!mesh.on_last_rung())
        multigrid.climb(mesh);
    }

    const NodeSpace &
    nodes() const
    {
      return *multigrid.space();
    }

    /** solution of one V-cycle. */
    Array<float>
    v_cycle(const Array<float> &f)
    {
      std::copy(f.begin(), f.begin() + 4 * std::size_t(nodes().n_owned()), multigrid.right_hand_side());
      multigrid.v_cycle();
      Array<float> result(f.size());
      std::copy(multigrid.solution(), multigrid.solution() + 4 * std::size_t(nodes().n_owned()), result.begin());
      return result;
    }

    FluidMesh        mesh;
    Multigrid<float> multigrid;
  };

  /** The velocities' Laplace operator in double precision and its preconditioner, for deal.II's solvers. */
  class Laplace
  {
  public:
    explicit Laplace(const NodeSpace &space)
      : space_(space)
      , laplace_(space)
      , x_(space.full_size())
      , y_(space.full_size())
    {}

    void
    vmult(FluidVector &dst, const FluidVector &src) const
    {
      space_.load(src, x_.data());
      laplace_.apply(x_.data(), y_.data());
      space_.store(y_.data(), dst, false);
    }

  private:
    const NodeSpace              &space_;
    const LaplaceOperator<double> laplace_;
    mutable Array<double>         x_, y_;
  };

  struct VCycle
  {
    void
    vmult(FluidVector &dst, const FluidVector &src) const
    {
      multigrid.space()->load(src, multigrid.right_hand_side());
      multigrid.v_cycle();
      multigrid.space()->store(multigrid.solution(), dst, false);
    }

    Multigrid<float> &multigrid;
  };

  struct Solve
  {
    unsigned int iterations;
    double       energy; // of the right-hand side: f A^{-1} f
  };

  /** Conjugate gradients until the residual has fallen by `tolerance`. */
  inline Solve
  solve_laplace(Ladder &ladder, const FluidVector &f, const double tolerance)
  {
    FluidVector                   u(f);
    dealii::SolverControl         control(100, tolerance * f.l2_norm(), false, false);
    dealii::SolverCG<FluidVector> solver(control);
    u = 0.;
    solver.solve(Laplace(ladder.nodes()), u, f, VCycle{ladder.multigrid});
    return {control.last_step(), u * f};
  }

  inline FluidVector
  rough_vector(const Ladder &ladder)
  {
    FluidVector result(ladder.nodes().partitioner());
    oracle::set_rough(ladder.mesh, ladder.nodes(), 1, result);
    return result;
  }

  /** Each cell puts its size to the power `power` at each of its nodes: a right-hand side that moves with the mesh. */
  inline FluidVector
  load_of_cells(const Ladder &ladder, const double power)
  {
    const NodeSpace &space = ladder.nodes();
    Array<double>    y(space.full_size());
    for (unsigned int cell = 0; cell < space.n_cells(); ++cell)
      for (unsigned int a = 0; a < 27; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          y[4 * space.cell_nodes(cell)[a] + c] += std::pow(space.cell_sizes()[cell], power) * (c + a);
    space.collect(y.data());
    FluidVector result(space.partitioner());
    space.store(y.data(), result, false);
    return result;
  }

  /** Iterations of the Stokes equations to 1e-6 with rough forces. */
  inline unsigned int
  stokes_iterations(Ladder &ladder)
  {
    Multigrid<float> pressures({{}, 1});
    ladder.mesh.restart();
    pressures.start(ladder.mesh);
    while (!ladder.mesh.on_last_rung())
      pressures.climb(ladder.mesh); // to the same mesh
    const TaylorHoodSpace      space(ladder.mesh, ladder.multigrid.space());
    const StokesOperator       stokes(space);
    const StokesPreconditioner preconditioner(space, ladder.multigrid, pressures);
    FluidBlockVector           x, rhs;
    space.reinit(x);
    space.reinit(rhs);
    rhs.block(velocity_block) = rough_vector(ladder);
    const LinearReport report = solve_fgmres(stokes, preconditioner, x, rhs, 1e-6, 100);
    EXPECT_TRUE(report.converged);
    return report.iterations;
  }
} // namespace tanktread

#endif
