// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: energy, nodal forces and tangent of an elastic shell.

#ifndef tanktread_shell_shell_h
#define tanktread_shell_shell_h

#include <tanktread/shell/metric.h>
#include <tanktread/shell/shell_parameters.h>
#include <tanktread/shell/thick_neo_hookean.h>
#include <tanktread/surface/subdivision_surface.h>

#include <vector>

namespace tanktread
{
  /** Which matrix stands for -df/dx. */
  enum class Tangent
  {
    exact,
    positive // at each quadrature point without the negative eigenvalues of its symmetric part: that of a shell that cannot buckle
  };

  /**
   * A closed elastic shell: a membrane, or a shell of finite thickness, which is undeformed in its stress-free shape, and Helfrich bending about a reference
   * curvature. doc/theory.md, section 2.
   *
   * With a bending modulus and a thickness of zero nothing of bending is computed, and the surface needs first derivatives only. All sums run in a fixed order.
   */
  class Shell
  {
  public:
    /**
     * Keeps `surface` by reference; it has to have first derivatives, and second ones if the bending modulus or the thickness is not zero (std::logic_error
     * otherwise). Throws InputError on parameters that check() refuses, negative moduli or a thickness beyond the radii of curvature of the stress-free shape,
     * NumericalError where a shape is degenerate.
     *
     * @param stress_free control points, NP x 3, in which the membrane has no tension and a thick shell neither tension nor moments
     * @param initial     control points whose mean curvature ReferenceCurvature::initial means; empty: the same
     */
    Shell(const SubdivisionSurface &surface,
          const ShellParameters    &parameters,
          const ShellModuli        &moduli,
          const ControlPoints      &stress_free,
          const ControlPoints      &initial = ControlPoints());

    struct Energy
    {
      double membrane, bending;
    };

    // x holds the control points, NP x 3. Where a face is degenerate at a quadrature point (det a <= 0 or not finite) the functions throw NumericalError.

    // With a list of `faces` only these contribute: the sum over lists that hold every face once is what all faces give.

    /**
     * Energy of the membrane (of the thick shell, its bending included) and Helfrich energy; the latter is the same number for both forms of the bending work.
     */
    Energy
    energy(const ControlPoints &x) const;
    Energy
    energy(const ControlPoints &x, const std::vector<unsigned int> &faces) const;

    /** Nodal forces f_I = -dE/dx_I, NP x 3; with BendingForm::moment_only the bending part is minus the coefficients of its virtual work. */
    ControlPoints
    force(const ControlPoints &x) const;
    ControlPoints
    force(const ControlPoints &x, const std::vector<unsigned int> &faces) const;

    /**
     * The same forces, and K = -df/dx, 3 NP x 3 NP with the pattern of AssemblyPattern::block_matrix(). K is allocated unless it has that pattern from an
     * earlier call; its values are overwritten. It is symmetric unless bending works in the form moment_only.
     */
    void
    force_and_tangent(const ControlPoints &x, ControlPoints &f, SparseMatrix &K, Tangent tangent = Tangent::exact) const;
    void
    force_and_tangent(const ControlPoints &x, const std::vector<unsigned int> &faces, ControlPoints &f, SparseMatrix &K, Tangent tangent = Tangent::exact)
      const;

    /** Area that each quadrature point stands for in the stress-free shape, w_q sqrt(det abar) (length n_points). */
    const Eigen::VectorXd &
    reference_weights() const
    {
      return reference_weights_;
    }

  private:
    struct FaceBuffers;

    MembraneDensity
    membrane(const Metric &metric, unsigned int point) const;

    bool
    is_thick() const
    {
      return !thick_reference_.empty();
    }

    ThickDensity
    thick(const SurfaceDerivatives &y, const Metric &metric, unsigned int point, bool with_hessian) const;

    void
    set_reference_curvature(const ControlPoints &initial);

    void
    set_thick_reference(const ControlPoints &stress_free);

    void
    load_face(unsigned int face, const ControlPoints &x, FaceBuffers &buffers) const;

    void
    differentiate_points(unsigned int face, bool with_tangent, FaceBuffers &buffers) const;

    const SubdivisionSurface    &surface_;
    ShellParameters              parameters_;
    ShellModuli                  moduli_;
    unsigned int                 n_rows_; // 2 without bending and thickness, else 5
    std::vector<unsigned int>    all_faces_;
    std::vector<ReferenceMetric> reference_metric_;
    std::vector<ThickReference>  thick_reference_; // empty without thickness
    Eigen::VectorXd              reference_weights_, reference_curvature_;
  };
} // namespace tanktread

#endif
