// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the initial and the stress-free shape of a capsule, from parameters to control points.

#ifndef tanktread_surface_capsule_shape_h
#define tanktread_surface_capsule_shape_h

#include <tanktread/surface/triangle_mesh.h>
#include <tanktread/surface/types.h>

#include <array>
#include <memory>
#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Shapes a capsule can start from; all are scaled to the volume of a sphere. */
  enum class Shape
  {
    sphere,
    ellipsoid,
    oblate,
    biconcave,
    file
  };

  /** Shape of the shell free of stress, up to its size; see make_stress_free_shape(). */
  enum class StressFreeShape
  {
    initial,
    sphere,
    oblate
  };

  /** Which axis of the shape makes the angle `inclination` with the flow direction x. */
  enum class InclinedAxis
  {
    long_axis, // the longer axis of the cross-section with the plane y = 0
    symmetry   // the axis of revolution
  };

  /**
   * The parameters that describe the initial shape of a kind of capsule and the stress-free one.
   *
   * - ellipsoid: semi-axes in the ratio `axes` along x, y, z.
   * - oblate: spheroid with semi-axis b along z and a along x and y, `aspect_ratio` = b/a.
   * - biconcave: (x, y, z) = R (s_x, s_y, s_z (C0 + C1 r^2 + C2 r^4)/2) for s on the unit sphere, r^2 = s_x^2 + s_y^2, C0 = 0.2072, C1 = 2.0026,
   *   C2 = -1.1228; the symmetry axis is z (Evans & Fung 1972; Le 2010).
   * - file: the limit surface through the vertices of a closed triangle mesh; its connectivity is the control mesh.
   *
   * Afterwards the shape is turned about y until the axis that `inclined_axis` names stands at `inclination` (in units of pi) to the x axis, positive towards
   * +z; with the long axis that is the angle which InertiaEllipsoid::inclination measures. These are the axes before the turn:
   *
   * | shape | long_axis | symmetry |
   * |---|---|---|
   * | sphere | x, any would do | z, any would do |
   * | ellipsoid | the longer one of x and z, x if they are equal | the one whose two others are equal, if that is x or z |
   * | oblate, biconcave | x | z |
   * | file | the x axis of the file | the z axis of the file |
   *
   * The two differ by pi/2 for all shapes but prolate ellipsoids, where they are the same.
   */
  struct CapsuleShapeParameters
  {
    Shape                               shape         = Shape::sphere;
    std::array<double, 3>               axes          = {{2., 2., 1.}};
    double                              aspect_ratio  = 0.6;
    double                              inclination   = 0.;
    InclinedAxis                        inclined_axis = InclinedAxis::long_axis;
    std::string                         file;
    std::shared_ptr<const TriangleMesh> mesh;      // contents of `file`; read whenever they are needed where there are none
    double                              size = 1.; // radius of the sphere with the same volume, in a

    StressFreeShape stress_free              = StressFreeShape::initial;
    double          stress_free_aspect_ratio = 0.9;
    double          prestress                = 0.; // alpha_p: how much longer all lengths of the initial shape are than if it had not been inflated

    /** Declares the parameters in the section of `prm` that is open; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /**
     * Throws InputError on values that make no shape, on an axis to incline that the shape does not have, and on a stress-free shape that has no material
     * points.
     */
    void
    check() const;

    /** Angle in radians by which the shape above is turned about y, +x towards +z. */
    double
    turn() const;
  };

  /** Control points and the mesh that connects them. */
  struct FittedShape
  {
    TriangleMesh  topology;
    ControlPoints control_points;
  };

  /** The triangles of a mesh file. Throws what read_triangle_mesh() and check_closed_surface() throw. */
  TriangleMesh
  read_closed_surface(const std::string &file);

  /**
   * Control points whose limit surface is the shape wanted: a least-squares fit of the analytic shape on icosphere(level), or, for Shape::file, the limit
   * surface that passes through the vertices (`level` is not used then). The enclosed volume is 4 pi/3 size^3 by a quadrature with 48 points a face
   * (coarser rules see 1e-5 more or less at level 4, from the faces at extraordinary vertices), its centroid the origin. Throws InputError where check(),
   * read_triangle_mesh() or check_closed_surface() do and where no surface passes through the vertices, NumericalError where the fit does not converge.
   */
  FittedShape
  make_capsule(const CapsuleShapeParameters &parameters, unsigned int level);

  /**
   * Control points of the shell free of stress, for `initial` = make_capsule(parameters, ...): the same material points, on the same control mesh.
   *
   * - initial: the initial shape.
   * - sphere, oblate (a spheroid with `stress_free_aspect_ratio` = b/a): the material point at s on the unit sphere is where the map of that shape has it, the
   *   initial shape where its own has it. The area is that of the initial shape, as in the literature on red cells, where the membrane hardly changes it; the
   *   axis of symmetry is that of the initial shape, the centroid the origin.
   *
   * All of it is smaller by 1/(1 + prestress), about the origin: a capsule that was inflated to the initial shape.
   *
   * Throws InputError where check() does, NumericalError where the fit does not converge.
   */
  ControlPoints
  make_stress_free_shape(const CapsuleShapeParameters &parameters, const FittedShape &initial);

  /** Limit positions of the vertices of a fitted shape, connected as its control mesh: what to draw. */
  TriangleMesh
  limit_mesh(const TriangleMesh &topology, const ControlPoints &control_points);
} // namespace tanktread

#endif
