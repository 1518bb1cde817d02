// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow, the dimensionless numbers and the box.

#ifndef tanktread_simulation_scene_parameters_h
#define tanktread_simulation_scene_parameters_h

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** What drives the flow. */
  enum class Flow
  {
    shear,    // undisturbed u = (z, 0, 0) with shear rate 1
    quiescent // nothing but the shell
  };

  /** Surface modulus M that G and khat are made with. */
  enum class ScaleModulus
  {
    young, // E h
    shear  // G_s = E h/3
  };

  /**
   * Section "Scene". Lengths in a, the radius of the sphere with the capsule's volume; viscosity in mu of the outer fluid. A shear scene measures time in
   * 1/gamma (shear rate), a quiescent one in mu a^3 / kappa_B.
   */
  struct SceneParameters
  {
    Flow   flow                    = Flow::shear;
    double shear_number            = 0.05; // G = mu gamma a / M
    double reduced_bending_modulus = 0.;   // khat = kappa_B / (a^2 M)
    double viscosity_ratio         = 1.;   // inside / outside
    double reynolds_number         = 0.;   // rho gamma a^2 / mu, quiescent: rho kappa_B / (mu^2 a); the density in the scene's units
    double box_side                = 10.;
    double end_time                = 10.;

    ScaleModulus scale_modulus = ScaleModulus::young;

    /** Declares section "Scene" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** @throws InputError for scenes that this version cannot compute. */
    void
    check() const;

    /** E h in these units: 1/G with shear, 1/khat without, three times that if they are made with G_s. */
    double
    surface_young_modulus() const;

    /** kappa_B in these units: khat/G with shear, 1 without. */
    double
    bending_modulus() const;
  };
} // namespace tanktread

#endif
