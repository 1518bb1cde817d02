// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: linear solves of Newton's method need few iterations, however stiff the shell and however long the time step.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>

#include <cmath>
#include <iostream>

using namespace tanktread;

namespace
{
  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** Shell of 162 control points and cells of 10a/32, both twice as fine a level higher; box 10 a, shear. */
  struct Scene
  {
    Scene(const ShellParameters &law, const ShellModuli &moduli, const Shape capsule_shape, const unsigned int level = 2)
      : shape(capsule(capsule_shape, level))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::second)
      , serial_shell(surface, law, moduli, shape.control_points)
      , shell(serial_shell, shape.topology, MPI_COMM_WORLD)
      , coupling(surface, serial_shell.reference_weights())
      , volume(enclosed_volume(surface, shape.control_points))
      , fluid(MPI_COMM_WORLD, 10., {10. / (8 << level), 2.5, 1.5})
      , solver(parameters, shell, surface, coupling, volume, flow, timings)
    {
      state.x = shape.control_points;
    }

    static FittedShape
    capsule(const Shape shape, const unsigned int level)
    {
      CapsuleShapeParameters parameters;
      parameters.shape = shape;
      return make_capsule(parameters, level);
    }

    /** New mesh around the shell, if that is another one. */
    void
    refine()
    {
      if (fluid.adapt(coupling.points(state.x)))
        {
          solver.attach(fluid);
          fluid.space().reinit(state.fluid);
        }
      coupling.move(state.x);
    }

    /** `n` steps of backward Euler. */
    void
    advance(const double dt, const unsigned int n)
    {
      refine();
      solver.solve_flow(state);
      for (unsigned int i = 0; i < n; ++i)
        {
          if (!fluid.mesh().covers(coupling.points(state.x)))
            {
              refine();
              solver.solve_flow(state);
            }
          const ControlPoints x_n    = state.x;
          const NewtonReport  report = solver.solve(state, x_n, dt);
          if (!report.converged)
            throw NumericalError(report.message);
        }
      refine();
      solver.solve_flow(state);
    }

    SolverParameters   parameters;
    const ShearFlow    flow{1.};
    FittedShape        shape;
    SubdivisionSurface surface;
    Shell              serial_shell;
    DistributedShell   shell;
    Coupling           coupling;
    double             volume;
    Fluid              fluid;
    Timings            timings;
    NewtonSolver       solver;
    State              state;
  };

  /** Right-hand side with all blocks. */
  FluidBlockVector
  loads(const Scene &scene, const LinearisedShell &shell, const ControlPoints &force)
  {
    FluidBlockVector result = monolithic_vector(scene.fluid.space(), force.rows()), flow(result), product(result);
    scene.coupling.spread(force, result);
    scene.fluid.preconditioner().vmult(flow, result);
    scene.fluid.stokes().vmult(product, flow);
    result.block(pressure_block) = product.block(pressure_block);
    set_shell_unknowns(result, {1., shell.damped(force)});
    return result;
  }

  /**
   * Iterations of a linear solve to 1e-6 at the state of the scene with points frozen, as the solver does it far from a solution; the forces are those of the shell `serial`.
   */
  unsigned int
  iterations(const Scene &scene, const Shell &serial, const Tangent tangent, const double tau)
  {
    const DistributedShell shell(serial, scene.shape.topology, MPI_COMM_WORLD);
    ImplicitShell          implicit(MPI_COMM_WORLD);
    const double           h         = scene.fluid.mesh().cell_size(scene.fluid.mesh().finest_level());
    VelocityGradients      gradients = VelocityGradients::Zero(scene.coupling.n_local_points(), 9);
    gradients.col(2).array()         = scene.flow.shear_rate;
    State state                      = scene.state;
    state.force                      = serial.force(state.x);
    const LinearisedShell          linear(shell,
                                 scene.surface,
                                 scene.coupling,
                                 state,
                                 scene.solver.shell_velocity(state),
                                 gradients,
                                 Linearisation{tau, h, 1e-8, PointDerivatives::frozen, tangent, scene.flow.gradient()},
                                 implicit);
    const MonolithicOperator       matrix(scene.fluid.stokes(), linear);
    const MonolithicPreconditioner preconditioner(scene.fluid.preconditioner(), linear, scene.volume);
    const ControlPoints            other    = state.x * Eigen::Vector3d(1.1, 0.95, 0.96).asDiagonal();
    const FluidBlockVector         rhs      = loads(scene, linear, serial.force(other));
    FluidBlockVector               solution = monolithic_vector(scene.fluid.space(), other.rows());
    const LinearReport             report   = solve_fgmres(matrix, preconditioner, solution, rhs, 1e-6, 200);
    EXPECT_TRUE(report.converged);
    return report.iterations;
  }

  struct Stiffness
  {
    double stretching, bending; // tau E_s/(mu a) and tau kappa_B/(mu a^3)
  };
  constexpr Stiffness stiffnesses[] = {{1., 0.}, {10., 0.}, {0., 0.1}, {0., 10.}, {10., 1.}, {10., 10.}};

  /** Measures, tells and judges. */
  void
  expect_few(const std::string     &name,
             const Scene           &scene,
             const ShellParameters &law,
             const Tangent          tangent,
             const Stiffness       &stiffness,
             const double           tau,
             const unsigned int     allowed = 40)
  {
    const Shell        shell(scene.surface, law, {stiffness.stretching / tau, stiffness.bending / tau}, scene.shape.control_points);
    const unsigned int n = iterations(scene, shell, tangent, tau);
    if (is_root())
      std::cout << name << ", tau = " << tau << ", (" << stiffness.stretching << ", " << stiffness.bending << "): " << n << " iterations" << std::endl;
    EXPECT_LE(n, allowed);
  }

  ShellParameters
  skalak(const ReferenceCurvature reference)
  {
    ShellParameters law;
    law.law             = MembraneLaw::skalak;
    law.area_dilatation = 10.;
    law.reference       = reference;
    return law;
  }
} // namespace


TEST(Iterations, Sphere)
{
  Scene scene({}, {5., 0.2}, Shape::sphere);
  scene.refine();
  for (const Stiffness &stiffness : stiffnesses)
    expect_few("sphere", scene, {}, Tangent::exact, stiffness, 0.1);
}


TEST(Iterations, SphereOnAFinerMesh)
{
  Scene scene({}, {5., 0.2}, Shape::sphere, 3);
  scene.refine();
  for (const Stiffness &stiffness : {Stiffness{10., 0.}, {10., 10.}})
    expect_few("sphere", scene, {}, Tangent::exact, stiffness, 0.1);
}


TEST(Iterations, LargeVolumeShift)
{
  // sigma H_V with all that the mesh resolves would make the first row of LinearisedShell indefinite from sigma = h/pi = 0.1 a on.
  Scene scene({}, {5., 0.2}, Shape::sphere);
  scene.refine();
  for (const double sigma : {0.049, 0.1, 0.2, -0.2})
    {
      scene.state.volume_shift = sigma;
      expect_few("sphere, sigma = " + std::to_string(sigma), scene, {}, Tangent::exact, {5., 0.2}, 1.);
    }
}


TEST(Iterations, CompressedEllipsoid)
{
  // Without the positive tangent dozens of eigenvalues of tau K against Z are below -1, and the solver gets nowhere.
  Scene           scene({}, {5., 0.2}, Shape::sphere);
  const double    c = std::cos(dealii::numbers::PI / 6.), s = std::sin(dealii::numbers::PI / 6.);
  Eigen::Matrix3d turn; // from +x towards +z
  turn << c, 0., s, 0., 1., 0., -s, 0., c;
  scene.state.x = scene.shape.control_points * Eigen::Vector3d(1.3, 0.9, 1. / 1.17).asDiagonal() * turn;
  scene.refine();
  for (const Stiffness &stiffness : stiffnesses)
    expect_few("ellipsoid", scene, {}, Tangent::positive, stiffness, 0.1);
}


TEST(Iterations, SteadyCapsule)
{
  // True tensions and pressure; steps of up to 4 shear times.
  Scene scene({}, {5., 0.2}, Shape::sphere);
  scene.advance(0.25, 20);
  for (const double tau : {0.2, 1., 2., 4.})
    expect_few("steady", scene, {}, Tangent::exact, {5. * tau, 0.2 * tau}, tau);
}


TEST(Iterations, BiconcaveDisk)
{
  // The two sides of the disk are 0.2 a apart in the middle, of which Z knows nothing: measured up to 44. (A sphere or an oblate spheroid of the same material: 37.)
  Scene scene(skalak(ReferenceCurvature::flat), {5., 0.2}, Shape::biconcave);
  scene.refine();
  for (const Stiffness &stiffness : stiffnesses)
    {
      expect_few("disk, flat reference", scene, skalak(ReferenceCurvature::flat), Tangent::positive, stiffness, 0.1, 45);
      expect_few("disk, initial reference", scene, skalak(ReferenceCurvature::initial), Tangent::exact, stiffness, 0.1, 45);
    }
}


TEST(Iterations, WrinklingMembrane)
{
  Scene scene({}, {20., 0.}, Shape::sphere);
  scene.advance(0.1, 5);
  for (const double tau : {0.05, 0.5})
    expect_few("compressed membrane", scene, {}, Tangent::exact, {20. * tau, 0.}, tau);
}
