// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the user chooses about the shell's mechanics.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/shell/shell_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <cmath>
#include <string>

namespace tanktread
{
  void
  ShellParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    add_enum_parameter(prm,
                       "Membrane law",
                       law,
                       {{"neo-Hookean", MembraneLaw::neo_hookean}, {"Skalak", MembraneLaw::skalak}, {"none", MembraneLaw::none}},
                       "Strain energy of the membrane. Both laws have the surface shear modulus E h/3; none: the shell bends only.");
    prm.add_parameter("Area dilatation number", area_dilatation, "C in Skalak's law, the resistance to changes of area; not used by neo-Hookean.");
    add_enum_parameter(prm,
                       "Reference curvature",
                       reference,
                       {{"flat", ReferenceCurvature::flat}, {"initial", ReferenceCurvature::initial}, {"value", ReferenceCurvature::value}},
                       "Mean curvature without bending moment: zero, that of the initial shape at each point, or the value given below.");
    prm.add_parameter("Reference curvature value", reference_curvature_value, "Mean curvature in 1/a for the choice 'value'; negative for a sphere, -1/R.");
    add_enum_parameter(prm,
                       "Bending form",
                       form,
                       {{"variational", BendingForm::variational}, {"moment-only", BendingForm::moment_only}},
                       "Virtual work of bending: the full variation of the bending energy, or the moments on the change of curvature only (Le 2010).");
    prm.add_parameter("Thickness",
                      thickness,
                      "Thickness h of the undeformed shell in a; its resistance to bending comes on top of 'Reduced bending modulus' and is unstressed in the "
                      "stress-free shape. 0: a membrane. With neo-Hookean only.",
                      dealii::Patterns::Double(0.));
  }


  void
  ShellParameters::check() const
  {
    if (law == MembraneLaw::skalak && !(area_dilatation > -0.5 && std::isfinite(area_dilatation)))
      throw InputError("Capsule/Area dilatation number: got " + std::to_string(area_dilatation) + "; Skalak's law is stable for numbers above -0.5.");
    if (!std::isfinite(reference_curvature_value))
      throw InputError("Capsule/Reference curvature value: got " + std::to_string(reference_curvature_value) + "; it has to be a finite number.");
    if (!(thickness >= 0.) || !std::isfinite(thickness))
      throw InputError("Capsule/Thickness: got " + std::to_string(thickness) + "; it must not be negative.");
    if (law != MembraneLaw::neo_hookean && thickness > 0.)
      throw InputError("Capsule/Thickness: got " + std::to_string(thickness) + "; only a neo-Hookean shell can be thick, allowed with this 'Membrane law': 0.");
  }
} // namespace tanktread
