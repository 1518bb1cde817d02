// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow, the dimensionless numbers and the box.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/scene_parameters.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    const std::vector<std::pair<std::string, Flow>> &
    flows()
    {
      static const std::vector<std::pair<std::string, Flow>> result = {{"shear", Flow::shear},
                                                                       {"planar extension", Flow::planar_extension},
                                                                       {"uniaxial extension", Flow::uniaxial_extension},
                                                                       {"linear", Flow::linear},
                                                                       {"plane Poiseuille", Flow::plane_poiseuille},
                                                                       {"quiescent", Flow::quiescent}};
      return result;
    }
  } // namespace


  std::string
  word(const Flow flow)
  {
    for (const auto &[text, enumerator] : flows())
      if (enumerator == flow)
        return text;
    return "";
  }


  void
  SceneParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Scene");
    add_enum_parameter(
      prm,
      "Flow",
      flow,
      flows(),
      "Undisturbed flow, of rate one. shear: (z, 0, 0). planar extension: (x, 0, -z). uniaxial extension: (x, -y/2, -z/2). linear: 'Velocity gradient' "
      "times the position. plane Poiseuille: (H/2 (1 - z^2/H^2), 0, 0), H the 'Channel half width'. Time is in 1/rate. quiescent: a liquid at rest, "
      "time in mu a^3 / kappa_B.");
    prm.add_parameter("Velocity gradient",
                      velocity_gradient,
                      "du_x/dx, du_x/dy, du_x/dz, du_y/dx, ... of the flow 'linear', in the rate that G is made with; no divergence.",
                      List(Double(), 9, 9));
    prm.add_parameter("Oscillation frequency",
                      oscillation_frequency,
                      "Angular frequency w, in radians per unit of time, of a flow that swings: the undisturbed flow times cos(w t). 0: a steady flow.",
                      Double(0.));
    prm.add_parameter(
      "Frame velocity",
      frame_velocity,
      "Velocity of the frame of all positions and velocities against the one in which the flow is as given above: near that of the capsule its cells stay "
      "where they are. Faces with prescribed velocity are at rest where the flow as given is.",
      List(Double(), 3, 3));
    prm.add_parameter("Channel half width",
                      channel_half_width,
                      "H of plane Poiseuille flow: its velocity is zero and its shear rate one at z = -H and H, in a. 0: at the faces of the box.",
                      Double(0.));
    add_numbers(prm);
    add_enum_parameter(
      prm,
      "Boundary",
      boundary,
      {{"faces", Boundary::faces}, {"unbounded", Boundary::unbounded}},
      "What the liquid meets at the faces of the box. faces: what 'Box faces' says. unbounded: more of the same liquid, without end; on all faces the "
      "velocity is what the shells' forces make in unbounded liquid, and the undisturbed flow. A box of 7.5 a does for a capsule. Without inertia.");
    prm.add_parameter("Box side",
                      box_side,
                      "Side of the box, in a, whose middle is the origin: one number, or three along x, y and z.",
                      List(Double(3.), 1, 3));
    prm.add_parameter(
      "Box faces",
      box_faces,
      "What holds on the faces of the box across x, y and z. periodic: what leaves on one side comes in on the other; the flow must not change along that axis. "
      "prescribed: the velocity is that of the undisturbed flow, a wall where that does not pass the face. Not read with 'Boundary = unbounded'.",
      List(Selection("periodic|prescribed"), 3, 3));
    prm.add_parameter("End time", end_time, "The run ends at this time.", Double(0.));
    prm.leave_subsection();
  }


  void
  SceneParameters::add_numbers(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    const double positive = std::numeric_limits<double>::min();
    prm.add_parameter(
      "Shear number G",
      shear_number,
      "G = mu gamma a / M with the surface modulus M named by 'Scale modulus', E h unless said otherwise, and gamma the rate of the flow. Unused without flow.",
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
                      "Re = rho gamma a^2 / mu with flow, rho kappa_B / (mu^2 a) without, the same density everywhere; 0: Stokes flow.",
                      Double(0.));
  }


  Box
  SceneParameters::box() const
  {
    Box result;
    for (unsigned int d = 0; d < 3; ++d)
      {
        result.side[d]  = box_side.size() == 1 ? box_side[0] : box_side[d];
        result.faces[d] = boundary == Boundary::faces && box_faces[d] == "periodic" ? Faces::periodic : Faces::prescribed;
      }
    return result;
  }


  FlowInTime
  SceneParameters::undisturbed_flow() const
  {
    FlowInTime result;
    result.frequency = oscillation_frequency;
    switch (flow)
      {
        case Flow::shear:
          result.amplitude = simple_shear();
          break;
        case Flow::planar_extension:
          result.amplitude = planar_extension();
          break;
        case Flow::uniaxial_extension:
          result.amplitude = uniaxial_extension();
          break;
        case Flow::linear:
          for (unsigned int c = 0; c < 3; ++c)
            for (unsigned int d = 0; d < 3; ++d)
              result.amplitude.linear[c][d] = velocity_gradient[3 * c + d];
          break;
        case Flow::plane_poiseuille:
          result.amplitude = plane_poiseuille(channel_half_width > 0. ? channel_half_width : 0.5 * box().side[2]);
          break;
        case Flow::quiescent:
          break;
      }
    for (unsigned int c = 0; c < 3; ++c)
      result.amplitude.constant[c] -= frame_velocity[c];
    return result;
  }


  void
  SceneParameters::check_flow() const
  {
    std::ostringstream message;
    const double       divergence = velocity_gradient[0] + velocity_gradient[4] + velocity_gradient[8];
    if (flow == Flow::quiescent && reduced_bending_modulus == 0.)
      message << "Scene/Reduced bending modulus is 0; allowed with Scene/Flow = quiescent: a number > 0 (time is in units of mu a^3 / kappa_B)";
    else if (flow == Flow::linear && std::abs(divergence) > 1e-12)
      message << "Scene/Velocity gradient has the divergence " << divergence << " (du_x/dx + du_y/dy + du_z/dz); allowed: 0";
    else if (oscillation_frequency > 0. && std::hypot(frame_velocity[0], frame_velocity[1], frame_velocity[2]) > 0.)
      message << "Scene/Frame velocity is not zero; allowed with Scene/Oscillation frequency = " << oscillation_frequency << ": 0, 0, 0";
    else if (oscillation_frequency > 0. && viscosity_ratio != 1.)
      message << "Scene/Oscillation frequency is " << oscillation_frequency << "; allowed with Scene/Viscosity ratio = " << viscosity_ratio
              << " in this version: 0";
    if (!message.str().empty())
      throw InputError(message.str());
  }


  void
  SceneParameters::check_box() const
  {
    static const char *const axes = "xyz";
    std::ostringstream       message;
    if (box_side.size() == 2)
      throw InputError("Scene/Box side has 2 numbers; allowed: one, or three");
    if (boundary == Boundary::unbounded && reynolds_number > 0.)
      {
        message << "Scene/Boundary is unbounded; allowed with Scene/Reynolds number = " << reynolds_number
                << ": faces (the flow far away is known without inertia only)";
        throw InputError(message.str());
      }
    if (boundary == Boundary::unbounded && flow == Flow::plane_poiseuille && channel_half_width == 0.)
      throw InputError("Scene/Channel half width is 0; allowed with Scene/Boundary = unbounded, where the faces of the box are no walls: a number > 0");
    const Box             box   = this->box();
    const UndisturbedFlow u_inf = undisturbed_flow().amplitude;
    bool                  open  = true;
    for (unsigned int d = 0; d < 3; ++d)
      {
        open = open && box.is_periodic(d);
        if (box.is_periodic(d) && u_inf.varies_along(d))
          throw InputError("Scene/Box faces has 'periodic' across " + std::string(1, axes[d]) + ", but the flow (Scene/Flow = " + word(flow) +
                           ") changes along " + axes[d] + "; allowed there: prescribed");
      }
    if (open)
      throw InputError("Scene/Box faces has 'periodic' across all axes; allowed: 'prescribed' across one at least, which keeps the box in place");
  }


  void
  SceneParameters::check() const
  {
    check_flow();
    check_box();
  }


  double
  SceneParameters::surface_young_modulus() const
  {
    const double scale = flow == Flow::quiescent ? 1. / reduced_bending_modulus : 1. / shear_number;
    return scale_modulus == ScaleModulus::shear ? 3. * scale : scale;
  }


  double
  SceneParameters::bending_modulus() const
  {
    return flow == Flow::quiescent ? 1. : reduced_bending_modulus / shear_number;
  }
} // namespace tanktread
