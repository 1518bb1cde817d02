// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow, the dimensionless numbers and the box.

#ifndef tanktread_simulation_scene_parameters_h
#define tanktread_simulation_scene_parameters_h

#include <tanktread/fluid/box.h>
#include <tanktread/solver/time_level.h>

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** What drives the flow. Rates are one. */
  enum class Flow
  {
    shear,              // (z, 0, 0)
    planar_extension,   // (x, 0, -z)
    uniaxial_extension, // (x, -y/2, -z/2)
    linear,             // any velocity gradient
    plane_poiseuille,   // (H/2 (1 - z^2/H^2), 0, 0)
    quiescent           // nothing but the shell
  };

  /** Surface modulus M that G and khat are made with. */
  enum class ScaleModulus
  {
    young, // E h
    shear  // G_s = E h/3
  };

  /** What is beyond the faces of the box. */
  enum class Boundary
  {
    faces,    // nothing: on each pair of faces holds what Box faces says
    unbounded // more of the same liquid, without end
  };

  /**
   * Section "Scene". Lengths in a, the radius of the sphere with the capsule's volume; viscosity in mu of the outer fluid. A scene with flow measures time in
   * 1/gamma (rate of the flow), a quiescent one in mu a^3 / kappa_B.
   */
  struct SceneParameters
  {
    Flow   flow                    = Flow::shear;
    double shear_number            = 0.05; // G = mu gamma a / M
    double reduced_bending_modulus = 0.;   // khat = kappa_B / (a^2 M)
    double viscosity_ratio         = 1.;   // inside / outside
    double reynolds_number         = 0.;   // rho gamma a^2 / mu, quiescent: rho kappa_B / (mu^2 a); the density in the scene's units
    double end_time                = 10.;

    std::vector<double>      velocity_gradient     = {0., 0., 1., 0., 0., 0., 0., 0., 0.}; // row by row
    double                   oscillation_frequency = 0.;                                   // radians per unit of time
    std::vector<double>      frame_velocity        = {0., 0., 0.};                         // of the frame in which positions are
    double                   channel_half_width    = 0.;                                   // H; 0: half the side of the box along z
    Boundary                 boundary              = Boundary::faces;
    std::vector<double>      box_side              = {10.}; // one number, or three
    std::vector<std::string> box_faces             = {"periodic", "periodic", "prescribed"};

    ScaleModulus scale_modulus = ScaleModulus::young;

    /** Declares section "Scene" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** @throws InputError for scenes that this version cannot compute. */
    void
    check() const;

    Box
    box() const;

    FlowInTime
    undisturbed_flow() const;

    /** E h in these units: 1/G with flow, 1/khat without, three times that if they are made with G_s. */
    double
    surface_young_modulus() const;

    /** kappa_B in these units: khat/G with flow, 1 without. */
    double
    bending_modulus() const;

  private:
    void
    add_numbers(dealii::ParameterHandler &prm);
    void
    check_flow() const;
    void
    check_box() const;
  };

  /** The words of a flow, as in the parameter file. */
  std::string
  word(Flow flow);
} // namespace tanktread

#endif
