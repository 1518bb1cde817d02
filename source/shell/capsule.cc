// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what all capsules of a kind have in common, wherever they are and whatever their shape.

#include <tanktread/shell/capsule.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <utility>

namespace tanktread
{
  namespace
  {
    Derivatives
    needed_derivatives(const ShellParameters &parameters, const ShellModuli &moduli)
    {
      return moduli.bending_modulus > 0. || parameters.thickness > 0. ? Derivatives::second : Derivatives::first;
    }
    std::vector<double>
    weighted_values(const SubdivisionSurface &surface, const Eigen::VectorXd &weights)
    {
      std::vector<double> result;
      result.reserve(std::size_t(surface.n_points()) * surface.support_size());
      for (unsigned int q = 0; q < surface.n_points(); ++q)
        for (unsigned int i = 0; i < surface.support_size(); ++i)
          result.push_back(weights[q] * surface.stencils(q)[i]);
      return result;
    }
  } // namespace


  Capsule::Capsule(FittedShape                         shape,
                   const CapsuleQuadrature            &quadrature,
                   const ShellParameters              &parameters,
                   const ShellModuli                  &moduli,
                   const std::optional<ControlPoints> &stress_free)
    : shape_(std::move(shape))
    , surface_(shape_.topology, quadrature.mechanics, needed_derivatives(parameters, moduli))
    , shell_(surface_, parameters, moduli, stress_free ? *stress_free : shape_.control_points, shape_.control_points)
    , coupling_surface_(shape_.topology, quadrature.coupling, quadrature.coupling_derivatives)
    , weights_(area_weights(coupling_surface_, shape_.control_points))
    , weighted_stencils_(weighted_values(coupling_surface_, weights_))
    , mass_(mass_matrix(coupling_surface_, weights_))
    , mass_inverse_(mass_)
    , volume_(enclosed_volume(surface_, shape_.control_points))
  {}
} // namespace tanktread
