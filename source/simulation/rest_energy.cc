// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the energy of shells in a liquid at rest, which can only fall.

#include <tanktread/simulation/rest_energy.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tanktread
{
  namespace
  {
    bool
    is_known(const SceneDescription &scene)
    {
      const bool has_energy = std::all_of(scene.kinds.begin(), scene.kinds.end(), [](const CapsuleKind &kind) { return kind.has_energy(); });
      return scene.liquids.flow.amplitude.is_zero() && scene.liquids.reynolds_number == 0. && has_energy;
    }


    double
    energy(const Scene &scene, const ShellFields &x)
    {
      double result = 0.;
      for (const Shell::Energy &of_capsule : scene.elasticity().energies(x))
        result += of_capsule.membrane + of_capsule.bending;
      return scene.layout().sum(result);
    }
  } // namespace


  void
  RestEnergy::start(const Scene &scene, const ShellFields &x)
  {
    scale = 0.;
    for (const CapsuleKind &kind : scene.description().kinds)
      scale = std::max(scale, kind.moduli.bending_modulus > 0. ? kind.moduli.bending_modulus : kind.moduli.surface_young_modulus);
    add(scene, x);
    scale = std::max(scale, std::abs(last));
  }


  double
  RestEnergy::rise(const Scene &scene, const ShellFields &x) const
  {
    return is_known(scene.description()) ? (energy(scene, x) - last) / scale : std::numeric_limits<double>::quiet_NaN();
  }


  void
  RestEnergy::add(const Scene &scene, const ShellFields &x)
  {
    if (is_known(scene.description()))
      last = energy(scene, x);
  }
} // namespace tanktread
