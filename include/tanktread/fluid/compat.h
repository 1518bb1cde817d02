// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the only place that asks for deal.II's version.

#ifndef tanktread_fluid_compat_h
#define tanktread_fluid_compat_h

#include <deal.II/base/config.h>
#include <deal.II/base/index_set.h>
#include <deal.II/lac/affine_constraints.h>

namespace tanktread::compat
{
  /** Makes `constraints` empty, ready to store the lines of `relevant` degrees of freedom. */
  inline void
  reinit(dealii::AffineConstraints<double> &constraints, const dealii::IndexSet &owned, const dealii::IndexSet &relevant)
  {
#if DEAL_II_VERSION_GTE(9, 6, 0)
    constraints.reinit(owned, relevant);
#else
    (void)owned;
    constraints.reinit(relevant);
#endif
  }
} // namespace tanktread::compat

#endif
