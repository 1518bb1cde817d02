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
          const double                  finest_cell = 0.3125,
          const bool                    inertia     = false)
      : parameters(solver_parameters)
      , shape(shifted_capsule(capsule))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::second)
      , serial_shell(surface, {}, moduli, shape.control_points)
      , shell(serial_shell, shape.topology, MPI_COMM_WORLD)
      , coupling_surface(shape.topology,
                         parameters.interface == Interface::plain ? triangle_quadrature(3)
                                                                  : coupling_quadrature(shape.topology, shape.control_points, Interface::enriched, finest_cell),
                         Derivatives::second)
      , coupling(coupling_surface, area_weights(coupling_surface, shape.control_points), parameters.interface)
      , volume(enclosed_volume(surface, shape.control_points))
      , fluid(MPI_COMM_WORLD, side, mesh_parameters(finest_cell), inertia)
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
    Shell              serial_shell;
    DistributedShell   shell;
    SubdivisionSurface coupling_surface;
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
  tight(const double newton, const double linear, const Interface interface = Interface::plain)
  {
    SolverParameters p;
    p.interface        = interface;
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
    return u.block(velocity_block).linfty_norm();
  }
} // namespace


TEST(DistributedShell, SumsTheFacesOfAllRanks)
{
  Scene scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-8, 1e-8));
  scene.state.x.col(0) += 0.1 * scene.state.x.col(2);
  const unsigned int n_faces = scene.shell.faces().size();
  EXPECT_EQ(dealii::Utilities::MPI::sum(n_faces, MPI_COMM_WORLD), scene.surface.n_faces());
  const Shell::Energy e = scene.shell.energy(scene.state.x), serial_e = scene.serial_shell.energy(scene.state.x);
  EXPECT_NEAR(e.membrane, serial_e.membrane, 1e-13 * serial_e.membrane);
  EXPECT_NEAR(e.bending, serial_e.bending, 1e-13 * serial_e.bending);
  ControlPoints f, serial_f;
  SparseMatrix  K, serial_K;
  for (unsigned int again = 0; again < 2; ++again) // the second time with a matrix that has the pattern
    {
      scene.shell.force_and_tangent(scene.state.x, f, K);
      scene.serial_shell.force_and_tangent(scene.state.x, serial_f, serial_K);
      EXPECT_LT((f - serial_f).norm(), 1e-13 * serial_f.norm());
      EXPECT_LT((scene.shell.force(scene.state.x) - serial_f).norm(), 1e-13 * serial_f.norm());
      EXPECT_LT((K.coeffs() - serial_K.coeffs()).matrix().norm(), 1e-13 * serial_K.norm());
    }
}


TEST(DistributedShell, FailsOnAllRanksAlike)
{
  Scene scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8));
  scene.state.x(3, 1) = std::nan(""); // in the faces of some ranks only
  ControlPoints f;
  SparseMatrix  K;
  EXPECT_THROW(scene.shell.force(scene.state.x), NumericalError);
  EXPECT_THROW(scene.shell.energy(scene.state.x), NumericalError);
  EXPECT_THROW(scene.shell.force_and_tangent(scene.state.x, f, K), NumericalError);
}


namespace
{
  SparseMatrix
  random_blocks(const SubdivisionSurface &surface, const double size)
  {
    SparseMatrix matrix = surface.pattern().block_matrix();
    for (Eigen::Index k = 0; k < matrix.nonZeros(); ++k)
      matrix.valuePtr()[k] = size * std::sin(1000. * k);
    return matrix;
  }

  ControlPoints
  smooth_field(const ControlPoints &x)
  {
    ControlPoints result(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      result.row(i) << std::sin(2. * x(i, 1)), std::cos(x(i, 2)), std::sin(x(i, 0) + x(i, 2));
    return result;
  }
} // namespace


TEST(BlockFactorisation, Solves)
{
  Scene              scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8));
  BlockFactorisation factors;
  SparseMatrix       matrix = random_blocks(scene.surface, 1.);
  for (const double shift : {20., 0.5}) // dominated by the diagonal, and not
    {
      matrix += SparseMatrix(shift * Eigen::VectorXd::Ones(matrix.rows()).asDiagonal().toDenseMatrix().sparseView());
      const Eigen::VectorXd b = flat(smooth_field(scene.state.x)), x = factors.solve((factors.factorise(matrix, "It"), b));
      EXPECT_LT((matrix * x - b).norm(), 1e-9 * b.norm());
    }
  try
    {
      factors.factorise(scene.surface.pattern().block_matrix(), "It");
      ADD_FAILURE();
    }
  catch (const NumericalError &error)
    {
      EXPECT_STREQ(error.what(), "It is singular.");
    }
}


TEST(ImplicitShell, IsKeptWhileItServes)
{
  Scene         scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8));
  ImplicitShell implicit_shell(MPI_COMM_WORLD);
  const auto   &Z = scene.coupling.mass();
  EXPECT_FALSE(implicit_shell.serves(0.1));
  const Eigen::Matrix3d g = ShearFlow{3.}.gradient();
  const SparseMatrix    K = random_blocks(scene.surface, 1e-3);
  implicit_shell.renew(Z, g, K, 0.1);
  for (const auto &[tau, serves] : {std::pair<double, bool>{0.1, true}, {0.149, true}, {0.151, false}, {0.067, true}, {0.066, false}})
    EXPECT_EQ(implicit_shell.serves(tau), serves) << tau;

  // Z_tau (Z_tau + tau K)^{-1} with Z_tau = Z (1 - tau g), on the first rank
  const ControlPoints force = smooth_field(scene.state.x), velocity = implicit_shell.velocity(force);
  if (is_root())
    {
      const ControlPoints resistance = Z * velocity * (Eigen::Matrix3d::Identity() - 0.1 * g).transpose();
      EXPECT_LT((resistance + nodal(0.1 * (K * flat(velocity))) - force).norm(), 1e-12 * force.norm());
      EXPECT_LT((implicit_shell.damped(force) - resistance).norm(), 1e-12 * force.norm());
    }

  implicit_shell.watch({true, 10, 1., 1e-2});
  implicit_shell.watch({true, 24, 1., 1e-4}); // 22 + 1 allowed, but 5 a decade
  EXPECT_FALSE(implicit_shell.serves(0.1));
  implicit_shell.renew(Z, g, K, 0.1);
  implicit_shell.watch({true, 10, 1., 1e-2});
  implicit_shell.watch({true, 22, 1., 1e-4});
  EXPECT_TRUE(implicit_shell.serves(0.1));
  implicit_shell.discard();
  EXPECT_FALSE(implicit_shell.serves(0.1));
  EXPECT_EQ(implicit_shell.n_renewals(), 2u);

  SparseMatrix minus_Z = scene.surface.pattern().block_matrix();
  add_for_three_components(Z, minus_Z);
  minus_Z *= -1.;
  EXPECT_THROW(implicit_shell.renew(Z, Eigen::Matrix3d::Zero(), minus_Z, 1.), NumericalError);
  EXPECT_FALSE(implicit_shell.serves(1.));
}


TEST(ShellMotion, IsAsAccurateAsWanted)
{
  Scene               scene({5., 0.2}, 1., {}, tight(1e-8, 1e-8));
  const ControlPoints f = scene.coupling.mass() * smooth_field(scene.state.x);
  scene.coupling.move(scene.state.x);
  VelocityGradients gradients(scene.coupling.n_local_points(), 9);
  for (Eigen::Index q = 0; q < gradients.rows(); ++q)
    gradients.row(q) << 0.5, 0.3, 1., std::sin(0.1 * q), -0.5, 0.4, 0.2, std::cos(0.1 * q), 0.;
  SparseMatrix gamma;
  scene.coupling.gradient_matrix(gradients, gamma);
  const ShellMotion exact(scene.coupling, 0.1 * gamma, 0.);
  EXPECT_EQ(exact.n_terms(), 0u);
  const ControlPoints dx = exact.solve(f);
  EXPECT_LT((exact.times(dx) - f).norm(), 1e-12 * f.norm());

  unsigned int n_terms = 1;
  for (const double accuracy : {1e-2, 1e-4, 1e-6})
    {
      const ShellMotion motion(scene.coupling, 0.1 * gamma, accuracy);
      EXPECT_GT(motion.n_terms(), n_terms);
      n_terms            = motion.n_terms();
      const double error = (motion.solve(f) - dx).norm() / dx.norm();
      if (is_root())
        std::cout << "accuracy " << accuracy << ": " << n_terms << " terms, error on a smooth field " << error << std::endl;
      EXPECT_LT(error, accuracy);
      EXPECT_LT((motion.solve(2. * f + scene.state.x) - 2. * motion.solve(f) - motion.solve(scene.state.x)).norm(), 1e-13 * dx.norm());
    }
  EXPECT_EQ(ShellMotion(scene.coupling, 5. * gamma, 1e-2).n_terms(), 0u); // the series diverges
}


TEST(ConstantPressureJump, DrivesNoFlow)
{
  // Nodal forces p0 dV/dx are those of a constant pressure jump; the indicator pressure alone can balance them.
  Scene        scene({20., 0.}, 0., ellipsoid(2., 1.5, 1.), tight(1e-9, 1e-9), 5., 0.15625);
  const double p0   = 3.7;
  scene.state.force = p0 * volume_gradient(scene.surface, scene.state.x);
  scene.coupling.move(scene.state.x);
  ImplicitShell         implicit_shell(MPI_COMM_WORLD);
  const LinearisedShell shell(scene.shell,
                              scene.surface,
                              scene.coupling,
                              scene.state,
                              ControlPoints::Zero(scene.state.x.rows(), 3),
                              VelocityGradients::Zero(scene.coupling.n_local_points(), 9),
                              Linearisation{0., 1., 0., PointDerivatives::frozen},
                              implicit_shell);
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


namespace
{
  /** What one Newton step with exact linear solves leaves of the residual, as part of it, from points displaced by 4e-3 and 1e-3. */
  std::vector<double>
  reductions(const double reynolds_number)
  {
    Scene               scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-8, 1e-8), 5., 0.3125, reynolds_number > 0.);
    const ControlPoints x0 = scene.state.x;
    scene.solver.solve_flow(scene.state);
    FluidVector uhat = scene.state.fluid.block(velocity_block);
    uhat *= 0.7;
    NewtonSolver solver(scene.parameters, scene.shell, scene.surface, scene.coupling, scene.volume, {1.}, scene.timings, 1., reynolds_number);
    solver.attach(scene.fluid);
    EXPECT_TRUE(solver.solve(scene.state, x0, 0.05, &uhat).converged);

    SolverParameters one      = scene.parameters;
    one.max_newton_iterations = 1;
    NewtonSolver single(one, scene.shell, scene.surface, scene.coupling, scene.volume, {1.}, scene.timings, 1., reynolds_number);
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
        const NewtonReport report = single.solve(perturbed, x0, 0.05, &uhat);
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


TEST(Newton, FindsTheSameWithAnOldImplicitOperator)
{
  Scene scene({5., 0.2}, 1., ellipsoid(1.3, 1.1, 1.), tight(1e-7, 1e-3));
  scene.solver.solve_flow(scene.state);
  const State         start = scene.state;
  const ControlPoints x_n   = start.x;
  State               fresh = start, other = start;
  NewtonSolver        solver(scene.parameters, scene.shell, scene.surface, scene.coupling, scene.volume, {1.}, scene.timings);
  solver.attach(scene.fluid);
  const NewtonReport of_fresh = scene.solver.solve(fresh, x_n, 0.1);
  print("new operator", of_fresh);
  ASSERT_TRUE(of_fresh.converged);

  // An operator made for another shape and a shorter step.
  other.x *= Eigen::DiagonalMatrix<double, 3>(1.15, 0.9, 0.95);
  other.force               = scene.shell.force(other.x);
  const ControlPoints x_old = other.x;
  ASSERT_EQ(solver.implicit_shell().n_renewals(), 0u);
  solver.solve(other, x_old, 0.07);
  const unsigned int renewals = solver.implicit_shell().n_renewals();
  ASSERT_TRUE(solver.implicit_shell().serves(0.1));
  State              old    = start;
  const NewtonReport of_old = solver.solve(old, x_n, 0.1);
  print("old operator", of_old);
  ASSERT_TRUE(of_old.converged);
  EXPECT_LT(solver.implicit_shell().n_renewals() - renewals, of_old.newton_iterations);
  // Residuals are velocities: errors of x are about tau times the tolerance.
  const double difference = (old.x - fresh.x).norm() / std::sqrt(x_n.rows());
  if (is_root())
    std::cout << "difference of the control points " << difference << std::endl;
  EXPECT_LT(difference, 0.1 * 1e-7);
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


/** Four steps of the relaxing ellipsoid, neo-Hookean membrane and Helfrich bending (kappa_B = 1) about a flat reference: each lowers the energy. */
void
expect_falling_energy(const double dt, const Interface interface)
{
  Scene scene({10., 1.}, 0., ellipsoid(1.4, 1.2, 1.), tight(1e-6, 1e-3, interface));
  scene.solver.solve_flow(scene.state);
  const auto energy = [&]() {
    const Shell::Energy e = scene.serial_shell.energy(scene.state.x);
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
