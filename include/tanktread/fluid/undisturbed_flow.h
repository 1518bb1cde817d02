// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the flow without capsules, a polynomial of degree two.

#ifndef tanktread_fluid_undisturbed_flow_h
#define tanktread_fluid_undisturbed_flow_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

namespace tanktread
{
  /**
   * u_c(x) = constant_c + linear_cd x_d + 1/2 quadratic_cde x_d x_e (sums over d and e, quadratic symmetric in them), free of divergence. All fluid unknowns
   * are disturbances of it. The force per volume that keeps it up, the
   * gradient of its pressure included, acts on the liquid inside a capsule as on that outside. Velocities in a times the unit of rates.
   */
  struct UndisturbedFlow
  {
    dealii::Tensor<1, 3> constant;
    dealii::Tensor<2, 3> linear;
    dealii::Tensor<3, 3> quadratic;

    dealii::Tensor<1, 3>
    velocity(const dealii::Point<3> &x) const;

    /** Entry [c][d] is du_c/dx_d. */
    dealii::Tensor<2, 3>
    gradient(const dealii::Point<3> &x) const;

    /** The same everywhere. */
    dealii::Tensor<1, 3>
    laplacian() const;

    /** Whether it changes along axis d, which it must not where the box is periodic. */
    bool
    varies_along(unsigned int d) const;

    bool
    is_zero() const;

    /** Or constant: its gradient is the same everywhere. */
    bool
    is_linear() const;
  };

  /** Every velocity times `factor`. */
  UndisturbedFlow
  operator*(double factor, const UndisturbedFlow &flow);

  /** u = gradient x. */
  UndisturbedFlow
  linear_flow(const dealii::Tensor<2, 3> &gradient);

  /** (rate z, 0, 0) */
  UndisturbedFlow
  simple_shear(double rate = 1.);

  /** rate (x, 0, -z) */
  UndisturbedFlow
  planar_extension(double rate = 1.);

  /** rate (x, -y/2, -z/2) */
  UndisturbedFlow
  uniaxial_extension(double rate = 1.);

  /** (rate/2 (H - z^2/H), 0, 0): at rest where |z| = H = half_width, where its shear rate is -+ rate. */
  UndisturbedFlow
  plane_poiseuille(double half_width, double rate = 1.);

  /** A flow that swings, cos(frequency t) times its amplitude; frequency 0: a steady one. */
  struct FlowInTime
  {
    UndisturbedFlow amplitude;
    double          frequency = 0.; // radians per unit of time

    UndisturbedFlow
    at(double time) const;
  };
} // namespace tanktread

#endif
