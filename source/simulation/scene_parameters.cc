// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow, the dimensionless numbers and the box.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/scene_parameters.h>

#include <limits>
#include <sstream>

namespace tanktread
{
  void
  SceneParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    const double positive = std::numeric_limits<double>::min();
    prm.enter_subsection("Scene");
    add_enum_parameter(prm,
                       "Flow",
                       flow,
                       {{"shear", Flow::shear}, {"quiescent", Flow::quiescent}},
                       "shear: u = (z, 0, 0) far from the capsule, time in 1/gamma. quiescent: walls at rest, time in mu a^3 / kappa_B.");
    prm.add_parameter("Shear number G",
                      shear_number,
                      "G = mu gamma a / M with the surface modulus M named by 'Scale modulus', E h unless said otherwise. Unused without shear.",
                      Double(positive));
    prm.add_parameter("Reduced bending modulus", reduced_bending_modulus, "khat = kappa_B / (a^2 M), M as for G.", Double(0.));
    add_enum_parameter(
      prm,
      "Scale modulus",
      scale_modulus,
      {{"Young", ScaleModulus::young}, {"shear", ScaleModulus::shear}},
      "Modulus M in G and khat. Young: E h = 3 G_s, Young's modulus times thickness (for Skalak's law by definition). shear: the surface shear "
      "modulus G_s, so that G is the capillary number.");
    prm.add_parameter("Viscosity ratio", viscosity_ratio, "Viscosity inside over viscosity outside.", Double(0.01, 100.));
    prm.add_parameter("Reynolds number",
                      reynolds_number,
                      "Re = rho gamma a^2 / mu with shear, rho kappa_B / (mu^2 a) without, the same density everywhere; 0: Stokes flow.",
                      Double(0.));
    prm.add_parameter("Box side", box_side, "Side of the cube, in a; walls at z = -side/2 and side/2, periodic in x and y.", Double(3.));
    prm.add_parameter("End time", end_time, "The run ends at this time.", Double(0.));
    prm.leave_subsection();
  }

  void
  SceneParameters::check() const
  {
    std::ostringstream message;
    if (flow == Flow::quiescent && reduced_bending_modulus == 0.)
      message << "Scene/Reduced bending modulus is 0; allowed with Scene/Flow = quiescent: a number > 0 (time is in units of mu a^3 / kappa_B)";
    if (!message.str().empty())
      throw InputError(message.str());
  }

  double
  SceneParameters::surface_young_modulus() const
  {
    const double scale = flow == Flow::shear ? 1. / shear_number : 1. / reduced_bending_modulus;
    return scale_modulus == ScaleModulus::shear ? 3. * scale : scale;
  }

  double
  SceneParameters::bending_modulus() const
  {
    return flow == Flow::shear ? reduced_bending_modulus / shear_number : 1.;
  }
} // namespace tanktread
