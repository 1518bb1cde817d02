// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Skalak's membrane.

#ifndef tanktread_shell_skalak_h
#define tanktread_shell_skalak_h

#include <tanktread/shell/metric.h>

namespace tanktread
{
  /**
   * Skalak's law, w = (G_s/4) (I1^2 + 2 I1 - 2 I2 + C I2^2), per undeformed area, with I1 = abar^{alpha beta} a_{alpha beta} - 2,
   * I2 = det a/det abar - 1 and the area-dilatation number C > -1/2. Skalak, Tozeren, Zarda & Chien (1973); doc/theory.md, eq. (10).
   */
  MembraneDensity
  skalak(const Metric &metric, const ReferenceMetric &reference, double surface_shear_modulus, double area_dilatation);
} // namespace tanktread

#endif
