// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: moving the control points along a shell that does not feel it, so that they stay evenly spread.

#ifndef tanktread_shell_even_mesh_h
#define tanktread_shell_even_mesh_h

#include <tanktread/shell/shell_configuration.h>

namespace tanktread
{
  /**
   * A velocity w along the shell by which its control points may differ from the material: where the place of the material in the surface costs no energy
   * (ShellParameters::place_is_free()), the surface moves the same with any. Here
   *
   *     w = P (rate r - U'),
   *
   * U' the velocity of the material less its rigid motion, P the part along the shell, r the displacement that takes the points to where a neo-Hookean sheet
   * with the initial shape undeformed, sliding on the surface, would be at rest. So the points move with the capsule, but else normal to the shell, and relax
   * to the distances that they began with, as far as the shape lets them. doc/theory.md, section 5.4.
   */
  class EvenMesh
  {
  public:
    /** Keeps `capsule` by reference. Throws NumericalError if its initial shape is degenerate. */
    explicit EvenMesh(const Capsule &capsule);

    // All fields are NP x 3. Where the shell is degenerate the functions throw NumericalError.

    /** w for a material velocity U in 1/rate, the time in which the points relax. The discrete volume does not change with it: v . w = 0. */
    ControlPoints
    velocity(const ShellConfiguration &shell, const ControlPoints &U, double rate) const;

    /** P field: least squares over the coupling's points, area of the initial shape, then what is left of v . w taken out along m. */
    ControlPoints
    along(const ShellConfiguration &shell, const ControlPoints &field) const;

    /** r, its part normal to the shell small but not zero: one step of Newton's method from where the points are. */
    ControlPoints
    relaxation(const ShellConfiguration &shell) const;

  private:
    const Capsule &capsule_;
    Shell          sheet_;
  };
} // namespace tanktread

#endif
