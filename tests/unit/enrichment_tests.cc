// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the enriched interface, and its order on exact Stokes flows.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <oracle/enriched_power.h>

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


  /** Cells of 10a/cells at the shell, control mesh as fine. */
  struct Example : oracle::GivenForces
  {
    Example(const CapsuleShapeParameters &capsule,
            const unsigned int            cells,
            const Interface               interface,
            const double                  side     = 40.,
            const Eigen::RowVector3d     &centre   = {0.013, 0.031, -0.022},
            const ViscosityContrast      &contrast = {})
      : GivenForces(make_capsule(capsule, std::lround(std::log2(cells / 8.))), interface, side, {10. / cells, 2.5, 1.5}, {centre}, contrast)
    {}

    /** Velocity of the only shell. */
    ControlPoints
    velocity(const ControlPoints &F, const double tolerance, const unsigned int n_sweeps = 0)
    {
      return flow({F}, tolerance, n_sweeps).velocity[0];
    }
  };


  CapsuleShapeParameters
  ellipsoid()
  {
    CapsuleShapeParameters result;
    result.shape = Shape::ellipsoid;
    result.axes  = {{1.5, 1.2, 1.}};
    return result;
  }


  /**
   * The same velocity with another viscosity inside. There the flow is that of the potential r^l Y, without pressure; outside r^{-l} times a combination of
   * grad Y and Y r is added to that of r^{-l-1} Y.
   */
  void
  set_exact_traction(const Example &scene, const int l, ControlPoints &traction)
  {
    const double lambda = scene.viscosity_ratio();
    const double B = l * (2. * l - 1.) * (2. * l + 1.) / (l + 1.), A = l * (2. * l - 1.) / (2. * (l + 1.)); // of the pressure's part and the potential's
    const double normal     = 2. * lambda * l * (l - 1.) + B - 2. * A * (l + 1.) * (l + 2.) + B * l * (l + 1.) / (2. * l - 1.);
    const double tangential = 2. * lambda * (l - 1.) + A * (l + 2.) + B * (2. - l) / (2. * (2. * l - 1.)) + 1. - l;
    const double size       = (2. * l + 1.) * (2. * l - 1.) / (l + 1.); // both with one viscosity, the former l times the latter
    for (Eigen::Index q = 0; q < scene.X().rows(); ++q)
      {
        const Eigen::RowVector3d r = (scene.X().row(q) - scene.centre()).normalized(), n = traction.row(q).dot(r) * r, t = traction.row(q) - n;
        traction.row(q) = normal / (l * size) * n + tangential / size * t;
      }
  }


  /** Relative error of the surface velocity for the traction of degree l. */
  double
  error(const unsigned int cells, const int l, const Interface interface, const double ratio = 1., const unsigned int n_sweeps = 0)
  {
    Example scene({}, cells, interface, 40., {0.013, 0.031, -0.022}, {ratio, {}});
    auto [traction, exact] = oracle::exact_on_sphere(scene.X(), scene.centre(), l);
    set_exact_traction(scene, l, traction);
    const double result = scene.difference_at_points(scene.coupling_surface.S() * scene.velocity(scene.nodal_forces(traction), 1e-8, n_sweeps), exact);
    if (is_root())
      std::cout << "l = " << l << ", ratio " << ratio << ", " << n_sweeps << " sweeps, h = 10a/" << cells
                << (interface == Interface::plain ? ", plain: " : ", enriched: ") << result << std::endl;
    return result;
  }
} // namespace


namespace
{
  /** R = J^T on velocities and pressures that are not smooth at all, and Q = Q^T. */
  void
  expect_adjoint_and_symmetric(const Example &scene)
  {
    const ControlPoints &x = scene.state.capsules[0].x;
    const ControlPoints  f = scene.scene.capsule().mass() * oracle::waves(x, 2.), g = scene.scene.capsule().mass() * oracle::waves(x, 3.);
    FluidBlockVector     load, fields;
    scene.fluid.space().reinit(load);
    scene.fluid.space().reinit(fields);
    scene.coupling.spread({f}, load);
    for (unsigned int b = 0; b < 2; ++b)
      for (unsigned int i = 0; i < fields.block(b).locally_owned_size(); ++i)
        fields.block(b).local_element(i) = std::sin(0.37 * i + b);
    const double of_shell = f.cwiseProduct(scene.coupling.interpolate(fields)[0]).sum(), of_fluid = load * fields;
    EXPECT_NEAR(of_shell, of_fluid, 1e-10 * std::abs(of_fluid));
    fields             = 0.;
    const auto   moved = [&](const ControlPoints &force) { return scene.coupling.interpolate(fields, ShellFields{force})[0]; };
    const double f_Q_g = f.cwiseProduct(moved(g)).sum(), g_Q_f = g.cwiseProduct(moved(f)).sum(), f_Q_f = f.cwiseProduct(moved(f)).sum();
    EXPECT_NEAR(f_Q_g, g_Q_f, 1e-12 * std::abs(f_Q_f));
    EXPECT_GT(std::abs(f_Q_f), 1e-6);
  }
} // namespace


TEST(Enrichment, PowerOfTheShellIsPowerReceivedByTheFluid)
{
  expect_adjoint_and_symmetric(Example(ellipsoid(), 32, Interface::enriched, 10.));
}


TEST(Enrichment, PowerOfTheShellIsThatOfTheFlow)
{
  CapsuleShapeParameters disk;
  disk.shape       = Shape::biconcave;
  disk.inclination = 0.2;
  for (const auto &capsule : {CapsuleShapeParameters(), ellipsoid(), disk})
    {
      double before = 0.;
      for (const unsigned int cells : {32, 64})
        {
          Example             scene(capsule, cells, Interface::enriched, 10.);
          const ControlPoints F        = scene.nodal_forces(oracle::waves(scene.X(), 1.5));
          const Example::Flow solution = scene.flow({F}, 1e-12);
          const oracle::Power flow     = oracle::EnrichedPower(scene, {F}, solution).power();
          // Twice the stationary value of the flow; the dissipation alone is as much up to an error of higher order.
          const double of_shell = F.cwiseProduct(solution.velocity[0]).sum(), of_flow = 2. * flow.force + 2. * flow.pressure - flow.dissipation,
                       gap = flow.dissipation / of_shell - 1.;
          if (is_root())
            std::cout << "h = 10a/" << cells << ": power " << of_shell << ", that of the flow differs by " << of_flow / of_shell - 1. << ", its dissipation by "
                      << gap << std::endl;
          EXPECT_NEAR(of_shell, of_flow, 2e-9 * of_shell); // the cut cells' matrices are kept in single precision: 5e-10
          EXPECT_LT(std::abs(gap), cells == 32 ? 3e-3 : 0.3 * std::abs(before));
          before = gap;
        }
    }
}


TEST(Enrichment, ConstantPressureJumpDrivesNoFlow)
{
  Example    scene(ellipsoid(), 32, Interface::enriched, 10.);
  const auto flow = scene.flow({3.7 * scene.v()}, 1e-10);
  EXPECT_LT(flow.velocity[0].cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_NEAR(flow.pressure_jumps[0], -3.7, 1e-6);
}


TEST(Enrichment, IsTheSameAcrossThePeriodicFaces)
{
  // Moved by half the box in x and y the capsule is cut into four; the flow has to be the same.
  Example             scene({}, 32, Interface::enriched, 10., {0.013, 0.031, -0.022}), moved({}, 32, Interface::enriched, 10., {5.013, 5.031, -0.022});
  const ControlPoints traction = oracle::exact_on_sphere(scene.X(), scene.centre(), 2).first;
  const ControlPoints U = scene.velocity(scene.nodal_forces(traction), 1e-10), V = moved.velocity(moved.nodal_forces(traction), 1e-10);
  // Not to rounding: by the error of its quadrature the volume gradient depends on the origin (as much when the move is a whole period).
  EXPECT_LT((U - V).norm(), 2e-5 * U.norm());
}


TEST(Enrichment, IsOfSecondOrder)
{
  for (const int l : {2, 4})
    {
      const double coarse = error(32, l, Interface::enriched), fine = error(64, l, Interface::enriched), plain = error(64, l, Interface::plain);
      EXPECT_LT(fine, l == 2 ? 0.003 : 0.008);
      EXPECT_LT(fine, coarse / std::pow(2., 1.6));
      EXPECT_LT(fine, plain / 10.);
    }
}


TEST(ShellViscosity, HasTheVolumeOfTheCapsule)
{
  for (const double ratio : {5., 0.2})
    for (const Eigen::RowVector3d &centre :
         {Eigen::RowVector3d(0.013, 0.031, -0.022), Eigen::RowVector3d(5.013, 15.031, -0.022)}) // the latter across both pairs of periodic faces
      {
        Example      scene(ellipsoid(), 32, Interface::plain, 10., centre, {ratio, {}});
        const auto  &mu     = *scene.fluid.viscosity();
        const auto  &h      = scene.fluid.space().velocity->cell_sizes();
        double       excess = 0.;
        unsigned int n_cut  = mu.cut().cells.size();
        for (unsigned int cell = 0; cell < h.size(); ++cell)
          {
            excess += std::pow(h[cell], 3) * (mu.means()[cell] - 1.);
            EXPECT_GT(mu.means()[cell], mu.least() - 1e-12);
            EXPECT_LT(mu.means()[cell], std::max(1., ratio) + 1e-12);
          }
        const double volume = scene.shells[0]->volume();
        EXPECT_NEAR(dealii::Utilities::MPI::sum(excess, MPI_COMM_WORLD), (ratio - 1.) * volume, 2e-4 * std::abs(ratio - 1.) * volume);
        EXPECT_GT(dealii::Utilities::MPI::sum(n_cut, MPI_COMM_WORLD), 100u);
      }
}


TEST(ViscosityContrast, OperatorsAreAdjointAndSymmetric)
{
  for (const double ratio : {5., 0.2})
    expect_adjoint_and_symmetric(Example(ellipsoid(), 32, Interface::enriched, 10., {0.013, 0.031, -0.022}, {ratio, {}}));
}


TEST(Enrichment, IsNeverWorseThanPlain)
{
  CapsuleShapeParameters long_one = ellipsoid(), disk;
  long_one.axes                   = {{2., 1., 1.}};
  long_one.inclination            = 0.15;
  disk.shape                      = Shape::biconcave;
  disk.inclination                = 0.2;
  for (const auto &capsule : {CapsuleShapeParameters(), long_one, disk})
    {
      const FittedShape shape = make_capsule(capsule, 2); // the same for all meshes of the fluid
      const auto        error = [&](const unsigned int cells, const Interface interface, ControlPoints &velocity, const ControlPoints &wanted) {
        oracle::GivenForces scene(shape, interface, 10., {10. / cells, 2.5, 1.5}, {{0.013, 0.031, -0.022}});
        velocity = scene.flow({scene.nodal_forces(oracle::waves(scene.X(), 1.5))}, 1e-8).velocity[0];
        return wanted.rows() > 0 ? scene.difference(velocity, wanted) : 0.;
      };
      ControlPoints fine, velocity;
      error(64, Interface::enriched, fine, {});
      const double enriched = error(32, Interface::enriched, velocity, fine), plain = error(32, Interface::plain, velocity, fine),
                   finer_plain = error(64, Interface::plain, velocity, fine);
      if (is_root())
        std::cout << "enriched " << enriched << ", plain " << plain << " and with half the cells " << finer_plain << std::endl;
      EXPECT_LT(enriched, 0.5 * plain);
      EXPECT_LT(finer_plain, 0.6 * plain); // to the same limit
    }
}


TEST(ViscosityContrast, EnrichedInterfaceIsOfSecondOrder)
{
  const double coarse = error(32, 2, Interface::enriched, 5., 2), fine = error(64, 2, Interface::enriched, 5., 2), plain = error(32, 2, Interface::plain, 5.);
  EXPECT_LT(fine, 0.0016);
  EXPECT_LT(fine, coarse / std::pow(2., 1.6));
  EXPECT_LT(coarse, plain / 8.);
  EXPECT_LT(error(32, 2, Interface::enriched, 0.2, 2), 0.009);
  EXPECT_LT(error(32, 2, Interface::enriched, 20., 3), 0.007);
}


TEST(ViscosityContrast, StressOfTheUndisturbedFlowIsInBalance)
{
  // Forces that make up for the jump of the undisturbed flow's viscous stress leave that flow as it is.
  const ViscosityContrast contrast{5., simple_shear()};
  Eigen::Matrix3d         gradient = Eigen::Matrix3d::Zero();
  gradient(0, 2)                   = 1.;
  for (const Interface interface : {Interface::plain, Interface::enriched})
    {
      std::vector<double> disturbance;
      for (const unsigned int cells : {32, 64})
        {
          Example       scene({}, cells, interface, 40., {0.013, 0.031, -0.022}, contrast);
          ControlPoints traction(scene.X().rows(), 3);
          for (Eigen::Index q = 0; q < scene.X().rows(); ++q)
            {
              const Eigen::RowVector3d r = (scene.X().row(q) - scene.centre()).normalized();
              traction.row(q)            = 4. * r * (gradient + gradient.transpose());
            }
          const ControlPoints U = scene.coupling_surface.S() * scene.velocity(scene.nodal_forces(traction), 1e-8, 2);
          disturbance.push_back(std::sqrt(U.rowwise().squaredNorm().dot(scene.weights()) / scene.weights().sum()));
          if (is_root())
            std::cout << (interface == Interface::plain ? "plain" : "enriched") << ", h = 10a/" << cells << ": root mean square disturbance "
                      << disturbance.back() << std::endl;
        }
      EXPECT_LT(disturbance[0], 6e-4);
      EXPECT_LT(disturbance[1], 3e-4);
    }
}


TEST(ViscosityContrast, SphereWithoutForcesIsStrainedEvenly)
{
  // A sphere of liquid without forces at its surface, in simple shear: the strain rate inside is 5/(2 lambda + 3) times that of the flow, and the sphere turns with it.
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  strain(0, 2) = strain(2, 0) = 0.5;
  for (const double ratio : {0.2, 5., 20.})
    {
      std::vector<double> error; // of the normal velocity, in the pattern of the strain rate
      for (const unsigned int cells : {32, 64})
        {
          oracle::GivenForces scene(make_capsule({}, 3),
                                    Interface::enriched,
                                    10.,
                                    {10. / cells, 2.5, 1.5},
                                    {Eigen::RowVector3d(0.013, 0.031, -0.022)},
                                    {ratio, simple_shear()},
                                    true);
          const ControlPoints none    = ControlPoints::Zero(scene.shells[0]->x().rows(), 3);
          const ControlPoints U       = scene.coupling_surface.S() * scene.flow({none}, 1e-8, ratio == 20. ? 12 : 4).velocity[0];
          double              product = 0., square = 0.;
          for (Eigen::Index q = 0; q < U.rows(); ++q)
            {
              const Eigen::RowVector3d n        = (scene.X().row(q) - scene.centre()).normalized();
              const double             strained = n * strain * n.transpose();
              product += scene.weights()[q] * U.row(q).dot(n) * strained;
              square += scene.weights()[q] * strained * strained;
            }
          const double factor = 5. / (2. * ratio + 3.);
          error.push_back(std::abs(product / square - (factor - 1.)) / factor);
          if (is_root())
            std::cout << "ratio " << ratio << ", h = 10a/" << cells << ": error of the strain rate " << error.back() << std::endl;
        }
      EXPECT_LT(error[0], ratio == 20. ? 0.006 : ratio == 5. ? 0.0014 : 0.0003);
      EXPECT_LT(error[1], ratio == 20. ? 0.002 : ratio == 5. ? 0.0006 : 0.0003);
    }
}


TEST(ViscosityContrast, IterationsOverTheRatio)
{
  for (const unsigned int cells : {32, 64})
    for (const auto &[ratio, allowed] :
         std::vector<std::pair<double, unsigned int>>{{0.01, 150}, {0.1, 58}, {0.2, 46}, {1., 20}, {5., 40}, {20., 66}, {100., 125}})
      {
        Example scene({}, cells, Interface::enriched, 10., {0.013, 0.031, -0.022}, {ratio, {}});
        auto [traction, exact] = oracle::exact_on_sphere(scene.X(), scene.centre(), 2);
        set_exact_traction(scene, 2, traction);
        const unsigned int iterations = scene.flow({scene.nodal_forces(traction)}, 1e-6).iterations;
        if (is_root())
          std::cout << "h = 10a/" << cells << ", ratio " << ratio << ": " << iterations << " iterations" << std::endl;
        EXPECT_LE(iterations, allowed);
      }
}
