// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how far the shell's material has turned about the capsule, and how far it has turned against the shape.

#ifndef tanktread_simulation_phase_angles_h
#define tanktread_simulation_phase_angles_h

#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/triangle_mesh.h>

#include <array>

namespace tanktread
{
  /**
   * Tank-treading angle alpha, the polar angle in the x-z plane, seen from the centroid, of a marker on the shell, and phase angle delta = alpha - theta -
   * [alpha(0) - theta(0)]
   * with the inclination theta. All in units of pi and continuous in time: a step must not turn the marker by more than pi, nor the shape by more than pi/2.
   *
   * The marker is the vertex that lies furthest along the long axis (along x while the section is round) at the start.
   */
  class PhaseAngles
  {
  public:
    /**
     * Starts at the control points x of `topology`. `theta_over_pi` is not a number while the section is round: then delta counts from the first time that it
     * is one.
     */
    PhaseAngles(const TriangleMesh &topology, const ControlPoints &x, const InertiaEllipsoid &ellipsoid, double theta_over_pi);

    /** As numbers() has told of the same capsule. */
    PhaseAngles(const TriangleMesh &topology, const std::array<double, 4> &numbers);

    /** All that it remembers: the marker, alpha, theta and what delta counts from. */
    std::array<double, 4>
    numbers() const
    {
      return {{double(marker_), alpha_, theta_, offset_}};
    }

    void
    update(const ControlPoints &x, const InertiaEllipsoid &ellipsoid, double theta_over_pi);

    double
    alpha() const
    {
      return alpha_;
    }
    /** Inclination that goes on over many turns. Not a number before it was defined for the first time. */
    double
    theta() const
    {
      return theta_;
    }
    /** Not a number before the inclination was defined for the first time. */
    double
    delta() const
    {
      return alpha_ - theta_ - offset_;
    }

  private:
    double
    marker_angle(const ControlPoints &x, const InertiaEllipsoid &ellipsoid) const;

    SparseMatrix limit_;
    Eigen::Index marker_;
    double       alpha_, theta_, offset_;
  };
} // namespace tanktread

#endif
