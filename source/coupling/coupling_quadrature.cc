// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many points a shell has in the fluid.

#include <tanktread/coupling/coupling.h>
#include <tanktread/surface/surface_geometry.h>

namespace tanktread
{
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


  CapsuleQuadrature
  capsule_quadrature(const FittedShape &shape, const unsigned int mechanics, const Interface interface, const double h, const double viscosity_ratio)
  {
    return {triangle_quadrature(mechanics),
            coupling_quadrature(shape.topology, shape.control_points, interface, h),
            interface == Interface::enriched || viscosity_ratio != 1. ? Derivatives::second : Derivatives::first};
  }
} // namespace tanktread
