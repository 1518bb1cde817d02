// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow that given forces on a shell make, and forces whose flow is known.

#ifndef tanktread_oracle_given_forces_h
#define tanktread_oracle_given_forces_h

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/scene.h>
#include <tanktread/surface/surface_geometry.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tanktread::oracle
{
  /** Shells of one shape at rest in the fluid, without elasticity: forces are given. */
  struct GivenForces
  {
    /** @param side of the box. @param centres added to the control points of each. @param contrast of the viscosities. @param unbounded in place of the usual faces. */
    GivenForces(const FittedShape                     &shape,
                const Interface                        interface,
                const double                           side,
                const FluidMeshParameters             &mesh,
                const std::vector<Eigen::RowVector3d> &centres,
                const ViscosityContrast               &contrast  = {},
                const bool                             unbounded = false)
      : scene(description(shape, interface, side, mesh, centres, contrast, unbounded), MPI_COMM_WORLD)
      , fluid(scene.fluid())
      , coupling(scene.coupling())
      , coupling_surface(scene.capsule().coupling_surface())
      , h(fluid.mesh().cell_size(fluid.mesh().finest_level()))
      , state(scene.initial_state())
      , shells(scene.level().shells(state))
    {
      scene.refine_around(state);
      coupling.move(shells);
      scene.level().set_viscosity(state);
    }

    Eigen::RowVector3d
    centre(const unsigned int c = 0) const
    {
      return scene.description().places[c].centre;
    }
    /** Volume gradient of shell c. */
    const ControlPoints &
    v(const unsigned int c = 0) const
    {
      return shells[c]->volume_gradient();
    }
    /** The coupling's points on shell c. */
    const ControlPoints &
    X(const unsigned int c = 0) const
    {
      return shells[c]->points();
    }
    /** Their areas. */
    const Eigen::VectorXd &
    weights(const unsigned int c = 0) const
    {
      return shells[c]->point_areas();
    }
    double
    viscosity_ratio() const
    {
      return scene.description().liquids.viscosity_ratio;
    }

    /** Nodal forces of a density per area at the coupling's points of shell c. */
    ControlPoints
    nodal_forces(const ControlPoints &f, const unsigned int c = 0) const
    {
      return coupling_surface.S().transposed_times(weights(c).asDiagonal() * f);
    }

    /** Flow (u, p, pi) that nodal forces drive, and the velocity of the control points. */
    struct Flow
    {
      FluidBlockVector    fields;
      ShellFields         velocity;
      std::vector<double> pressure_jumps;
      unsigned int        iterations;
    };

    /**
     * Collective. @param F nodal forces of each shell. @param tolerance relative residual. @param n_sweeps of the viscous part of the jumps, and of what velocities
     * of the shells do to those on the faces, after a first
     * solve without. Throws NumericalError if the linear
     * solver does not get there in 300 iterations.
     */
    Flow
    flow(const ShellFields &F, const double tolerance, const unsigned int n_sweeps = 0)
    {
      const ShellLayout             &layout = scene.layout();
      ImplicitShells                 implicit_shells(layout, scene.memory());
      const LinearisedShells         linear = at_rest(implicit_shells);
      Flow                           result{layout.vector(fluid.space()), {}, {}, 0};
      const MonolithicOperator       matrix(fluid.stokes(), linear, layout);
      KrylovBasis                    basis;
      const PressureJumpResponse     jumps({fluid.stokes()}, fluid.preconditioner(), coupling, scene.level().liquids().mean_viscosity(), basis);
      const MonolithicPreconditioner preconditioner(fluid.preconditioner(), linear, layout, jumps);
      for (unsigned int sweep = 0; sweep <= n_sweeps; ++sweep)
        {
          if (sweep > 0)
            coupling.update_viscous_forces(result.fields, coupling.density(F));
          FluidBlockVector rhs(result.fields);
          ExtendedForces   forces;
          rhs = 0.;
          if (scene.level().has_viscosities())
            rhs.block(velocity_block) -= scene.level().undisturbed_load();
          if (scene.level().unbounded_liquid() != nullptr)
            subtract_faces(F, result, rhs);
          coupling.extend_whole(coupling.density(F), forces);
          coupling.spread(1., forces, rhs);
          const LinearReport report = solve_fgmres(matrix, preconditioner, result.fields, rhs, tolerance, 300);
          if (!report.converged)
            throw NumericalError("The flow of given forces did not converge in 300 iterations.");
          result.iterations += report.iterations;
          result.velocity = coupling.interpolate(result.fields, forces);
        }
      for (const ShellUnknowns &unknowns : layout.unknowns(result.fields))
        result.pressure_jumps.push_back(unknowns.pressure_jump);
      return result;
    }

    /** Relative difference of two velocities of the control points, L2 on the first shell. */
    double
    difference(const ControlPoints &velocity, const ControlPoints &wanted) const
    {
      return difference_at_points(coupling_surface.S() * velocity, coupling_surface.S() * wanted);
    }

    /** The same of velocities at the coupling's points. */
    double
    difference_at_points(const ControlPoints &velocity, const ControlPoints &wanted) const
    {
      return std::sqrt((velocity - wanted).rowwise().squaredNorm().dot(weights()) / wanted.rowwise().squaredNorm().dot(weights()));
    }

    Scene                     scene;
    Fluid                    &fluid;
    Coupling                 &coupling;
    const SubdivisionSurface &coupling_surface;
    const double              h; // finest cell
    const State               state;
    const ShellConfigurations shells;

  private:
    /** As the octree has it. */
    static double
    finest_cell_of(const double side, const FluidMeshParameters &parameters)
    {
      const FluidMesh mesh(MPI_COMM_WORLD, side, parameters);
      return mesh.cell_size(mesh.finest_level());
    }

    static SceneDescription
    description(const FittedShape                     &shape,
                const Interface                        interface,
                const double                           side,
                const FluidMeshParameters             &mesh,
                const std::vector<Eigen::RowVector3d> &centres,
                const ViscosityContrast               &contrast,
                const bool                             unbounded)
    {
      SceneDescription result;
      result.box               = side;
      result.liquids.unbounded = unbounded;
      if (unbounded)
        result.box.faces.fill(Faces::prescribed);
      result.liquids.flow.amplitude       = contrast.flow;
      result.liquids.viscosity_ratio      = contrast.ratio;
      result.kinds[0].shape               = shape;
      result.places                       = {centres.begin(), centres.end()};
      result.n_teams                      = 1; // so that all ranks know all shells
      result.kinds[0].moduli              = {0., 0.};
      result.kinds[0].coupling_quadrature = coupling_quadrature(shape.topology, shape.control_points, Interface::enriched, finest_cell_of(side, mesh));
      result.fluid_mesh                   = mesh;
      result.solver.interface             = interface;
      return result;
    }

    /** What the velocities on the faces of unbounded liquid load, with what is known of the flow. */
    void
    subtract_faces(const ShellFields &F, const Flow &flow, FluidBlockVector &rhs)
    {
      State       known      = state;
      ShellFields velocities = coupling.undisturbed_velocity(scene.level().flow(), shells);
      for (std::size_t c = 0; c < F.size(); ++c)
        {
          known.capsules[c].force = F[c];
          if (!flow.velocity.empty())
            velocities[c] += flow.velocity[c];
        }
      known.fluid.reinit(2);
      for (unsigned int b = 0; b <= pressure_block; ++b)
        known.fluid.block(b) = flow.fields.block(b);
      known.fluid.collect_sizes();
      UnboundedLiquid &liquid = *scene.level().unbounded_liquid();
      FluidBlockVector zero, load;
      fluid.space().reinit(zero);
      fluid.space().reinit(load);
      liquid.set(known, shells, velocities);
      liquid.faces().vmult(load, zero);
      for (unsigned int b = 0; b <= pressure_block; ++b)
        rhs.block(b) -= load.block(b);
    }

    LinearisedShells
    at_rest(ImplicitShells &implicit_shells) const
    {
      ShellFields velocities;
      for (const auto &shell : shells)
        velocities.push_back(ControlPoints::Zero(shell->x().rows(), 3));
      Linearisation choice; // tau = 0
      choice.derivatives = PointDerivatives::frozen;
      return {scene.elasticity(), coupling, state, shells, velocities, choice, implicit_shells};
    }
  };


  /**
   * A traction of degree l = 2 or 4 about an axis on the unit sphere, at points X, and the velocity that it makes in unbounded liquid of viscosity 1. With Y =
   * P_l(axis . r), grad Y + l Y r
   * is an eigenfunction of the single layer with the value (l + 1)/((2l + 1)(2l - 1)); its normal part is about as large as the tangential one.
   */
  inline std::pair<ControlPoints, ControlPoints>
  exact_on_sphere(const ControlPoints &X, const Eigen::RowVector3d &centre, const int l)
  {
    const Eigen::RowVector3d axis = Eigen::RowVector3d(1., 2., 3.).normalized();
    ControlPoints            traction(X.rows(), 3);
    for (Eigen::Index q = 0; q < X.rows(); ++q)
      {
        const Eigen::RowVector3d r  = (X.row(q) - centre).normalized();
        const double             s  = axis.dot(r);
        const double             Y  = l == 2 ? 1.5 * s * s - 0.5 : (35. * std::pow(s, 4) - 30. * s * s + 3.) / 8.;
        const double             dY = l == 2 ? 3. * s : (140. * std::pow(s, 3) - 60. * s) / 8.;
        traction.row(q)             = dY * (axis - s * r) + l * Y * r;
      }
    const ControlPoints velocity = (l + 1.) / ((2 * l + 1) * (2 * l - 1)) * traction;
    return {traction, velocity};
  }


  /** Smooth vectors, waves of wave number k, at given positions. */
  inline ControlPoints
  waves(const ControlPoints &x, const double k)
  {
    ControlPoints result(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      result.row(i) << std::sin(k * x(i, 1) + 0.3), std::cos(k * x(i, 2) - 0.2 * x(i, 0)), std::sin(k * x(i, 0)) * std::cos(x(i, 1));
    return result;
  }
} // namespace tanktread::oracle

#endif
