// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the neo-Hookean membrane.

#ifndef tanktread_shell_neo_hookean_h
#define tanktread_shell_neo_hookean_h

#include <tanktread/shell/metric.h>

namespace tanktread
{
  /**
   * Incompressible neo-Hookean sheet, w = (G_s/2) (abar^{alpha beta} a_{alpha beta} + det abar/det a - 3), per undeformed area.
   * With the principal stretches that is (G_s/2) (l1^2 + l2^2 + 1/(l1 l2)^2 - 3); G_s = E h/3. doc/theory.md, eq. (9).
   */
  MembraneDensity
  neo_hookean(const Metric &metric, const ReferenceMetric &reference, double surface_shear_modulus);
} // namespace tanktread

#endif
