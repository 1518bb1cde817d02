// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what all capsules of a kind have in common, wherever they are and whatever their shape.

#ifndef tanktread_shell_capsule_h
#define tanktread_shell_capsule_h

#include <tanktread/shell/shell.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/mass_inverse.h>

#include <optional>
#include <vector>

namespace tanktread
{
  /** How finely a capsule's shell is integrated. */
  struct CapsuleQuadrature
  {
    TriangleQuadrature mechanics;
    TriangleQuadrature coupling;
    Derivatives        coupling_derivatives = Derivatives::first; // second ones for jumps in cells, and for another viscosity inside
  };

  /**
   * A kind of capsule: its control mesh and initial shape, the limit surface with the points of the mechanics and with those of the coupling, its elasticity,
   * the mass matrix M = S^T W S of the coupling's points with
   * weights W in area of the initial shape, and the volume V0 that it encloses. Nothing of it changes with time; ShellConfiguration is what it makes of control
   * points.
   */
  class Capsule
  {
  public:
    /** @param stress_free control points of the shape without stress; that of `shape` unless given. Throws what SubdivisionSurface and Shell throw. */
    Capsule(FittedShape                         shape,
            const CapsuleQuadrature            &quadrature,
            const ShellParameters              &parameters,
            const ShellModuli                  &moduli,
            const std::optional<ControlPoints> &stress_free = {});

    Capsule(const Capsule &) = delete;
    Capsule &
    operator=(const Capsule &) = delete;

    const TriangleMesh &
    topology() const
    {
      return shape_.topology;
    }
    /** Control points of the initial shape. */
    const ControlPoints &
    initial() const
    {
      return shape_.control_points;
    }
    unsigned int
    n_control_points() const
    {
      return surface_.n_control_points();
    }
    /** With the points of the mechanics, which volume and area are sums over too. */
    const SubdivisionSurface &
    surface() const
    {
      return surface_;
    }
    const Shell &
    shell() const
    {
      return shell_;
    }
    /** With the points at which the shell meets the fluid. */
    const SubdivisionSurface &
    coupling_surface() const
    {
      return coupling_surface_;
    }
    /** Their weights W. */
    const Eigen::VectorXd &
    weights() const
    {
      return weights_;
    }
    /** Row q of W S: what support_size() control points of its face weigh at point q of coupling_surface(). */
    const double *
    weighted_stencil(const unsigned int q) const
    {
      return weighted_stencils_.data() + std::size_t(q) * coupling_surface_.support_size();
    }
    /** M, NP x NP. */
    const SparseMatrix &
    mass() const
    {
      return mass_;
    }
    /** M^{-1} f: control points of the density of nodal forces f, NP x 3. */
    ControlPoints
    density(const ControlPoints &f) const
    {
      ControlPoints result;
      mass_inverse_.solve(f, result);
      return result;
    }
    const MassInverse &
    mass_inverse() const
    {
      return mass_inverse_;
    }
    /** V0. */
    double
    volume() const
    {
      return volume_;
    }

  private:
    FittedShape         shape_;
    SubdivisionSurface  surface_;
    Shell               shell_;
    SubdivisionSurface  coupling_surface_;
    Eigen::VectorXd     weights_;
    std::vector<double> weighted_stencils_;
    SparseMatrix        mass_;
    MassInverse         mass_inverse_;
    double              volume_;
  };
} // namespace tanktread

#endif
