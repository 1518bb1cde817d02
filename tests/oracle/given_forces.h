// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow that given forces on a shell make, and forces whose flow is known.

#ifndef tanktread_oracle_given_forces_h
#define tanktread_oracle_given_forces_h

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>

#include <cmath>
#include <utility>

namespace tanktread::oracle
{
  /** A shell at rest in the fluid, without elasticity: forces are given. */
  struct GivenForces
  {
    /** @param side of the box. @param centre added to the control points. @param contrast of the viscosities. */
    GivenForces(FittedShape                fitted,
                const Interface            interface,
                const double               side,
                const FluidMeshParameters &mesh,
                const Eigen::RowVector3d  &centre,
                const ViscosityContrast   &contrast = {})
      : shape(std::move(fitted))
      , surface(shape.topology, triangle_quadrature(3), Derivatives::first)
      , fluid(MPI_COMM_WORLD, side, mesh)
      , h(fluid.mesh().cell_size(fluid.mesh().finest_level()))
      , coupling_surface(shape.topology, coupling_quadrature(shape.topology, shape.control_points, Interface::enriched, h), Derivatives::second)
      , coupling(coupling_surface, area_weights(coupling_surface, shape.control_points), interface)
      , shell(surface, {}, {0., 0.}, shape.control_points)
      , distributed(shell, shape.topology, MPI_COMM_WORLD)
      , centre(centre)
      , implicit_shell(MPI_COMM_WORLD)
      , viscosity_ratio(contrast.ratio)
    {
      coupling.set_viscosity_contrast(contrast);
      state.x = shape.control_points;
      state.x.rowwise() += centre;
      state.force = ControlPoints::Zero(state.x.rows(), 3);
      fluid.adapt(coupling.points(state.x));
      coupling.attach(fluid.space());
      v = volume_gradient(surface, state.x);
      coupling.move(state.x, v);
      set_viscosity(contrast);
      X       = coupling_surface.S() * state.x;
      weights = area_weights(coupling_surface, state.x);
    }

    /** Nodal forces of a density per area at the coupling's points. */
    ControlPoints
    nodal_forces(const ControlPoints &f) const
    {
      return coupling_surface.S().transpose() * (weights.asDiagonal() * f);
    }

    /** Flow (u, p, pi) that nodal forces drive, and the velocity of the control points. */
    struct Flow
    {
      FluidBlockVector fields;
      ControlPoints    velocity;
      unsigned int     iterations;
    };

    /**
     * Collective. @param tolerance relative residual. @param n_sweeps of the viscous part of the jumps, after a first solve without. Throws NumericalError if the linear solver does not get there in
     * 300 iterations.
     */
    Flow
    flow(const ControlPoints &F, const double tolerance, const unsigned int n_sweeps = 0)
    {
      const LinearisedShell          linear(distributed,
                                   surface,
                                   coupling,
                                   state,
                                   ControlPoints::Zero(F.rows(), 3),
                                   VelocityGradients::Zero(coupling.n_local_points(), 9),
                                   Linearisation{0., 1., 0., PointDerivatives::frozen},
                                   implicit_shell);
      Flow                           result{monolithic_vector(fluid.space(), F.rows()), {}, 0};
      const MonolithicOperator       matrix(fluid.stokes(), linear);
      const MonolithicPreconditioner preconditioner(fluid.preconditioner(), linear, enclosed_volume(surface, state.x) / (0.5 * (1. + viscosity_ratio)));
      for (unsigned int sweep = 0; sweep <= n_sweeps; ++sweep)
        {
          if (sweep > 0)
            coupling.update_viscous_forces(result.fields, F);
          FluidBlockVector rhs(result.fields);
          ExtendedForces   forces;
          rhs = 0.;
          if (viscosity_ratio != 1.)
            rhs.block(velocity_block) -= undisturbed_load;
          coupling.extend_whole(F, forces);
          coupling.spread(1., F, forces, rhs);
          const LinearReport report = solve_fgmres(matrix, preconditioner, result.fields, rhs, tolerance, 300);
          if (!report.converged)
            throw NumericalError("The flow of given forces did not converge in 300 iterations.");
          result.iterations += report.iterations;
          result.velocity = coupling.interpolate(result.fields, forces);
        }
      return result;
    }

    /** Relative difference of two velocities of the control points, L2 on the shell. */
    double
    difference(const ControlPoints &velocity, const ControlPoints &wanted) const
    {
      return difference_at_points(coupling_surface.S() * velocity, coupling_surface.S() * wanted);
    }

    /** The same of velocities at the coupling's points. */
    double
    difference_at_points(const ControlPoints &velocity, const ControlPoints &wanted) const
    {
      return std::sqrt((velocity - wanted).rowwise().squaredNorm().dot(weights) / wanted.rowwise().squaredNorm().dot(weights));
    }

    FittedShape        shape;
    SubdivisionSurface surface;
    Fluid              fluid;
    double             h; // finest cell
    SubdivisionSurface coupling_surface;
    Coupling           coupling;
    Shell              shell;
    DistributedShell   distributed;
    Eigen::RowVector3d centre;
    ImplicitShell      implicit_shell;
    State              state;
    ControlPoints      v, X;    // volume gradient; the coupling's points
    Eigen::VectorXd    weights; // and their areas
    double             viscosity_ratio;
    FluidVector        undisturbed_load; // empty with one viscosity

  private:
    void
    set_viscosity(const ViscosityContrast &contrast)
    {
      if (viscosity_ratio == 1.)
        return;
      fluid.set_viscosity(coupling.viscosity(state.x));
      dealii::Tensor<2, 3> gradient;
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          gradient[c][d] = contrast.flow_gradient(c, d);
      undisturbed_load.reinit(fluid.space().velocity->partitioner());
      fluid.viscosity()->add_excess_stress(fluid.space(), linear_flow(gradient), undisturbed_load);
    }
  };


  /**
   * A traction of degree l = 2 or 4 about an axis on the unit sphere, at points X, and the velocity that it makes in unbounded liquid of viscosity 1. With Y = P_l(axis . r), grad Y + l Y r
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
