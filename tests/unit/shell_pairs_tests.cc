// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about several shells in one fluid, some of them in the same cells.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <oracle/enriched_power.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

using namespace tanktread;

namespace
{
  constexpr double finest_cell = 10. / 32.;

  using Centres = std::vector<Eigen::RowVector3d>;

  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }


  /** Two spheres of radius 1 with that gap between them, off the lattice. */
  Centres
  pair(const double gap)
  {
    const Eigen::RowVector3d first(-1.013, 0.031, -0.122), direction = Eigen::RowVector3d(1., 0.17, 0.29).normalized();
    return {first, first + (2. + gap) * direction};
  }


  /** Three, each as near to the other two. */
  Centres
  triangle(const double gap)
  {
    Centres                  result = pair(gap);
    const Eigen::RowVector3d along = result[1] - result[0], across = along.cross(Eigen::RowVector3d(0.1, 1., 0.3)).normalized();
    result.push_back(result[0] + 0.5 * along + std::sqrt(0.75) * along.norm() * across);
    return result;
  }


  /** Spheres at rest in a box of 10a. */
  struct Spheres : oracle::GivenForces
  {
    explicit Spheres(const Centres &centres, const Interface interface = Interface::enriched, const double viscosity_ratio = 1., const double h = finest_cell)
      : GivenForces(make_capsule({}, 2), interface, 10., {h, 2.5, 1.5}, centres, {viscosity_ratio, {}})
    {}

    /** Smooth forces of wave number k, others on each shell. */
    ShellFields
    waves(const double k) const
    {
      ShellFields result;
      for (unsigned int c = 0; c < shells.size(); ++c)
        result.push_back(nodal_forces(oracle::waves(X(c), k + 0.3 * c), c));
      return result;
    }

    /** The same but for the shells other than c, which have none. */
    ShellFields
    waves_on(const unsigned int c, const double k) const
    {
      ShellFields result = waves(k);
      for (unsigned int other = 0; other < shells.size(); ++other)
        if (other != c)
          result[other].setZero();
      return result;
    }

    /** Velocity and pressure that are not smooth at all. */
    FluidBlockVector
    rough_flow() const
    {
      FluidBlockVector result;
      fluid.space().reinit(result);
      for (unsigned int b = 0; b < 2; ++b)
        for (unsigned int i = 0; i < result.block(b).locally_owned_size(); ++i)
          result.block(b).local_element(i) = std::sin(0.37 * i + b);
      return result;
    }

    /** Q f */
    ShellFields
    moved_by_themselves(const ShellFields &f) const
    {
      FluidBlockVector zero;
      fluid.space().reinit(zero);
      return coupling.interpolate(zero, f);
    }

    unsigned int
    n_shared_cells() const
    {
      return dealii::Utilities::MPI::sum(coupling.jumps().pairs().n_cells(), MPI_COMM_WORLD);
    }
  };


  double
  dot(const ShellFields &f, const ShellFields &g)
  {
    double result = 0.;
    for (std::size_t c = 0; c < f.size(); ++c)
      result += f[c].cwiseProduct(g[c]).sum();
    return result;
  }


  double
  difference(const ShellFields &f, const ShellFields &g)
  {
    double result = 0.;
    for (std::size_t c = 0; c < f.size(); ++c)
      result += (f[c] - g[c]).squaredNorm();
    return std::sqrt(result / dot(g, g));
  }


  ShellFields
  reversed(ShellFields f)
  {
    std::reverse(f.begin(), f.end());
    return f;
  }
} // namespace


TEST(ShellPairs, PowerOfTheShellsIsPowerReceivedByTheFluid)
{
  for (const Centres &centres : {pair(0.3 * finest_cell), triangle(0.3 * finest_cell)})
    for (const auto &[interface, viscosity_ratio] : {std::pair(Interface::plain, 1.), std::pair(Interface::enriched, 1.), std::pair(Interface::enriched, 5.)})
      {
        const Spheres     scene(centres, interface, viscosity_ratio);
        const ShellFields f = scene.waves(2.);
        FluidBlockVector  load, fields = scene.rough_flow();
        scene.fluid.space().reinit(load);
        scene.coupling.spread(f, load);
        const ShellFields velocity = scene.coupling.interpolate(fields);
        EXPECT_GT(std::abs(dot(f, velocity)), 1e-3);
        EXPECT_NEAR(dot(f, velocity), load * fields, 1e-12 * std::sqrt(dot(f, f) * dot(velocity, velocity)));
        // Of each shell by itself too.
        for (unsigned int c = 0; c < centres.size(); ++c)
          {
            load = 0.;
            scene.coupling.spread(scene.waves_on(c, 2.), load);
            EXPECT_NEAR(f[c].cwiseProduct(velocity[c]).sum(), load * fields, 1e-12 * f[c].norm() * velocity[c].norm());
          }
      }
}


TEST(ShellPairs, OwnVelocityIsSymmetric)
{
  for (const auto &[centres, viscosity_ratio] :
       {std::pair(pair(0.3 * finest_cell), 1.), std::pair(triangle(0.3 * finest_cell), 1.), std::pair(triangle(0.3 * finest_cell), 0.2)})
    {
      const Spheres     scene(centres, Interface::enriched, viscosity_ratio);
      const ShellFields f = scene.waves(2.), g = scene.waves(3.);
      EXPECT_GT(scene.n_shared_cells(), 0u);
      EXPECT_NEAR(dot(f, scene.moved_by_themselves(g)), dot(g, scene.moved_by_themselves(f)), 1e-12 * std::abs(dot(f, scene.moved_by_themselves(f))));
      for (unsigned int c = 0; c < centres.size(); ++c)
        for (unsigned int d = 0; d < c; ++d)
          {
            const ShellFields f_c = scene.waves_on(c, 2.), f_d = scene.waves_on(d, 3.), Q_f_c = scene.moved_by_themselves(f_c),
                              Q_f_d = scene.moved_by_themselves(f_d);
            const double cross      = dot(f_d, Q_f_c);
            EXPECT_NEAR(cross, dot(f_c, Q_f_d), 1e-12 * std::abs(dot(f_c, Q_f_c)));
            EXPECT_GT(std::abs(cross), 1e-4 * std::abs(dot(f_c, Q_f_c)));
          }
    }
}


TEST(ShellPairs, NumbersOfTheCapsulesDoNotMatter)
{
  const Centres centres = triangle(0.3 * finest_cell), others = {centres[2], centres[1], centres[0]};
  for (const Interface interface : {Interface::plain, Interface::enriched})
    {
      Spheres           scene(centres, interface), renumbered(others, interface);
      const ShellFields f = scene.waves(2.), g = reversed(f);
      FluidBlockVector  load, load_of_others, fields = scene.rough_flow();
      scene.fluid.space().reinit(load);
      scene.fluid.space().reinit(load_of_others); // the same mesh
      scene.coupling.spread(f, load);
      renumbered.coupling.spread(g, load_of_others);
      load_of_others -= load;
      EXPECT_LT(load_of_others.l2_norm(), 1e-12 * load.l2_norm());
      EXPECT_LT(difference(reversed(renumbered.coupling.interpolate(fields, g)), scene.coupling.interpolate(fields, f)), 1e-12);
      if (interface == Interface::enriched)
        {
          EXPECT_LT(difference(reversed(renumbered.moved_by_themselves(g)), scene.moved_by_themselves(f)), 1e-12);
        }
      EXPECT_LT(difference(reversed(renumbered.flow(g, 1e-10).velocity), scene.flow(f, 1e-10).velocity), 1e-8);
    }
}


TEST(ShellPairs, ShellsFarFromEachOtherMoveThemselvesAsAlone)
{
  for (const double viscosity_ratio : {1., 5.})
    {
      const auto change = [&](const double gap) {
        const Centres     centres = pair(gap);
        const Spheres     both(centres, Interface::enriched, viscosity_ratio);
        const ShellFields together = both.moved_by_themselves(both.waves(2.));
        EXPECT_EQ(both.n_shared_cells() > 0, gap < finest_cell);
        double result = 0.;
        for (unsigned int c = 0; c < 2; ++c)
          {
            const Spheres alone({centres[c]}, Interface::enriched, viscosity_ratio);
            result = std::max(result, difference({together[c]}, alone.moved_by_themselves({both.waves(2.)[c]})));
          }
        return result;
      };
      const double near = change(0.3 * finest_cell);
      if (is_root())
        std::cout << "Change by the other shell: " << near << std::endl;
      EXPECT_GT(near, 0.005);
      EXPECT_LT(change(3.1 * finest_cell), 1e-12);
    }
}


TEST(ShellPairs, ViscosityHasTheVolumesOfAll)
{
  for (const double viscosity_ratio : {5., 0.2})
    {
      const Spheres scene(triangle(0.3 * finest_cell), Interface::enriched, viscosity_ratio);
      const auto   &mu     = *scene.fluid.viscosity();
      const auto   &h      = scene.fluid.space().velocity->cell_sizes();
      double        excess = 0., volume = 0.;
      for (unsigned int cell = 0; cell < h.size(); ++cell)
        {
          excess += std::pow(h[cell], 3) * (mu.means()[cell] - 1.);
          EXPECT_GT(mu.means()[cell] - mu.least(), -1e-6); // slivers are approximated
          EXPECT_LT(mu.means()[cell] - std::max(1., viscosity_ratio), 1e-6);
        }
      for (const auto &shell : scene.shells)
        volume += shell->volume();
      EXPECT_NEAR(dealii::Utilities::MPI::sum(excess, MPI_COMM_WORLD), (viscosity_ratio - 1.) * volume, 2e-4 * std::abs(viscosity_ratio - 1.) * volume);
    }
}


TEST(ShellPairs, OrderOfFlowsWithTwoViscosities)
{
  // Beside cells of half the size; the shells share cells of either.
  for (const double gap : {0.3, 3.1})
    {
      const auto flow = [&](const double h) {
        Spheres scene(pair(gap * finest_cell), Interface::enriched, 5., h);
        return scene.flow(scene.waves(1.5), 1e-8).velocity;
      };
      const ShellFields finest = flow(0.5 * finest_cell);
      const double      error = difference(flow(finest_cell), finest), coarse_error = difference(flow(2. * finest_cell), finest);
      if (is_root())
        std::cout << "gap of " << gap << " cells: differences " << coarse_error << ", " << error << std::endl;
      EXPECT_LT(error, 0.012);
      EXPECT_LT(error, 0.4 * coarse_error);
    }
}


TEST(ShellPairs, AreTheSameAcrossThePeriodicFaces)
{
  // Moved by half the box in x and y the first is cut by the faces and the second, a period back, on the other side.
  const Centres centres = pair(0.3 * finest_cell);
  Centres       moved   = centres;
  moved[0] += Eigen::RowVector3d(5., 5., 0.);
  moved[1] += Eigen::RowVector3d(-5., 5., 0.);
  const Spheres     scene(centres), across(moved);
  const ShellFields f = scene.waves(2.);
  EXPECT_EQ(across.n_shared_cells(), scene.n_shared_cells());
  // Not to rounding: by the error of its quadrature the volume gradient depends on the origin.
  EXPECT_LT(difference(across.moved_by_themselves(f), scene.moved_by_themselves(f)), 1e-4);
}


TEST(ShellPairs, PowerOfTheShellsIsThatOfTheFlow)
{
  for (const Centres &centres : {pair(0.3 * finest_cell), pair(0.05 * finest_cell), triangle(0.3 * finest_cell)})
    {
      Spheres                     scene(centres);
      const ShellFields           f        = scene.waves(1.5);
      const Spheres::Flow         solution = scene.flow(f, 1e-12);
      const oracle::EnrichedPower oracle(scene, f, solution);
      // Twice the stationary value of the flow, integrated over the parts of the cells inside each shell and outside of all.
      const double of_shells = dot(f, solution.velocity), of_flow = 2. * oracle.power().force + 2. * oracle.power().pressure - oracle.power().dissipation;
      // What the pairs have to do with it: forces of each shell with the velocities that those of the others make there within common cells.
      double of_pairs = 0.;
      for (unsigned int c = 0; c < centres.size(); ++c)
        {
          const ShellFields Q_f_c = scene.moved_by_themselves(scene.waves_on(c, 1.5));
          of_pairs += dot(f, Q_f_c) - f[c].cwiseProduct(Q_f_c[c]).sum();
        }
      const unsigned int n_shared = oracle.n_shared_cells();
      if (is_root())
        std::cout << centres.size() << " shells, " << n_shared << " cells that two of them cut: power " << of_shells << ", that of the flow differs by "
                  << of_flow / of_shells - 1. << ", part of the pairs " << of_pairs / of_shells << std::endl;
      EXPECT_GT(n_shared, 0u);
      EXPECT_GT(std::abs(of_pairs), 3e-6 * of_shells);
      EXPECT_NEAR(of_shells, of_flow, 2e-9 * of_shells); // matrices of cut cells in single precision: 4e-10
    }
}
