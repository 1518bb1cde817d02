// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the monolithic system and Newton's method.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/surface/surface_geometry.h>

#include "small_scene.h"

#include <iostream>

using namespace tanktread;

namespace
{
  void
  print(const std::string &what, const NewtonReport &report)
  {
    if (!is_root())
      return;
    std::cout << what << ": " << report.newton_iterations << " Newton, " << report.linear_iterations << " linear iterations, residuals";
    for (const double r : report.residuals)
      std::cout << ' ' << r;
    std::cout << (report.converged ? "" : " FAILED: " + report.message) << std::endl;
  }

  double
  largest_velocity(const FluidBlockVector &u)
  {
    return u.block(velocity_block).linfty_norm();
  }

  double
  volume_error(StartedScene &scene)
  {
    return scene.level().shells(scene.state)[0]->volume() / scene.capsule().volume() - 1.;
  }
} // namespace


TEST(PressureJumpResponse, IsAboutTheSchurComplement)
{
  // The flux through the shell that a unit pressure jump drives against the continuous pressures: far less than the volume, which it is without them.
  StartedScene scene(small_scene({20., 0.}, 0., ellipsoid(2., 1.5, 1.), tight(1e-9, 1e-9), 5., 0.15625));
  scene.move_points();
  const ControlPoints v = scene.level().shells(scene.state)[0]->volume_gradient();
  FluidBlockVector    load, flow;
  KrylovBasis         basis;
  const FluidOperator stokes{scene.fluid().stokes()};
  scene.fluid().space().reinit(load);
  scene.fluid().space().reinit(flow);
  scene.coupling().spread({v}, load);
  ASSERT_TRUE(solve_fgmres(stokes, scene.fluid().preconditioner(), flow, load, 1e-8, 200).converged);
  const double               exact = v.cwiseProduct(scene.coupling().interpolate(flow)[0]).sum();
  const PressureJumpResponse response(stokes, scene.fluid().preconditioner(), scene.coupling(), 1., basis);
  const double               s = response.schur_complements()[0];
  if (is_root())
    std::cout << "s = " << s << ", exact " << exact << ", volume " << scene.capsule().volume() << std::endl;
  EXPECT_LT(exact, 0.1 * scene.capsule().volume());
  EXPECT_GT(s, 0.5 * exact);
  EXPECT_LT(s, 4. * exact);

  // What only continuous pressures see is no pressure jump.
  FluidBlockVector pressure_rows(flow), product(flow);
  pressure_rows                       = 0.;
  pressure_rows.block(velocity_block) = load.block(velocity_block);
  scene.fluid().preconditioner().vmult(flow, pressure_rows);
  stokes.vmult(product, flow);
  const double flux = v.cwiseProduct(scene.coupling().interpolate(flow)[0]).sum();
  EXPECT_LT(std::abs(response.pressure_jumps(product.block(pressure_block), {-flux})[0]), 0.5 * std::abs(flux) / s);
}


TEST(ConstantPressureJump, DrivesNoFlow)
{
  // Nodal forces p0 dV/dx are those of a constant pressure jump; the indicator pressure alone can balance them.
  StartedScene  scene(small_scene({20., 0.}, 0., ellipsoid(2., 1.5, 1.), tight(1e-9, 1e-9), 5., 0.15625));
  const double  p0    = 3.7;
  CapsuleState &state = scene.state.capsules[0];
  state.force         = p0 * scene.level().shells(scene.state)[0]->volume_gradient();
  scene.move_points();
  const ShellLayout &layout = scene.layout();
  SolverMemory       memory;
  ImplicitShells     implicit_shells(layout, memory);
  Linearisation      at_rest;
  at_rest.derivatives = PointDerivatives::frozen;
  const LinearisedShells shells(scene.elasticity(),
                                scene.coupling(),
                                scene.state,
                                scene.level().shells(scene.state),
                                {ControlPoints::Zero(state.x.rows(), 3)},
                                at_rest,
                                implicit_shells);
  FluidBlockVector       rhs = layout.vector(scene.fluid().space()), u(rhs);
  scene.coupling().spread({state.force}, rhs);
  const MonolithicOperator       matrix(scene.fluid().stokes(), shells, layout);
  KrylovBasis                    basis;
  const PressureJumpResponse     jumps({scene.fluid().stokes()}, scene.fluid().preconditioner(), scene.coupling(), 1., basis);
  const MonolithicPreconditioner preconditioner(scene.fluid().preconditioner(), shells, layout, jumps);
  const LinearReport             report = solve_fgmres(matrix, preconditioner, u, rhs, 1e-10, 300);
  ASSERT_TRUE(report.converged);
  const double largest = largest_velocity(u);
  EXPECT_LT(largest, 1e-7);
  EXPECT_NEAR(layout.unknowns(u)[0].pressure_jump, -p0, 1e-6);

  // Without it the continuous pressure leaves a spurious flow.
  FluidBlockVector load, spurious;
  scene.fluid().space().reinit(load);
  scene.fluid().space().reinit(spurious);
  scene.coupling().spread({state.force}, load);
  ASSERT_TRUE(solve_fgmres(scene.fluid().stokes(), scene.fluid().preconditioner(), spurious, load, 1e-8, 300).converged);
  const double largest_spurious = largest_velocity(spurious);
  EXPECT_GT(largest_spurious, 1e-3);
  if (is_root())
    std::cout << "largest velocity " << largest << " with, " << largest_spurious << " without the indicator pressure" << std::endl;
}


namespace
{
  /** The state with all unknowns of the capsule and the liquid's moved by about epsilon. */
  State
  perturbed(const State &state, const ControlPoints &x0, const double epsilon)
  {
    State         result  = state;
    CapsuleState &capsule = result.capsules[0];
    for (Eigen::Index i = 0; i < x0.rows(); ++i)
      {
        capsule.x.row(i) += epsilon * Eigen::RowVector3d(std::sin(2. * x0(i, 1)), std::cos(x0(i, 2)), std::sin(x0(i, 0) + x0(i, 2)));
        capsule.force.row(i) += epsilon * Eigen::RowVector3d(std::cos(x0(i, 1)), std::sin(x0(i, 2)), std::sin(x0(i, 0)));
      }
    capsule.pressure_jump += 3. * epsilon;
    capsule.volume_shift += epsilon;
    result.fluid *= 1. + 5. * epsilon;
    return result;
  }

  /** What one Newton step with exact linear solves leaves of the residual, as part of it, from points displaced by 4e-3 and 1e-3. */
  std::vector<double>
  reductions(const double reynolds_number)
  {
    SceneDescription description        = small_scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-8, 1e-8));
    description.liquids.reynolds_number = reynolds_number;
    StartedScene        scene(std::move(description));
    const ControlPoints x0 = scene.x();
    scene.solver().solve_flow(scene.state);
    FluidVector uhat = scene.state.fluid.block(velocity_block);
    uhat *= 0.7;
    const TimeStep step{{x0}, 0.05, 0., &uhat};
    EXPECT_TRUE(scene.solver().solve(scene.state, step).converged);

    SolverParameters one      = scene.description().solver;
    one.max_newton_iterations = 1;
    SolverMemory        memory;
    NewtonSolver        single(one, scene.level(), memory, scene.timings());
    std::vector<double> left;
    for (const double epsilon : {4e-3, 1e-3})
      {
        State              moved  = perturbed(scene.state, x0, epsilon);
        const NewtonReport report = single.solve(moved, step);
        print("perturbed by " + std::to_string(epsilon), report);
        EXPECT_EQ(report.step_lengths, std::vector<double>{1.});
        left.push_back(report.residuals.back() / report.residuals.front());
      }
    return left;
  }
} // namespace


TEST(MonolithicSystem, IsTheDerivativeOfTheResidual)
{
  for (const double reynolds_number : {0., 3.})
    {
      const std::vector<double> left = reductions(reynolds_number);
      // The reduction itself is proportional to epsilon, if it is limited by the second order and not by a missing derivative.
      EXPECT_LT(left[1], 0.35 * left[0]);
      EXPECT_LT(left[1], 1e-3);
    }
}


TEST(Newton, ConvergesQuadratically)
{
  StartedScene scene(small_scene({5., 0.2}, 1., {}, tight(1e-9, 1e-8)));
  scene.solver().solve_flow(scene.state);
  for (unsigned int step = 0; step < 2; ++step)
    {
      const NewtonReport report = scene.solver().solve(scene.state, {positions(scene.state), 0.1});
      print("step " + std::to_string(step), report);
      ASSERT_TRUE(report.converged);
      ASSERT_GE(report.residuals.size(), 4u);
      for (unsigned int i = 1; i + 1 < report.residuals.size(); ++i)
        if (report.residuals[i + 1] > 1e-10)
          {
            EXPECT_LT(report.residuals[i + 1], 3. * report.residuals[i] * report.residuals[i]);
          }
    }
  EXPECT_LT(std::abs(volume_error(scene)), 1e-9);
}


TEST(Newton, FindsTheSameWithAnOldImplicitOperator)
{
  StartedScene scene(without_coarser_control_meshes(small_scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-7, 1e-3))));
  scene.solver().solve_flow(scene.state);
  const State        start = scene.state;
  const ShellFields  x_n   = positions(start);
  State              fresh = start, other = start;
  SolverMemory       memory;
  NewtonSolver       solver(scene.description().solver, scene.level(), memory, scene.timings());
  const NewtonReport of_fresh = scene.solver().solve(fresh, {x_n, 0.1});
  print("new operator", of_fresh);
  ASSERT_TRUE(of_fresh.converged);

  // An operator made for another shape and a shorter step.
  other.capsules[0].x *= Eigen::DiagonalMatrix<double, 3>(1.15, 0.9, 0.95);
  scene.level().set_forces(other);
  ASSERT_EQ(solver.implicit_shells().n_renewals(), 0u);
  solver.solve(other, {positions(other), 0.07});
  const unsigned int renewals = solver.implicit_shells().n_renewals();
  ASSERT_TRUE(solver.implicit_shells().serves(0.1));
  State              old    = start;
  const NewtonReport of_old = solver.solve(old, {x_n, 0.1});
  print("old operator", of_old);
  ASSERT_TRUE(of_old.converged);
  EXPECT_LT(solver.implicit_shells().n_renewals() - renewals, of_old.newton_iterations);
  // Residuals are velocities: errors of x are about tau times the tolerance.
  const double difference = (old.capsules[0].x - fresh.capsules[0].x).norm() / std::sqrt(x_n[0].rows());
  if (is_root())
    std::cout << "difference of the control points " << difference << std::endl;
  EXPECT_LT(difference, 0.1 * 1e-7);
}


TEST(Newton, ReportsWhatItCannotSolve)
{
  StartedScene     scene(small_scene({5., 0.2}, 1., {}, tight(1e-9, 1e-3)));
  SolverParameters few      = scene.description().solver;
  few.max_linear_iterations = 2;
  SolverMemory memory;
  NewtonSolver hopeless(few, scene.level(), memory, scene.timings());
  scene.level().set_forces(scene.state);
  const State        before = scene.state;
  const NewtonReport report = hopeless.solve(scene.state, {positions(before), 0.1});
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.message.find("linear solver"), std::string::npos);
  EXPECT_EQ(scene.x(), before.capsules[0].x);
  EXPECT_THROW(hopeless.solve_flow(scene.state), NumericalError);
}


/** Four steps of the relaxing ellipsoid, neo-Hookean membrane and Helfrich bending (kappa_B = 1) about a flat reference: each lowers the energy. */
void
expect_falling_energy(const double dt, const Interface interface)
{
  StartedScene scene(small_scene({10., 1.}, 0., ellipsoid(1.4, 1.2, 1.), tight(1e-6, 1e-3, interface)));
  scene.solver().solve_flow(scene.state);
  const auto energy = [&]() {
    const Shell::Energy e = scene.capsule().shell().energy(scene.x());
    return e.membrane + e.bending;
  };
  double before = energy();
  for (unsigned int step = 0; step < 4; ++step)
    {
      const NewtonReport report = scene.solver().solve(scene.state, {positions(scene.state), dt});
      ASSERT_TRUE(report.converged) << report.message;
      const double after = energy();
      EXPECT_LT(after, before) << "step " << step << " of length " << dt;
      if (is_root())
        std::cout << "dt " << dt << ": energy " << before << " -> " << after << ", " << report.newton_iterations << " Newton iterations" << std::endl;
      before = after;
    }
  EXPECT_LT(std::abs(volume_error(scene)), 1e-8);
}


// Steps from 0.005 to 5 mu a^3 / kappa_B.
TEST(BackwardEuler, EnergyFallsWithoutFlow)
{
  for (const double dt : {0.005, 0.05, 0.5, 5.})
    expect_falling_energy(dt, Interface::plain);
}


TEST(BackwardEuler, EnergyFallsWithoutFlowWithTheEnrichedInterface)
{
  for (const double dt : {0.005, 0.05, 0.5, 5.})
    expect_falling_energy(dt, Interface::enriched);
}


// The membrane is a thousand times stiffer than the bending that drives it: displacements that a loose tolerance, a velocity, lets through would cost a hundred times the energy that is left to lose.
TEST(BackwardEuler, EnergyOfAStiffMembraneFallsWithLooseTolerances)
{
  SolverParameters loose = tight(4e-3, 0.1, Interface::enriched);
  loose.volume_tolerance = 4e-5;
  for (const double dt : {0.1, 0.25})
    {
      StartedScene scene(small_scene({1000., 1.}, 0., ellipsoid(1.5, 1.5, 1.), loose));
      scene.solver().solve_flow(scene.state);
      const auto energy = [&]() {
        const Shell::Energy e = scene.capsule().shell().energy(scene.x());
        return e.membrane + e.bending;
      };
      double before = energy();
      for (unsigned int step = 0; step < 5; ++step)
        {
          const NewtonReport report = scene.solver().solve(scene.state, {positions(scene.state), dt});
          ASSERT_TRUE(report.converged) << report.message;
          const double after = energy();
          if (is_root())
            std::cout << "dt " << dt << ": energy " << before << " changes by " << after - before << ", " << report.newton_iterations << " Newton iterations"
                      << std::endl;
          EXPECT_LT(after - before, 1e-7 * before) << "step " << step << " of length " << dt;
          before = after;
        }
    }
}
