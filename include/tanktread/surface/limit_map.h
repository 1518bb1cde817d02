// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a linear map from control points to points of the surface, by stencils that the points of a face share.

#ifndef tanktread_surface_limit_map_h
#define tanktread_surface_limit_map_h

#include <tanktread/surface/types.h>

#include <type_traits>

namespace tanktread
{
  /**
   * S, or a derivative of it: X = S x, n_points x NP. Refers to the stencils of a SubdivisionSurface and is valid as long as that is; as cheap to copy as
   * a pointer.
   */
  class LimitMap
  {
  public:
    /** Where the numbers are: `values` at stencil q is `values + q * stride`, that of face f has the control points `supports + f * n`. */
    struct Stencils
    {
      const double *values;
      const int    *supports;
      unsigned int  stride, n, n_faces, n_points_per_face, n_control_points;
    };

    explicit LimitMap(const Stencils &stencils)
      : stencils_(stencils)
    {}

    /** S x of one or three numbers a control point. Throws std::logic_error if `x` has not n_control_points rows; so do those below. */
    template <typename Derived>
    auto
    operator*(const Eigen::MatrixBase<Derived> &x) const
    {
      const Field<Derived> &in = x.derived(); // no copy of what is one
      Field<Derived>        out(rows(), in.cols());
      apply(in.rows(), in.cols(), in.data(), out.data());
      return out;
    }

    /** S^T y of one or three numbers a point. */
    template <typename Derived>
    auto
    transposed_times(const Eigen::MatrixBase<Derived> &y) const
    {
      const Field<Derived> &in  = y.derived();
      Field<Derived>        out = Field<Derived>::Zero(stencils_.n_control_points, in.cols());
      apply_transposed(in.rows(), in.cols(), in.data(), out.data());
      return out;
    }

    /** One point of S x. */
    Eigen::RowVector3d
    at(unsigned int point, const ControlPoints &x) const;

    /** As a sparse matrix, entries of zero left out. */
    SparseMatrix
    matrix() const;

    Eigen::Index
    rows() const
    {
      return Eigen::Index(stencils_.n_faces) * stencils_.n_points_per_face;
    }

  private:
    template <typename Derived>
    using Field = std::conditional_t<Derived::ColsAtCompileTime == 1, Eigen::VectorXd, ControlPoints>;

    void
    apply(Eigen::Index n_rows, Eigen::Index n_columns, const double *x, double *y) const;
    void
    apply_transposed(Eigen::Index n_rows, Eigen::Index n_columns, const double *y, double *x) const;

    Stencils stencils_;
  };
} // namespace tanktread

#endif
