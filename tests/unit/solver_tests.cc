// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the monolithic system and Newton's method.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>

#include <iostream>

using namespace tanktread;

namespace
{
  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** Off the planes of symmetry, so that no quadrature point lies on a face of a fluid cell, where velocity gradients jump. */
  FittedShape
  shifted_capsule(const CapsuleShapeParameters &parameters)
  {
    FittedShape shape = make_capsule(parameters, 2);
    shape.control_points.rowwise() += Eigen::RowVector3d(0.0137, 0.0271, 0.0314);
    return shape;
  }

  /** A small scene: 162 control points, finest cell 10a/32, box 5a or 10a. */
  struct Scene
  {
    Scene(const ShellModuli            &moduli,
          const double                  shear_rate,
          const CapsuleShapeParameters &capsule,
          const SolverParameters       &solver_parameters,
          const double                  side        = 5.,
          const double                  finest_cell = 0.3125)
      : parameters(solver_parameters)
      , shape(shifted_capsule(capsule))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::second)
      , shell(surface, {}, moduli, shape.control_points)
      , coupling(surface, shell.reference_weights())
      , volume(enclosed_volume(surface, shape.control_points))
      , fluid(MPI_COMM_WORLD, side, mesh_parameters(finest_cell))
      , solver(parameters, shell, surface, coupling, volume, {shear_rate}, timings)
    {
      state.x = shape.control_points;
      fluid.adapt(coupling.points(state.x));
      solver.attach(fluid);
      fluid.space().reinit(state.fluid);
    }

    static FluidMeshParameters
    mesh_parameters(const double finest_cell)
    {
      FluidMeshParameters p;
      p.coarsest_cell = 1.25;
      p.finest_cell   = finest_cell;
      return p;
    }

    SolverParameters   parameters;
    FittedShape        shape;
    SubdivisionSurface surface;
    Shell              shell;
    Coupling           coupling;
    double             volume;
    Fluid              fluid;
    Timings            timings;
    NewtonSolver       solver;
    State              state;
  };

  CapsuleShapeParameters
  ellipsoid(const double x, const double y, const double z)
  {
    CapsuleShapeParameters capsule;
    capsule.shape       = Shape::ellipsoid;
    capsule.axes        = {{x, y, z}};
    capsule.inclination = 0.1;
    return capsule;
  }

  SolverParameters
  tight(const double newton, const double linear)
  {
    SolverParameters p;
    p.newton_tolerance = newton;
    p.linear_tolerance = linear;
    return p;
  }

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
    return std::max({u.block(0).linfty_norm(), u.block(1).linfty_norm(), u.block(2).linfty_norm()});
  }
} // namespace


TEST(ConstantPressureJump, DrivesNoFlow)
{
  // Nodal forces p0 dV/dx are those of a constant pressure jump; the indicator pressure alone can balance them.
  Scene        scene({20., 0.}, 0., ellipsoid(2., 1.5, 1.), tight(1e-9, 1e-9), 5., 0.15625);
  const double p0   = 3.7;
  scene.state.force = p0 * volume_gradient(scene.surface, scene.state.x);
  scene.coupling.move(scene.state.x);
  const LinearisedShell shell(scene.shell,
                              scene.surface,
                              scene.coupling,
                              scene.state,
                              ControlPoints::Zero(scene.state.x.rows(), 3),
                              VelocityGradients::Zero(scene.surface.n_points(), 9),
                              PointDerivatives::frozen,
                              0.,
                              1.);
  FluidBlockVector      rhs = monolithic_vector(scene.fluid.space(), scene.state.x.rows()), u(rhs);
  scene.coupling.spread(scene.state.force, rhs);
  const MonolithicOperator       matrix(scene.fluid.stokes(), shell);
  const MonolithicPreconditioner preconditioner(scene.fluid.preconditioner(), shell, scene.volume);
  const LinearReport             report = solve_fgmres(matrix, preconditioner, u, rhs, 1e-10, 300);
  ASSERT_TRUE(report.converged);
  const double largest = largest_velocity(u);
  EXPECT_LT(largest, 1e-7);
  EXPECT_NEAR(shell_unknowns(u, MPI_COMM_WORLD).pressure_jump, -p0, 1e-6);

  // Without it the continuous pressure leaves a spurious flow.
  FluidBlockVector load, spurious;
  scene.fluid.space().reinit(load);
  scene.fluid.space().reinit(spurious);
  scene.coupling.spread(scene.state.force, load);
  ASSERT_TRUE(solve_fgmres(scene.fluid.stokes(), scene.fluid.preconditioner(), spurious, load, 1e-8, 300).converged);
  const double largest_spurious = largest_velocity(spurious);
  EXPECT_GT(largest_spurious, 1e-3);
  if (is_root())
    std::cout << "largest velocity " << largest << " with, " << largest_spurious << " without the indicator pressure" << std::endl;
}


TEST(MonolithicSystem, IsTheDerivativeOfTheResidual)
{
  // One Newton step with exact linear solves from a point displaced by epsilon leaves a residual of order epsilon^2.
  Scene               scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-8, 1e-8));
  const ControlPoints x0 = scene.state.x;
  scene.solver.solve_flow(scene.state);
  ASSERT_TRUE(scene.solver.solve(scene.state, x0, 0.05).converged);

  SolverParameters one      = scene.parameters;
  one.max_newton_iterations = 1;
  NewtonSolver single(one, scene.shell, scene.surface, scene.coupling, scene.volume, {1.}, scene.timings);
  single.attach(scene.fluid);
  std::vector<double> left;
  for (const double epsilon : {4e-3, 1e-3})
    {
      State perturbed = scene.state;
      for (Eigen::Index i = 0; i < x0.rows(); ++i)
        {
          perturbed.x.row(i) += epsilon * Eigen::RowVector3d(std::sin(2. * x0(i, 1)), std::cos(x0(i, 2)), std::sin(x0(i, 0) + x0(i, 2)));
          perturbed.force.row(i) += epsilon * Eigen::RowVector3d(std::cos(x0(i, 1)), std::sin(x0(i, 2)), std::sin(x0(i, 0)));
        }
      perturbed.pressure_jump += 3. * epsilon;
      perturbed.volume_shift += epsilon;
      perturbed.fluid *= 1. + 5. * epsilon;
      const NewtonReport report = single.solve(perturbed, x0, 0.05);
      print("perturbed by " + std::to_string(epsilon), report);
      ASSERT_EQ(report.step_lengths, std::vector<double>{1.});
      left.push_back(report.residuals.back() / report.residuals.front());
    }
  // The reduction itself is proportional to epsilon, if it is limited by the second order and not by a missing derivative.
  EXPECT_LT(left[1], 0.35 * left[0]);
  EXPECT_LT(left[1], 1e-3);
}


TEST(Newton, ConvergesQuadratically)
{
  Scene scene({5., 0.2}, 1., {}, tight(1e-9, 1e-8));
  scene.solver.solve_flow(scene.state);
  for (unsigned int step = 0; step < 2; ++step)
    {
      const ControlPoints x_n    = scene.state.x;
      const NewtonReport  report = scene.solver.solve(scene.state, x_n, 0.1);
      print("step " + std::to_string(step), report);
      ASSERT_TRUE(report.converged);
      ASSERT_GE(report.residuals.size(), 4u);
      for (unsigned int i = 1; i + 1 < report.residuals.size(); ++i)
        if (report.residuals[i + 1] > 1e-10)
          {
            EXPECT_LT(report.residuals[i + 1], 3. * report.residuals[i] * report.residuals[i]);
          }
    }
  EXPECT_LT(std::abs(enclosed_volume(scene.surface, scene.state.x) / scene.volume - 1.), 1e-9);
}


TEST(Newton, ReportsWhatItCannotSolve)
{
  Scene            scene({5., 0.2}, 1., {}, tight(1e-9, 1e-3));
  SolverParameters few      = scene.parameters;
  few.max_linear_iterations = 2;
  NewtonSolver hopeless(few, scene.shell, scene.surface, scene.coupling, scene.volume, {1.}, scene.timings);
  hopeless.attach(scene.fluid);
  scene.state.force         = scene.shell.force(scene.state.x);
  const State        before = scene.state;
  const NewtonReport report = hopeless.solve(scene.state, before.x, 0.1);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.message.find("linear solver"), std::string::npos);
  EXPECT_EQ(scene.state.x, before.x);
  EXPECT_THROW(hopeless.solve_flow(scene.state), NumericalError);
}


TEST(BackwardEuler, EnergyFallsWithoutFlow)
{
  // Neo-Hookean membrane and Helfrich bending (kappa_B = 1) about a flat reference: the ellipsoid relaxes. Steps from 0.005 to 5 mu a^3 / kappa_B.
  for (const double dt : {0.005, 0.05, 0.5, 5.})
    {
      Scene scene({10., 1.}, 0., ellipsoid(1.4, 1.2, 1.), tight(1e-6, 1e-3));
      scene.solver.solve_flow(scene.state);
      const auto energy = [&]() {
        const Shell::Energy e = scene.shell.energy(scene.state.x);
        return e.membrane + e.bending;
      };
      double before = energy();
      for (unsigned int step = 0; step < 4; ++step)
        {
          const ControlPoints x_n    = scene.state.x;
          const NewtonReport  report = scene.solver.solve(scene.state, x_n, dt);
          ASSERT_TRUE(report.converged) << report.message;
          const double after = energy();
          EXPECT_LT(after, before) << "step " << step << " of length " << dt;
          if (is_root())
            std::cout << "dt " << dt << ": energy " << before << " -> " << after << ", " << report.newton_iterations << " Newton iterations" << std::endl;
          before = after;
        }
      EXPECT_LT(std::abs(enclosed_volume(scene.surface, scene.state.x) / scene.volume - 1.), 1e-8);
    }
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ::testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD);
}
