// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shell and spreading of the shell's forces to the fluid, each the other's adjoint.

#include <tanktread/base/exceptions.h>
#include <tanktread/coupling/coupling.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>

namespace tanktread
{
  namespace
  {
    std::vector<double>
    as_vector(const ControlPoints &values)
    {
      return {values.data(), values.data() + values.size()};
    }
  } // namespace


  Coupling::Coupling(const SubdivisionSurface &surface, Eigen::VectorXd reference_weights)
    : surface_(surface)
    , weights_(std::move(reference_weights))
    , S_transposed_(surface.S().transpose())
    , mass_(mass_matrix(surface, weights_))
    , mass_factorisation_(mass_)
  {
    if (mass_factorisation_.info() != Eigen::Success)
      throw NumericalError("The shell's mass matrix is singular: the control mesh has degenerate faces or too few quadrature points.");
  }


  void
  Coupling::attach(const TaylorHoodSpace &space)
  {
    interpolation_ = std::make_unique<PointInterpolation>(space);
  }


  std::vector<dealii::Point<3>>
  Coupling::points(const ControlPoints &x) const
  {
    const ControlPoints           positions = surface_.S() * x;
    std::vector<dealii::Point<3>> result;
    result.reserve(positions.rows());
    for (Eigen::Index q = 0; q < positions.rows(); ++q)
      result.emplace_back(positions(q, 0), positions(q, 1), positions(q, 2));
    return result;
  }


  void
  Coupling::move(const ControlPoints &x)
  {
    interpolation_->reinit(points(x));
  }


  ControlPoints
  Coupling::moments(const ControlPoints &values) const
  {
    return S_transposed_ * (weights_.asDiagonal() * values);
  }


  ControlPoints
  Coupling::velocity_moments(const FluidBlockVector &u) const
  {
    std::vector<double> values;
    interpolation_->values(u, values);
    return moments(Eigen::Map<const ControlPoints>(values.data(), surface_.n_points(), 3));
  }


  ControlPoints
  Coupling::interpolate(const FluidBlockVector &u) const
  {
    return mass_factorisation_.solve(velocity_moments(u));
  }


  VelocityGradients
  Coupling::velocity_gradients(const FluidBlockVector &u) const
  {
    std::vector<double> values, gradients;
    interpolation_->values_and_gradients(u, values, gradients);
    return Eigen::Map<const VelocityGradients>(gradients.data(), surface_.n_points(), 9);
  }


  ControlPoints
  Coupling::density(const ControlPoints &f) const
  {
    return mass_factorisation_.solve(f);
  }


  void
  Coupling::spread(const ControlPoints &f, FluidBlockVector &load) const
  {
    const ControlPoints forces = weights_.asDiagonal() * (surface_.S() * density(f));
    interpolation_->add_load(as_vector(forces), {}, load);
  }


  void
  Coupling::spread_with_motion(const ControlPoints &f, const ControlPoints &dx, const ControlPoints &g, FluidBlockVector &load) const
  {
    const ControlPoints forces  = weights_.asDiagonal() * (surface_.S() * density(f));
    const ControlPoints density = weights_.asDiagonal() * (surface_.S() * g);
    const ControlPoints motion  = surface_.S() * dx;
    std::vector<double> moments(9 * surface_.n_points());
    for (unsigned int q = 0; q < surface_.n_points(); ++q)
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          moments[9 * q + 3 * c + d] = density(q, c) * motion(q, d);
    interpolation_->add_load(as_vector(forces), moments, load);
  }


  SparseMatrix
  Coupling::gradient_matrix(const VelocityGradients &gradients) const
  {
    const AssemblyPattern &pattern = surface_.pattern();
    const unsigned int     n = surface_.support_size(), n_q = surface_.n_points_per_face();
    SparseMatrix           result = pattern.block_matrix();
    double *const          values = result.valuePtr();
    for (unsigned int face = 0; face < surface_.n_faces(); ++face)
      {
        const int *const support = surface_.support(face), *const places = pattern.places(face);
        for (unsigned int q = face * n_q; q < (face + 1) * n_q; ++q)
          {
            const double *const N = surface_.stencils(q);
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                {
                  const double  weight = weights_[q] * N[i] * N[j];
                  const int     length = pattern.row_length(support[i]);
                  double *const entry  = values + 9 * pattern.row_start(support[i]) + 3 * places[i * n + j];
                  for (unsigned int c = 0; c < 3; ++c)
                    for (unsigned int d = 0; d < 3; ++d)
                      entry[3 * c * length + d] += weight * gradients(q, 3 * c + d);
                }
          }
      }
    return result;
  }


  unsigned int
  coupling_subdivisions(const TriangleMesh &topology, const ControlPoints &x, const unsigned int points_per_face, const double h)
  {
    const SubdivisionSurface surface(topology, triangle_quadrature(points_per_face), Derivatives::first);
    const double             largest = area_weights(surface, x).maxCoeff();
    unsigned int             result  = 0;
    for (double area = largest; area > 0.25 * h * h; area *= 0.25)
      ++result;
    return result;
  }
} // namespace tanktread
