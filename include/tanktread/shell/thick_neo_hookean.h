// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the incompressible neo-Hookean shell of finite thickness.

#ifndef tanktread_shell_thick_neo_hookean_h
#define tanktread_shell_thick_neo_hookean_h

#include <tanktread/shell/helfrich.h>
#include <tanktread/shell/metric.h>

#include <array>

namespace tanktread
{
  /** Components kappa_{alpha beta} = a_{alpha,beta} . a_3 of the curvature tensor at a point, negative on a sphere. */
  struct CurvatureTensor
  {
    explicit CurvatureTensor(const SurfaceDerivatives &y);

    double k11, k12, k22;
  };

  /** The undeformed shell at a point of its middle surface, as thick_neo_hookean() needs it. */
  struct ThickReference
  {
    ThickReference() = default;

    /** `y` of the undeformed shape; `thickness` h > 0. Throws InputError where h/2 reaches a principal radius of curvature. */
    ThickReference(const SurfaceDerivatives &y, double thickness);

    /** A layer at height zeta over the middle surface. */
    struct Layer
    {
      ReferenceMetric metric; // gbar of the layer
      double          height; // zeta sqrt(det abar), so that zeta times the stretch of the thickness is height/sqrt(det a)
      double          weight; // of Simpson's rule for the mean over the thickness, times sqrt(det gbar/det abar)
    };
    std::array<Layer, 3> layers;
  };

  /** Energy W per undeformed area of the middle surface with its derivatives by (a11, a12, a22, k11, k12, k22). */
  struct ThickDensity
  {
    double                      energy;
    Eigen::Matrix<double, 6, 1> gradient;
    Eigen::Matrix<double, 6, 6> hessian;
  };

  /**
   * Incompressible neo-Hookean material of Young's modulus E and thickness h in plane stress, after Le (2010), eqs. (2)-(9); doc/theory.md, section 2.7. With
   * the metric g of the layer at height zeta eta of the deformed shell, eta = sqrt(det abar/det a) the stretch of the thickness,
   *   W = (1/h) int (E h/6) (gbar^{alpha beta} g_{alpha beta} + det gbar/det g - 3) sqrt(det gbar/det abar) dzeta,
   * the mean over -h/2 < zeta < h/2 by Simpson's rule with three points. For h -> 0 that is neo_hookean() with G_s = E h/3; the next term is of order h^2.
   * Without `with_hessian` the second derivatives are left zero. Throws NumericalError where the inner or outer side of the shell has folded: half the
   * thickness
   * beyond a radius of curvature.
   */
  ThickDensity
  thick_neo_hookean(const Metric          &metric,
                    const CurvatureTensor &curvature,
                    const ThickReference  &reference,
                    double                 surface_young_modulus,
                    bool                   with_hessian = true);

  /** Adds the first and, if `tangent` is not null, second derivatives of weight * w by y. */
  void
  add_derivatives(const ThickDensity &w, double weight, const SurfaceDerivatives &y, SurfaceDerivatives &gradient, SurfaceDerivativesTangent *tangent);
} // namespace tanktread

#endif
