// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: between the control points of one shell and its points in the fluid.

#include <tanktread/coupling/shell_transfer.h>
#include <tanktread/surface/stencil_products.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace tanktread
{
  namespace
  {
    /** Fields on the control points, evaluated at points of one face at a time. */
    template <unsigned int n_fields>
    class FaceValues
    {
    public:
      /** `memory` for n_fields vectors at each of the control points that a face depends on. */
      FaceValues(const SubdivisionSurface &surface, const std::array<const ControlPoints *, n_fields> &fields, std::vector<Vector4> &memory)
        : surface_(surface)
        , fields_(fields)
        , memory_(memory)
      {
        memory_.resize(n_fields * surface.support_size());
      }

      void
      reinit(const unsigned int face)
      {
        const int *const support = surface_.support(face);
        for (unsigned int i = 0; i < surface_.support_size(); ++i)
          for (unsigned int k = 0; k < n_fields; ++k)
            memory_[n_fields * i + k] = Vector4(fields_[k]->data() + 3 * support[i]);
      }

      /** Values at a quadrature point of the face. */
      std::array<Vector4, n_fields>
      at(const unsigned int q) const
      {
        const double *const           N      = surface_.stencils(q);
        const Vector4 *const          values = memory_.data();
        std::array<Vector4, n_fields> result;
        for (unsigned int i = 0; i < surface_.support_size(); ++i)
          for (unsigned int k = 0; k < n_fields; ++k)
            result[k] += N[i] * values[n_fields * i + k];
        return result;
      }

    private:
      const SubdivisionSurface                         &surface_;
      const std::array<const ControlPoints *, n_fields> fields_;
      std::vector<Vector4>                             &memory_;
    };

  } // namespace


  Eigen::Matrix3d
  gradient_at_middle(const UndisturbedFlow &flow, const ControlPoints &x)
  {
    const Eigen::RowVector3d   centre   = x.colwise().mean();
    const dealii::Tensor<2, 3> gradient = flow.gradient({centre[0], centre[1], centre[2]});
    Eigen::Matrix3d            result;
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int d = 0; d < 3; ++d)
        result(c, d) = gradient[c][d];
    return result;
  }


  ShellTransfer::ShellTransfer(const Capsule &capsule, const unsigned int first)
    : capsule_(capsule)
    , surface_(capsule.coupling_surface())
    , first_(first)
  {}


  void
  ShellTransfer::move(const std::shared_ptr<const ShellConfiguration> &shell, const PointInterpolation &points)
  {
    shell_            = shell;
    local_            = &points.local_points();
    const auto lower  = std::lower_bound(local_->begin(), local_->end(), first_);
    const auto upper  = std::lower_bound(lower, local_->end(), first_ + surface_.n_points());
    range_.begin      = lower - local_->begin();
    range_.end        = upper - local_->begin();
    const auto n_face = surface_.n_points_per_face();
    local_faces_.clear();
    for (unsigned int r = range_.begin; r < range_.end; ++r)
      {
        const unsigned int face = point(r) / n_face;
        if (local_faces_.empty() || local_faces_.back().face != face || point(r) != point(r - 1) + 1)
          local_faces_.push_back({face, r, r});
        ++local_faces_.back().end;
      }
  }


  void
  ShellTransfer::set_point_forces(const ControlPoints &density, std::vector<double> &forces) const
  {
    const unsigned int n = surface_.support_size();
    face_.resize(n);
    for (const auto &[face, begin, end] : local_faces_)
      {
        const int *const support = surface_.support(face);
        for (unsigned int i = 0; i < n; ++i)
          face_[i] = Vector4(density.data() + 3 * std::size_t(support[i]));
        stencil_products({capsule_.weighted_stencil(point(begin)), n, end - begin, n}, face_.data(), &forces[3 * std::size_t(begin)]);
      }
  }


  void
  ShellTransfer::add_moments(const std::vector<double> &values, double *const moments) const
  {
    const unsigned int n = surface_.support_size();
    for (const auto &[face, begin, end] : local_faces_)
      add_transposed_stencil_products({capsule_.weighted_stencil(point(begin)), n, end - begin, n},
                                      &values[3 * std::size_t(begin)],
                                      surface_.support(face),
                                      moments);
  }


  void
  ShellTransfer::set_point_moments(const ControlPoints &density,
                                   const ControlPoints &g,
                                   const ControlPoints &dx,
                                   std::vector<double> &forces,
                                   std::vector<double> &moments) const
  {
    const Eigen::VectorXd &weights = capsule_.weights();
    FaceValues<3>          fields(surface_, {&density, &g, &dx}, face_);
    for (const auto &[face, begin, end] : local_faces_)
      {
        fields.reinit(face);
        for (unsigned int r = begin; r < end; ++r)
          {
            const auto [value, moment, motion] = fields.at(point(r));
            (weights[point(r)] * value).store(&forces[3 * std::size_t(r)]);
            const Vector4 weighted = weights[point(r)] * moment;
            for (unsigned int c = 0; c < 3; ++c)
              (weighted[c] * motion).store(&moments[9 * std::size_t(r) + 3 * c]);
          }
      }
  }


  VelocityGradients
  ShellTransfer::gradients(const std::vector<double> &of_all_points) const
  {
    if (n_points() == 0)
      return VelocityGradients(0, 9);
    return Eigen::Map<const VelocityGradients>(&of_all_points[9 * std::size_t(range_.begin)], n_points(), 9);
  }


  VelocityGradients
  ShellTransfer::gradients(const UndisturbedFlow &flow, const ShellConfiguration &shell) const
  {
    const ControlPoints &X = shell.points();
    VelocityGradients    result(n_points(), 9);
    for (unsigned int r = 0; r < n_points(); ++r)
      {
        const unsigned int         q        = point(range_.begin + r);
        const dealii::Tensor<2, 3> gradient = flow.gradient({X(q, 0), X(q, 1), X(q, 2)});
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int d = 0; d < 3; ++d)
            result(r, 3 * c + d) = gradient[c][d];
      }
    return result;
  }


  void
  ShellTransfer::add_quadratic_velocity(const UndisturbedFlow &flow, const ShellConfiguration &shell, std::vector<double> &values) const
  {
    UndisturbedFlow quadratic;
    quadratic.quadratic    = flow.quadratic;
    const ControlPoints &X = shell.points();
    for (unsigned int r = range_.begin; r < range_.end; ++r)
      {
        const unsigned int         q = point(r);
        const dealii::Tensor<1, 3> u = quadratic.velocity({X(q, 0), X(q, 1), X(q, 2)});
        for (unsigned int c = 0; c < 3; ++c)
          values[3 * std::size_t(r) + c] += u[c];
      }
  }


  void
  ShellTransfer::add_gradients(const FacePoints &points, const VelocityGradients &gradients, double *const matrix_values) const
  {
    const unsigned int     n       = surface_.support_size();
    const AssemblyPattern &pattern = surface_.pattern();
    const int *const support = surface_.support(points.face), *const places = pattern.places(points.face);
    const auto add = [&](const unsigned int i, const unsigned int j, const std::array<Vector4, 3> &block) {
      const int length = pattern.row_length(support[i]);
      double   *entry  = matrix_values + 9 * pattern.row_start(support[i]) + 3 * places[i * n + j];
      for (unsigned int c = 0; c < 3; ++c, entry += 3 * length)
        (Vector4(entry) + block[c]).store(entry);
    };
    face_.clear();
    for (unsigned int r = points.begin; r < points.end; ++r)
      for (unsigned int c = 0; c < 3; ++c)
        face_.push_back(capsule_.weights()[point(r)] * Vector4(&gradients(r - range_.begin, 3 * c)));
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        {
          std::array<Vector4, 3> block;
          for (unsigned int r = points.begin; r < points.end; ++r)
            {
              const double *const N       = surface_.stencils(point(r));
              const double        product = N[i] * N[j];
              for (unsigned int c = 0; c < 3; ++c)
                block[c] += product * face_[3 * (r - points.begin) + c];
            }
          add(i, j, block);
          if (i != j)
            add(j, i, block);
        }
  }


  void
  ShellTransfer::add_gradient_matrix(const VelocityGradients &gradients, SparseMatrix &result) const
  {
    if (gradients.rows() != Eigen::Index(n_points()))
      throw std::logic_error("ShellTransfer: got gradients at " + std::to_string(gradients.rows()) + " points instead of the " + std::to_string(n_points()) +
                             " points of this rank.");
    for (const FacePoints &points : local_faces_)
      add_gradients(points, gradients, result.valuePtr());
  }
} // namespace tanktread
