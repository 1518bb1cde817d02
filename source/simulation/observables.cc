// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what is measured on a state: each capsule, and all of them together.

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <tanktread/fluid/velocity_products.h>
#include <tanktread/simulation/observables.h>

namespace tanktread
{
  namespace
  {
    constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

    /** Of a closed surface whose points move with U: d/dt of the centroid is the integral of (X - c) U . n over the volume. */
    Eigen::Vector3d
    velocity_of_centroid(const ShellConfiguration &shell, const ControlPoints &velocity, const Eigen::Vector3d &centroid)
    {
      const SubdivisionSurface &surface = shell.capsule().surface();
      const ControlPoints       X = (surface.S() * shell.x()).rowwise() - centroid.transpose(), U = surface.S() * velocity;
      const Eigen::VectorXd     flux = normals(surface, shell.x()).cwiseProduct(U).rowwise().sum().cwiseProduct(area_weights(surface, shell.x()));
      return X.transpose() * flux / shell.volume();
    }
  } // namespace


  std::vector<CapsuleObservables>
  observe(Scene &scene, const State &state, const ShellFields &velocities)
  {
    const ShellConfigurations        shells     = scene.level().shells(state);
    const UndisturbedFlow           &flow       = scene.level().flow();
    const double                     ratio      = scene.level().liquids().viscosity_ratio;
    const double                     shear_rate = flow.linear[0][2]; // of simple shear; elsewhere not read
    const std::vector<Shell::Energy> energies   = scene.elasticity().energies(positions(state));
    std::vector<CapsuleObservables>  result;
    for (std::size_t c = 0; c < shells.size(); ++c)
      {
        const CapsuleState &of_capsule = state.capsules[c];
        const Capsule      &capsule    = scene.capsule(c);
        CapsuleObservables  o;
        o.ellipsoid     = inertia_ellipsoid(capsule.surface(), of_capsule.x);
        o.theta_over_pi = o.ellipsoid.taylor_parameter < 1e-4 ? not_a_number : o.ellipsoid.inclination / dealii::numbers::PI;
        o.velocity      = velocity_of_centroid(*shells[c], velocities[c], o.ellipsoid.centroid);
        o.volume        = shells[c]->volume();
        o.volume_error  = o.volume / capsule.volume() - 1.;
        o.area          = surface_area(capsule.surface(), of_capsule.x);
        o.energy        = energies[c];
        o.power         = of_capsule.force.cwiseProduct(velocities[c]).sum();
        o.pressure_jump = of_capsule.pressure_jump;
        o.stress        = particle_stress(of_capsule.x, of_capsule.force); // with one viscosity the forces are all of it
        if (ratio != 1.)
          o.stress += viscous_stress(capsule.surface(), of_capsule.x, velocities[c], ratio);
        UndisturbedFlow without_shear = flow;
        without_shear.linear[0][2]    = 0.;
        without_shear.constant        = 0.;
        o.rheology                    = rheology(o.stress, o.volume, without_shear.is_zero() ? shear_rate : 0.);
        result.push_back(o);
      }
    return result;
  }


  SuspensionObservables
  observe_suspension(Scene &scene, const State &state, const std::vector<CapsuleObservables> &capsules)
  {
    SuspensionObservables result;
    const double          volume = scene.description().liquids.unbounded ? not_a_number : scene.description().box.volume(); // without a volume no mean
    for (const CapsuleObservables &capsule : capsules)
      {
        result.stress += capsule.stress / volume;
        result.volume_fraction += capsule.volume / volume;
      }
    result.volume_fraction = scene.layout().sum(result.volume_fraction);
    for (unsigned int i = 0; i < 9; ++i)
      result.stress.data()[i] = scene.layout().sum(result.stress.data()[i]);
    if (const double density = scene.level().liquids().reynolds_number; density > 0.)
      {
        const dealii::SymmetricTensor<2, 3> products = integral_of_products(scene.fluid().space(), state.fluid.block(velocity_block));
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int d = 0; d < 3; ++d)
            result.momentum_flux(c, d) = -density / volume * products[c][d];
      }
    const UndisturbedFlow     &flow     = scene.level().flow();
    const dealii::Tensor<2, 3> E        = 0.5 * (flow.linear + transpose(flow.linear));
    double                     together = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int d = 0; d < 3; ++d)
        together += (result.stress(c, d) + result.momentum_flux(c, d)) * E[c][d];
    const bool is_linear       = flow.quadratic.norm_square() == 0. && E.norm_square() > 0.;
    result.relative_viscosity  = is_linear ? 1. + together / (2. * E.norm_square()) : not_a_number;
    result.smallest_gap        = scene.gap(state).gap;
    result.distance_from_faces = scene.distance_from_faces(state);
    result.shared_cells        = dealii::Utilities::MPI::sum(scene.coupling().jumps().pairs().n_cells(), scene.communicator());
    return result;
  }


  Row
  history_row(const StepObservables &step, const CapsuleObservables &o)
  {
    return {{"time", step.time},
            {"D_xz", o.ellipsoid.taylor_parameter},
            {"theta", o.theta_over_pi},
            {"L", o.ellipsoid.L},
            {"B", o.ellipsoid.B},
            {"W", o.ellipsoid.W},
            {"volume", o.volume},
            {"volume_error", o.volume_error},
            {"area", o.area},
            {"membrane_energy", o.energy.membrane},
            {"bending_energy", o.energy.bending},
            {"dissipation", step.dissipation},
            {"newton_iterations", double(step.newton_iterations)},
            {"linear_iterations", double(step.linear_iterations)},
            {"wall_time", step.wall_time},
            {"alpha", o.alpha},
            {"delta", o.delta},
            {"pressure_jump", o.pressure_jump},
            {"step", step.step},
            {"cells", step.n_cells},
            {"theta_continuous", o.theta_continuous},
            {"S_xx", o.stress(0, 0)},
            {"S_yy", o.stress(1, 1)},
            {"S_zz", o.stress(2, 2)},
            {"S_xy", o.stress(0, 1)},
            {"S_xz", o.stress(0, 2)},
            {"S_yz", o.stress(1, 2)},
            {"intrinsic_viscosity", o.rheology.intrinsic_viscosity},
            {"N1", o.rheology.normal_difference_1},
            {"N2", o.rheology.normal_difference_2},
            {"x", o.ellipsoid.centroid[0]},
            {"y", o.ellipsoid.centroid[1]},
            {"z", o.ellipsoid.centroid[2]},
            {"u_x", o.velocity[0]},
            {"u_y", o.velocity[1]},
            {"u_z", o.velocity[2]},
            {"power", o.power},
            {"energy_residual", o.energy_residual},
            {"worst_triangle", o.shape.worst_triangle},
            {"smallest_radius", o.shape.smallest_radius},
            {"detail", o.shape.detail},
            {"detail_ratio", o.shape.detail_ratio},
            {"area_without_jumps", o.interface.without_jumps},
            {"area_folded", o.interface.folded},
            {"self_gap", o.self_gap},
            {"local_error", step.local_error},
            {"energy_rise", step.energy_rise}};
  }


  Row
  suspension_row(const StepObservables &step, const SuspensionObservables &o)
  {
    return {{"time", step.time},
            {"S_xx", o.stress(0, 0)},
            {"S_yy", o.stress(1, 1)},
            {"S_zz", o.stress(2, 2)},
            {"S_xy", o.stress(0, 1)},
            {"S_xz", o.stress(0, 2)},
            {"S_yz", o.stress(1, 2)},
            {"relative_viscosity", o.relative_viscosity},
            {"N1", o.stress(0, 0) - o.stress(2, 2)},
            {"N2", o.stress(2, 2) - o.stress(1, 1)},
            {"smallest_gap", o.smallest_gap},
            {"wall_gap", o.distance_from_faces},
            {"volume_fraction", o.volume_fraction},
            {"shared_cells", double(o.shared_cells)},
            {"momentum_flux_xz", o.momentum_flux(0, 2)}};
  }
} // namespace tanktread
