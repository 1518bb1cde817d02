// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the initial and the stress-free shape of a capsule, from parameters to control points.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/number_text.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <deal.II/base/parameter_handler.h>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseLU>

#include <cmath>
#include <sstream>
#include <string>

namespace tanktread
{
  namespace
  {
    /** Where the shape has the material point that the unit sphere has at s; not yet scaled or turned. */
    Eigen::Vector3d
    shape_point(const CapsuleShapeParameters &parameters, const Eigen::Vector3d &s)
    {
      switch (parameters.shape)
        {
          case Shape::ellipsoid:
            return {parameters.axes[0] * s[0], parameters.axes[1] * s[1], parameters.axes[2] * s[2]};
          case Shape::oblate:
            return {s[0], s[1], parameters.aspect_ratio * s[2]};
          case Shape::biconcave:
            {
              const double r_2 = s[0] * s[0] + s[1] * s[1];
              return {s[0], s[1], 0.5 * s[2] * (0.2072 + r_2 * (2.0026 - 1.1228 * r_2))};
            }
          default:
            return s;
        }
    }

    /** Whether an ellipsoid is one of revolution about axis i. */
    bool
    is_symmetric_about(const std::array<double, 3> &axes, const unsigned int i)
    {
      return axes[(i + 1) % 3] == axes[(i + 2) % 3];
    }

    /** Whether the axis to incline is z before the turn; it is x otherwise. */
    bool
    inclined_axis_is_z(const CapsuleShapeParameters &parameters)
    {
      const bool symmetry = parameters.inclined_axis == InclinedAxis::symmetry;
      if (parameters.shape != Shape::ellipsoid)
        return symmetry;
      return symmetry ? is_symmetric_about(parameters.axes, 2) : parameters.axes[2] > parameters.axes[0];
    }

    /**
     * Least squares over all points of a fine quadrature, weighted with area on the sphere. The limit surface of the icosphere, projected to the unit sphere,
     * says which point of the shape belongs to which parameter: it is as smooth as the basis at extraordinary vertices.
     */
    ControlPoints
    fit_shape(const CapsuleShapeParameters &parameters, const TriangleMesh &sphere)
    {
      const SubdivisionSurface surface(sphere, triangle_quadrature(12), Derivatives::first);
      ControlPoints            x(sphere.vertices.size(), 3);
      for (Eigen::Index i = 0; i < x.rows(); ++i)
        x.row(i) = sphere.vertices[i];
      const Eigen::VectorXd weights = area_weights(surface, x);
      ControlPoints         wanted  = surface.S() * x;
      for (Eigen::Index q = 0; q < wanted.rows(); ++q)
        wanted.row(q) = weights[q] * shape_point(parameters, wanted.row(q).transpose().normalized());

      const SparseMatrix                                                  mass = mass_matrix(surface, weights);
      Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver(mass);
      solver.setTolerance(1e-15);
      const ControlPoints result = solver.solveWithGuess(surface.S().transposed_times(wanted), x);
      if (solver.info() != Eigen::Success || !result.allFinite())
        throw NumericalError("The control points of the capsule's shape were not found: conjugate gradients stopped at a relative residual of " +
                             number_text(solver.error()) + " after " + std::to_string(solver.iterations()) + " iterations.");
      return result;
    }

    ControlPoints
    interpolate_vertices(const TriangleMesh &mesh)
    {
      ControlPoints vertices(mesh.vertices.size(), 3);
      for (Eigen::Index i = 0; i < vertices.rows(); ++i)
        vertices.row(i) = mesh.vertices[i];
      const Eigen::SparseMatrix<double>            stencils = vertex_limit_stencils(mesh);
      Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(stencils);
      if (solver.info() != Eigen::Success)
        throw InputError("No subdivision surface passes through the vertices of the mesh file.");
      const Eigen::MatrixXd columns = vertices, solution = solver.solve(columns); // SparseLU takes no matrices stored by rows
      const double          error = (stencils * solution - columns).norm();
      if (solver.info() != Eigen::Success || !(error <= 1e-9 * columns.norm()))
        throw InputError("No subdivision surface passes through the vertices of the mesh file: the best one found misses them by " + number_text(error) + ".");
      return solution;
    }

    /** The surface that sizes are measured on. */
    SubdivisionSurface
    measured_surface(const TriangleMesh &topology)
    {
      return {topology, triangle_quadrature(12, 1), Derivatives::first};
    }

    /** Moves the centroid to the origin, turns +x towards +z by `angle`. */
    void
    place(const SubdivisionSurface &surface, const double angle, ControlPoints &x)
    {
      x.rowwise() -= inertia_ellipsoid(surface, x).centroid.transpose();
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
      x                          = (x * turn.transpose()).eval();
    }
  } // namespace


  void
  CapsuleShapeParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::List;
    add_enum_parameter(
      prm,
      "Shape",
      shape,
      {{"sphere", Shape::sphere}, {"ellipsoid", Shape::ellipsoid}, {"oblate", Shape::oblate}, {"biconcave", Shape::biconcave}, {"file", Shape::file}},
      "Initial shape; every shape is scaled to the volume of a sphere, of radius a.");
    prm.add_parameter("Axes", axes, "Ratio of the semi-axes of an ellipsoid along x, y and z, before it is turned.", List(Double(0.), 3, 3));
    prm.add_parameter("Aspect ratio",
                      aspect_ratio,
                      "Semi-axis of an oblate spheroid along z, its axis of symmetry, over those along x and y, before it is turned.",
                      Double(0.));
    prm.add_parameter("Inclination",
                      inclination,
                      "Angle in units of pi of the axis named below to the x axis, in the x-z plane; positive is towards the z axis.");
    add_enum_parameter(
      prm,
      "Inclined axis",
      inclined_axis,
      {{"long", InclinedAxis::long_axis}, {"symmetry", InclinedAxis::symmetry}},
      "Which axis that is. long: the longer one of the cross-section with the plane y = 0. symmetry: the axis of revolution, the short one of an "
      "oblate spheroid or a biconcave disk. With a mesh file the x axis of the file (long) or its z axis (symmetry).");
    add_enum_parameter(
      prm,
      "Stress-free shape",
      stress_free,
      {{"initial", StressFreeShape::initial}, {"sphere", StressFreeShape::sphere}, {"oblate", StressFreeShape::oblate}},
      "Shape in which the membrane (or the shell of finite thickness) is free of stress: the initial one, or a sphere or an oblate spheroid of the same area.");
    prm.add_parameter("Stress-free aspect ratio",
                      stress_free_aspect_ratio,
                      "Semi-axis of the stress-free oblate spheroid along its axis of symmetry over the other two.",
                      Double(0.));
    prm.add_parameter("Prestress",
                      prestress,
                      "Inflation alpha_p: the stress-free shape is smaller than described above by the factor 1/(1 + alpha_p). Negative: the membrane is "
                      "compressed at first.");
    prm.add_parameter("Mesh file", file, "Closed triangle mesh (.off, .obj or .vtk) whose vertices lie on the surface of the capsule, for the shape 'file'.");
  }


  void
  CapsuleShapeParameters::check() const
  {
    for (const double axis : axes)
      if (shape == Shape::ellipsoid && !(axis > 0.))
        throw InputError("Capsule/Axes: got " + std::to_string(axis) + "; every semi-axis has to be positive.");
    if (shape == Shape::oblate && !(aspect_ratio > 0. && aspect_ratio <= 1.))
      throw InputError("Capsule/Aspect ratio: got " + std::to_string(aspect_ratio) + "; an oblate spheroid has one in (0, 1].");
    if (!std::isfinite(inclination))
      throw InputError("Capsule/Inclination: got " + std::to_string(inclination) + "; it has to be a finite number.");
    if (shape == Shape::ellipsoid && inclined_axis == InclinedAxis::symmetry && !is_symmetric_about(axes, 0) && !is_symmetric_about(axes, 2))
      throw InputError(
        "Capsule/Inclined axis: got symmetry; an ellipsoid has an axis of revolution in the x-z plane if two of its axes are equal, y one of them. "
        "Allowed: long");
    if (shape == Shape::file && file.empty())
      throw InputError("Capsule/Mesh file: the shape 'file' needs the name of a mesh file.");
    if (shape == Shape::file && stress_free != StressFreeShape::initial)
      throw InputError("Capsule/Stress-free shape: the points of a mesh file are not known on a sphere or spheroid; allowed with the shape 'file': initial.");
    if (stress_free == StressFreeShape::oblate && !(stress_free_aspect_ratio > 0. && stress_free_aspect_ratio <= 1.))
      throw InputError("Capsule/Stress-free aspect ratio: got " + number_text(stress_free_aspect_ratio) + "; an oblate spheroid has one in (0, 1].");
    if (!(prestress > -0.5 && prestress <= 9.))
      throw InputError("Capsule/Prestress: got " + number_text(prestress) + "; allowed: an inflation above -0.5 and up to 9.");
  }


  double
  CapsuleShapeParameters::turn() const
  {
    return (inclination - (inclined_axis_is_z(*this) ? 0.5 : 0.)) * M_PI;
  }


  TriangleMesh
  read_closed_surface(const std::string &file)
  {
    TriangleMesh result = read_triangle_mesh(file);
    check_closed_surface(result, "Mesh file '" + file + "'");
    return result;
  }


  FittedShape
  make_capsule(const CapsuleShapeParameters &parameters, const unsigned int level)
  {
    parameters.check();
    FittedShape result;
    if (parameters.shape == Shape::file)
      {
        result.topology       = parameters.mesh ? *parameters.mesh : read_closed_surface(parameters.file);
        result.control_points = interpolate_vertices(result.topology);
      }
    else
      {
        result.topology       = icosphere(level);
        result.control_points = fit_shape(parameters, result.topology);
      }
    const SubdivisionSurface surface = measured_surface(result.topology);
    place(surface, parameters.turn(), result.control_points);
    result.control_points *= parameters.size * std::cbrt(4. * M_PI / 3. / enclosed_volume(surface, result.control_points));
    return result;
  }


  ControlPoints
  make_stress_free_shape(const CapsuleShapeParameters &parameters, const FittedShape &initial)
  {
    parameters.check();
    ControlPoints x = initial.control_points;
    if (parameters.stress_free != StressFreeShape::initial)
      {
        CapsuleShapeParameters shape;
        shape.shape                      = parameters.stress_free == StressFreeShape::sphere ? Shape::sphere : Shape::oblate;
        shape.aspect_ratio               = parameters.stress_free_aspect_ratio;
        x                                = fit_shape(shape, initial.topology);
        const SubdivisionSurface surface = measured_surface(initial.topology);
        place(surface, parameters.turn(), x);
        x *= std::sqrt(surface_area(surface, initial.control_points) / surface_area(surface, x));
      }
    return x / (1. + parameters.prestress);
  }


  TriangleMesh
  limit_mesh(const TriangleMesh &topology, const ControlPoints &control_points)
  {
    const ControlPoints limit = vertex_limit_stencils(topology) * control_points;
    TriangleMesh        mesh{std::vector<Eigen::Vector3d>(limit.rows()), topology.faces};
    for (Eigen::Index i = 0; i < limit.rows(); ++i)
      mesh.vertices[i] = limit.row(i);
    return mesh;
  }
} // namespace tanktread
