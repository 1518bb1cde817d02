// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what is measured on a state: each capsule, and all of them together.

#ifndef tanktread_simulation_observables_h
#define tanktread_simulation_observables_h

#include <tanktread/coupling/interface_quality.h>
#include <tanktread/shell/shell.h>
#include <tanktread/simulation/particle_stress.h>
#include <tanktread/solver/scene.h>
#include <tanktread/surface/mesh_quality.h>
#include <tanktread/surface/surface_geometry.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /** Names and values of the columns of a table, in their order. */
  using Row = std::vector<std::pair<std::string, double>>;

  /** What is the same for all capsules of a step. */
  struct StepObservables
  {
    double       time        = 0.;
    double       step        = 0.;
    double       dissipation = 0.;                                                                  // in the box, beyond that of the undisturbed flow
    double       local_error = std::numeric_limits<double>::quiet_NaN(), energy_rise = local_error; // see StepResult
    unsigned int newton_iterations = 0, linear_iterations = 0;
    double       n_cells   = 0.;
    double       wall_time = 0.;
  };

  /** One capsule: a row of its history. */
  struct CapsuleObservables
  {
    InertiaEllipsoid ellipsoid{};
    Eigen::Vector3d  velocity      = Eigen::Vector3d::Zero(); // of the centre of the enclosed volume
    double           theta_over_pi = 0.;                      // inclination in units of pi; not a number while the section is round
    double           volume = 0., volume_error = 0., area = 0.;
    Shell::Energy    energy{};
    double           power            = 0.; // F . U, what the shell gives to the liquid
    double           pressure_jump    = 0.;
    double           theta_continuous = 0., alpha = 0., delta = 0.; // see PhaseAngles
    Eigen::Matrix3d  stress = Eigen::Matrix3d::Zero();              // see particle_stress()
    Rheology         rheology{};
    double           energy_residual = std::numeric_limits<double>::quiet_NaN(); // of the last step, see energy_residual()
    ShapeQuality     shape;
    InterfaceQuality interface;                                          // zero with the plain interface
    double           self_gap = std::numeric_limits<double>::infinity(); // see smallest_self_gap()
  };

  /** All capsules together: a row of suspension.csv. In unbounded liquid there are no means over its volume: they are not numbers. */
  struct SuspensionObservables
  {
    Eigen::Matrix3d stress              = Eigen::Matrix3d::Zero(); // sum of the particle stresses over the volume of the box
    Eigen::Matrix3d momentum_flux       = Eigen::Matrix3d::Zero(); // -Re times the mean of u_i u_j over the box, of the disturbance u; zero without inertia
    double          relative_viscosity  = 0.;                      // 1 + (both) : E / (2 E : E), E the strain rate of a linear flow; not a number otherwise
    double          smallest_gap        = 0.;                      // see ShellGap; infinite for one capsule far from its images
    double          distance_from_faces = 0.;                      // that are not periodic; infinite without
    double          volume_fraction     = 0.;
    unsigned int    shared_cells        = 0; // of the fluid, in which two shells or more meet; zero with the plain interface, which does not look for them
  };

  /** Shape, energies and stress of each of the rank's own capsules. @param velocities of their control points. Collective. */
  std::vector<CapsuleObservables>
  observe(Scene &scene, const State &state, const ShellFields &velocities);

  /** Of all capsules, the same on all ranks. @param capsules the rank's own ones in the same state. Collective. */
  SuspensionObservables
  observe_suspension(Scene &scene, const State &state, const std::vector<CapsuleObservables> &capsules);

  /** The columns of history.csv. */
  Row
  history_row(const StepObservables &step, const CapsuleObservables &capsule);

  /** The columns of suspension.csv. */
  Row
  suspension_row(const StepObservables &step, const SuspensionObservables &suspension);
} // namespace tanktread

#endif
