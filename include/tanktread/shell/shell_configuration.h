// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the geometry of a capsule's shell at given control points, computed once.

#ifndef tanktread_shell_shell_configuration_h
#define tanktread_shell_shell_configuration_h

#include <tanktread/shell/capsule.h>
#include <tanktread/surface/closest_point.h>

#include <memory>
#include <optional>
#include <vector>

namespace tanktread
{
  /** One field of nodal vectors for each capsule, NP x 3. */
  using ShellFields = std::vector<ControlPoints>;

  /**
   * The shell of a capsule at control points x. Each quantity is computed when it is asked for first and kept: everything that needs the shell at x shares one
   * object. Not for several threads at once. The members throw
   * NumericalError where the surface is degenerate.
   */
  class ShellConfiguration
  {
  public:
    /** Keeps `capsule` by reference. */
    ShellConfiguration(const Capsule &capsule, ControlPoints x);

    const Capsule &
    capsule() const
    {
      return capsule_;
    }
    /** Control points, NP x 3. */
    const ControlPoints &
    x() const
    {
      return x_;
    }

    /** V. */
    double
    volume() const;
    /** v = dV/dx, NP x 3. */
    const ControlPoints &
    volume_gradient() const;
    /** H_V = d2V/dx2, 3 NP x 3 NP. */
    const SparseMatrix &
    volume_hessian() const;
    /** m = M^{-1} v, NP x 3. */
    const ControlPoints &
    normal_field() const;
    /** m . v */
    double
    normal_square() const;

    /** X, positions of the coupling's points, n_points x 3. */
    const ControlPoints &
    points() const;
    /** Area that each of them stands for. */
    const Eigen::VectorXd &
    point_areas() const;
    /** The surface about each of them. Needs second derivatives. */
    const std::vector<QuadraticPatch> &
    patches() const;

  private:
    const Capsule                                     &capsule_;
    ControlPoints                                      x_;
    mutable std::optional<double>                      volume_;
    mutable std::optional<ControlPoints>               volume_gradient_, normal_field_, points_;
    mutable std::optional<SparseMatrix>                volume_hessian_;
    mutable std::optional<Eigen::VectorXd>             point_areas_;
    mutable std::optional<std::vector<QuadraticPatch>> patches_;
  };

  /** The shells of all capsules at one time. */
  using ShellConfigurations = std::vector<std::shared_ptr<const ShellConfiguration>>;

  /** Those of capsules of one kind with control points x. */
  ShellConfigurations
  shell_configurations(const Capsule &capsule, const ShellFields &x);
} // namespace tanktread

#endif
