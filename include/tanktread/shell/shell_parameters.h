// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the user chooses about the shell's mechanics.

#ifndef tanktread_shell_shell_parameters_h
#define tanktread_shell_shell_parameters_h

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Strain energy of the membrane; see neo_hookean.h and skalak.h. */
  enum class MembraneLaw
  {
    neo_hookean,
    skalak,
    none // no membrane: the shell bends only
  };

  /** Mean curvature at which bending costs nothing: zero, that of the initial shape (not the stress-free one) at each material point, or one number. */
  enum class ReferenceCurvature
  {
    flat,
    initial,
    value
  };

  /** Which virtual work bending does; see helfrich.h. */
  enum class BendingForm
  {
    variational,
    moment_only
  };

  /** The parameters of section "Capsule" that describe the shell. */
  struct ShellParameters
  {
    MembraneLaw        law                       = MembraneLaw::neo_hookean;
    double             area_dilatation           = 1.;
    ReferenceCurvature reference                 = ReferenceCurvature::flat;
    double             reference_curvature_value = 0.;
    BendingForm        form                      = BendingForm::variational;
    double             thickness                 = 0.;

    /** Declares the parameters in the section of `prm` that is open; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** Throws InputError on values that are not allowed or not implemented. */
    void
    check() const;

    /** Whether it costs no energy to move the material along the shell, the surface as it is: nothing but bending about one curvature everywhere. */
    bool
    place_is_free() const
    {
      return law == MembraneLaw::none && thickness == 0. && reference != ReferenceCurvature::initial;
    }
  };

  /** Moduli in the units of the computation. */
  struct ShellModuli
  {
    /** E h, Young's modulus times thickness. */
    double surface_young_modulus;
    /** kappa_B; zero switches all bending work off. */
    double bending_modulus;

    /** G_s = E h/3, of an incompressible sheet. Both membrane laws are written with it, so the capillary number mu gamma a/G_s is 3 G for both. */
    double
    surface_shear_modulus() const
    {
      return surface_young_modulus / 3.;
    }
  };
} // namespace tanktread

#endif
