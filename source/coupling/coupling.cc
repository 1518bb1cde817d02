// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shell and spreading of the shell's forces to the fluid, each the other's adjoint.

#include <deal.II/base/mpi.h>

#include <tanktread/base/vector4.h>
#include <tanktread/coupling/coupling.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <array>
#include <limits>
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


  Coupling::Coupling(const SubdivisionSurface &surface, Eigen::VectorXd reference_weights, const Interface interface)
    : surface_(surface)
    , interface_(interface)
    , weights_(std::move(reference_weights))
    , mass_(mass_matrix(surface, weights_))
    , mass_inverse_(mass_)
  {
    if (interface == Interface::enriched && surface.derivatives() != Derivatives::second)
      throw std::logic_error("The enriched interface needs second derivatives of the coupling's surface.");
  }


  void
  Coupling::attach(const TaylorHoodSpace &space)
  {
    space_         = &space;
    communicator_  = space.mesh.communicator();
    interpolation_ = std::make_unique<PointInterpolation>(space);
    x_.resize(0, 3);
    if (interface_ == Interface::enriched)
      enrichment_ = std::make_unique<JumpEnrichment>(space, contrast_);
    local_faces_.clear();
  }


  void
  Coupling::set_points(const ControlPoints &x, std::vector<dealii::Point<3>> &points) const
  {
    const unsigned int n_q = surface_.n_points_per_face();
    FaceValues<1>      positions(surface_, {&x}, face_);
    points.resize(surface_.n_points());
    for (unsigned int face = 0; face < surface_.n_faces(); ++face)
      {
        positions.reinit(face);
        for (unsigned int q = face * n_q; q < (face + 1) * n_q; ++q)
          {
            const auto value = positions.at(q)[0];
            points[q]        = dealii::Point<3>(value[0], value[1], value[2]);
          }
      }
  }


  std::vector<dealii::Point<3>>
  Coupling::points(const ControlPoints &x) const
  {
    std::vector<dealii::Point<3>> result;
    set_points(x, result);
    return result;
  }


  void
  Coupling::move(const ControlPoints &x, const ControlPoints &volume_gradient)
  {
    x_ = x;
    set_points(x, points_);
    interpolation_->reinit(points_);

    const auto &local = interpolation_->local_points();
    local_faces_.clear();
    for (unsigned int r = 0; r < local.size(); ++r)
      {
        const unsigned int face = local[r] / surface_.n_points_per_face();
        if (local_faces_.empty() || local_faces_.back().face != face)
          local_faces_.push_back({face, r, r});
        ++local_faces_.back().end;
      }
    if (interface_ == Interface::plain)
      return;
    volume_gradient_ = volume_gradient;
    normal_field_    = density(volume_gradient);
    set_point_forces(normal_field_, normal_forces_);
    enrichment_->move(quadratic_patches(surface_, x), area_weights(surface_, x), *interpolation_);
  }


  Viscosity
  Coupling::viscosity(const ControlPoints &x) const
  {
    return ShellViscosity(*space_)(SurfaceDistance(space_->mesh, quadratic_patches(surface_, x)), contrast_.ratio);
  }


  double
  Coupling::distance(const ControlPoints &x) const
  {
    return x_.rows() == x.rows() ? (x - x_).rowwise().norm().maxCoeff() : std::numeric_limits<double>::infinity();
  }


  void
  Coupling::extend(const ControlPoints &f, ExtendedForces &forces) const
  {
    if (interface_ == Interface::plain)
      return;
    mass_inverse_.solve(f, density_);
    set_point_forces(density_, forces.at_points);
    const double factor = normal_field_.cwiseProduct(f).sum() / normal_field_.cwiseProduct(volume_gradient_).sum();
    for (std::size_t i = 0; i < normal_forces_.size(); ++i)
      forces.at_points[i] -= factor * normal_forces_[i];
    enrichment_->extend(forces);
  }


  void
  Coupling::extend_whole(const ControlPoints &f, ExtendedForces &forces) const
  {
    extend(f, forces);
    if (interface_ == Interface::enriched)
      enrichment_->complete(forces);
  }


  void
  Coupling::update_viscous_forces(const FluidBlockVector &fields, const ControlPoints &f)
  {
    if (interface_ == Interface::plain || contrast_.ratio == 1.)
      return;
    ExtendedForces forces;
    extend_whole(f, forces);
    VelocityGradients gradients = velocity_gradients(fields);
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int d = 0; d < 3; ++d)
        gradients.col(3 * c + d).array() += contrast_.flow_gradient(c, d);
    enrichment_->update_viscous_forces(gradients.data(), forces);
  }


  double
  Coupling::undisturbed_work(const ControlPoints &f) const
  {
    if (interface_ == Interface::plain || contrast_.ratio == 1.)
      return 0.;
    ExtendedForces forces;
    extend_whole(f, forces);
    return enrichment_->undisturbed_work(forces);
  }


  ControlPoints
  Coupling::velocity_moments(const FluidBlockVector &fields) const
  {
    return all_moments(fields, nullptr);
  }


  ControlPoints
  Coupling::velocity_moments(const FluidBlockVector &fields, const ExtendedForces &f) const
  {
    return all_moments(fields, &f);
  }


  ControlPoints
  Coupling::all_moments(const FluidBlockVector &fields, const ExtendedForces *const f) const
  {
    interpolation_->values(fields, values_);
    if (interface_ == Interface::plain)
      return sum_moments(values_);

    enriched_values_.assign(values_.size(), 0.);
    enrichment_->add_velocities(fields, f, enriched_values_);
    // The transpose of P takes the multiple of v away that makes the further moments orthogonal to m = M^{-1} v.
    double flux = 0.;
    for (std::size_t i = 0; i < values_.size(); ++i)
      {
        flux += normal_forces_[i] * enriched_values_[i];
        values_[i] += enriched_values_[i];
      }
    MPI_Allreduce(MPI_IN_PLACE, &flux, 1, MPI_DOUBLE, MPI_SUM, communicator_);
    return sum_moments(values_) - flux / normal_field_.cwiseProduct(volume_gradient_).sum() * volume_gradient_;
  }


  ControlPoints
  Coupling::sum_moments(const std::vector<double> &values) const
  {
    const auto        &local  = interpolation_->local_points();
    const unsigned int n      = surface_.support_size();
    ControlPoints      result = ControlPoints::Zero(surface_.n_control_points(), 3);
    for (const auto &[face, begin, end] : local_faces_)
      {
        const int *const support = surface_.support(face);
        face_.clear();
        for (unsigned int r = begin; r < end; ++r)
          face_.push_back(weights_[local[r]] * Vector4(&values[3 * r]));
        for (unsigned int i = 0; i < n; ++i)
          {
            Vector4 sum;
            for (unsigned int r = begin; r < end; ++r)
              sum += surface_.stencils(local[r])[i] * face_[r - begin];
            double *const row = result.data() + 3 * support[i];
            (Vector4(row) + sum).store(row);
          }
      }
    MPI_Allreduce(MPI_IN_PLACE, result.data(), int(result.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    return result;
  }


  ControlPoints
  Coupling::interpolate(const FluidBlockVector &fields) const
  {
    return density(velocity_moments(fields));
  }


  ControlPoints
  Coupling::interpolate(const FluidBlockVector &fields, const ControlPoints &f) const
  {
    ExtendedForces forces;
    extend(f, forces);
    return interpolate(fields, forces);
  }


  ControlPoints
  Coupling::interpolate(const FluidBlockVector &fields, const ExtendedForces &f) const
  {
    return density(velocity_moments(fields, f));
  }


  void
  Coupling::set_point_forces(const ControlPoints &density, std::vector<double> &forces) const
  {
    const auto   &local = interpolation_->local_points();
    FaceValues<1> values(surface_, {&density}, face_);
    forces.resize(3 * local.size());
    for (const auto &[face, begin, end] : local_faces_)
      {
        values.reinit(face);
        for (unsigned int r = begin; r < end; ++r)
          (weights_[local[r]] * values.at(local[r])[0]).store(&forces[3 * r]);
      }
  }


  void
  Coupling::carry_pressure(const ControlPoints &f, VertexSides &sides, FluidBlockVector &fields) const
  {
    if (interface_ == Interface::plain || x_.rows() == 0)
      return;
    ExtendedForces forces;
    extend_whole(f, forces);
    enrichment_->carry_pressure(forces, sides, fields);
  }


  VelocityGradients
  Coupling::velocity_gradients(const FluidBlockVector &u) const
  {
    interpolation_->gradients(u, moments_);
    return Eigen::Map<const VelocityGradients>(moments_.data(), n_local_points(), 9);
  }


  ControlPoints
  Coupling::density(const ControlPoints &f) const
  {
    ControlPoints result;
    mass_inverse_.solve(f, result);
    return result;
  }


  void
  Coupling::spread_plainly(const ControlPoints &f, FluidBlockVector &load) const
  {
    mass_inverse_.solve(f, density_);
    set_point_forces(density_, values_);
    interpolation_->add_load(values_, {}, load);
  }


  void
  Coupling::spread(const ControlPoints &f, FluidBlockVector &load) const
  {
    ExtendedForces forces;
    extend(f, forces);
    spread(1., f, forces, load);
  }


  void
  Coupling::spread(const double factor, const ControlPoints &f, const ExtendedForces &forces, FluidBlockVector &load) const
  {
    spread_plainly(factor * f, load);
    if (interface_ == Interface::enriched)
      enrichment_->add_load(forces, factor, load);
  }


  void
  Coupling::spread_with_motion(const ControlPoints &f, const ControlPoints &dx, const ControlPoints &g, FluidBlockVector &load) const
  {
    if (interface_ == Interface::enriched)
      throw std::logic_error("The enriched interface does not know how its load changes when the points move.");
    mass_inverse_.solve(f, density_);
    const auto   &local = interpolation_->local_points();
    FaceValues<3> fields(surface_, {&density_, &g, &dx}, face_);
    values_.resize(3 * local.size());
    moments_.resize(9 * local.size());
    for (const auto &[face, begin, end] : local_faces_)
      {
        fields.reinit(face);
        for (unsigned int r = begin; r < end; ++r)
          {
            const auto [density, moment, motion] = fields.at(local[r]);
            (weights_[local[r]] * density).store(&values_[3 * r]);
            const Vector4 weighted = weights_[local[r]] * moment;
            for (unsigned int c = 0; c < 3; ++c)
              (weighted[c] * motion).store(&moments_[9 * r + 3 * c]);
          }
      }
    interpolation_->add_load(values_, moments_, load);
  }


  void
  Coupling::add_gradients(const FacePoints &points, const VelocityGradients &gradients, double *const matrix_values) const
  {
    const unsigned int     n       = surface_.support_size();
    const AssemblyPattern &pattern = surface_.pattern();
    const auto            &local   = interpolation_->local_points();
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
        face_.push_back(weights_[local[r]] * Vector4(&gradients(r, 3 * c)));
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        {
          std::array<Vector4, 3> block;
          for (unsigned int r = points.begin; r < points.end; ++r)
            {
              const double *const N       = surface_.stencils(local[r]);
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
  Coupling::gradient_matrix(const VelocityGradients &gradients, SparseMatrix &result) const
  {
    if (gradients.rows() != Eigen::Index(n_local_points()))
      throw std::logic_error("gradient_matrix() got gradients at " + std::to_string(gradients.rows()) + " points instead of the " +
                             std::to_string(n_local_points()) + " points of this rank.");
    if (result.nonZeros() == surface_.pattern().n_block_entries())
      result.coeffs().setZero();
    else
      result = surface_.pattern().block_matrix();
    for (const FacePoints &points : local_faces_)
      add_gradients(points, gradients, result.valuePtr());
    MPI_Allreduce(MPI_IN_PLACE, result.valuePtr(), int(result.nonZeros()), MPI_DOUBLE, MPI_SUM, communicator_);
  }


  TriangleQuadrature
  coupling_quadrature(const TriangleMesh &topology, const ControlPoints &x, const Interface interface, const double h)
  {
    const SubdivisionSurface surface(topology, triangle_quadrature(1), Derivatives::first);
    const double             spacing = interface == Interface::enriched ? 0.3 * h : 0.5 * h;
    const double             wanted  = area_weights(surface, x).maxCoeff() / (spacing * spacing);
    unsigned int             n = 0, n_per_triangle = 3;
    for (unsigned int n_points = 3; n_points < wanted; n_points *= 2)
      {
        n += n_per_triangle == 6;
        n_per_triangle = 9 - n_per_triangle;
      }
    return triangle_quadrature(n_per_triangle, n);
  }
} // namespace tanktread
