// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: between the control points of one shell and its points in the fluid.

#ifndef tanktread_coupling_shell_transfer_h
#define tanktread_coupling_shell_transfer_h

#include <tanktread/base/vector4.h>
#include <tanktread/coupling/vertex_averages.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/fluid/undisturbed_flow.h>
#include <tanktread/shell/shell_configuration.h>

#include <vector>

namespace tanktread
{
  /** Velocity gradients at a shell's points on this rank, one row each: entry 3 c + d is du_c/dx_d. */
  using VelocityGradients = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

  /** grad u_inf at the mean of the control points. */
  Eigen::Matrix3d
  gradient_at_middle(const UndisturbedFlow &flow, const ControlPoints &x);

  /**
   * With X_q = S x the coupling's points of a shell and W their weights: the sums S^T W over the points of this rank, and the values S at them. The points of
   * all shells are numbered one shell after the other; arrays of
   * values at points hold those of all shells on this rank, in that order.
   */
  class ShellTransfer
  {
  public:
    /** Keeps `capsule` by reference. @param first number of the first point. */
    ShellTransfer(const Capsule &capsule, unsigned int first);

    /** To be called when the points have been found in the mesh; `shell` gives their positions. */
    void
    move(const std::shared_ptr<const ShellConfiguration> &shell, const PointInterpolation &points);

    const Capsule &
    capsule() const
    {
      return capsule_;
    }
    const ShellConfiguration &
    shell() const
    {
      return *shell_;
    }
    const std::shared_ptr<const ShellConfiguration> &
    shell_pointer() const
    {
      return shell_;
    }
    /** Entries of this shell among the points of all shells on this rank. */
    const PointRange &
    range() const
    {
      return range_;
    }
    unsigned int
    first() const
    {
      return first_;
    }

    /** forces[3 r + c] = w_q (S density)_q,c at the points of this shell. */
    void
    set_point_forces(const ControlPoints &density, std::vector<double> &forces) const;

    /** moments += S^T W values, the points of this rank. @param moments NP x 3, by rows. */
    void
    add_moments(const std::vector<double> &values, double *moments) const;

    /**
     * The load R f + sum_q w_q (S dx)_q . grad Phi(X_q) (S g)_q as point forces and moments (PointInterpolation::add_load()), for f and g given by their
     * densities: the second term is the change of R f0, g = M^{-1} f0, when the
     * shell moves by dx.
     */
    void
    set_point_moments(const ControlPoints &density, const ControlPoints &g, const ControlPoints &dx, std::vector<double> &forces, std::vector<double> &moments)
      const;

    /** Gradients of this shell's points out of those of all points. */
    VelocityGradients
    gradients(const std::vector<double> &of_all_points) const;

    /** Those of the undisturbed flow where `shell` has these points. */
    VelocityGradients
    gradients(const UndisturbedFlow &flow, const ShellConfiguration &shell) const;

    /** values[3 r + c] += the quadratic part of the flow where `shell` has these points. */
    void
    add_quadratic_velocity(const UndisturbedFlow &flow, const ShellConfiguration &shell, std::vector<double> &values) const;

    /** result += S^T W grad u S of the points of this rank, in the pattern of AssemblyPattern::block_matrix(). */
    void
    add_gradient_matrix(const VelocityGradients &gradients, SparseMatrix &result) const;

    unsigned int
    n_points() const
    {
      return range_.end - range_.begin;
    }

  private:
    /** Local points [begin, end) in one face, consecutive on the shell too. */
    struct FacePoints
    {
      unsigned int face, begin, end;
    };

    void
    add_gradients(const FacePoints &points, const VelocityGradients &gradients, double *matrix_values) const;

    /** Number of a local point on the shell. */
    unsigned int
    point(const unsigned int r) const
    {
      return (*local_)[r] - first_;
    }

    const Capsule                            &capsule_;
    const SubdivisionSurface                 &surface_;
    const unsigned int                        first_;
    std::shared_ptr<const ShellConfiguration> shell_;
    const std::vector<unsigned int>          *local_ = nullptr; // points of all shells on this rank
    PointRange                                range_;
    std::vector<FacePoints>                   local_faces_;
    mutable std::vector<Vector4>              face_; // memory of the calls
  };
} // namespace tanktread

#endif
