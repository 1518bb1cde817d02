// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the shapes of a capsule and of the outline of one.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/contour.h>
#include <tanktread/surface/surface_geometry.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include "surface_examples.h"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{
  using namespace tanktread;
  using Eigen::Vector2d;
  using Eigen::Vector3d;

  const double sphere_volume = 4. * M_PI / 3.;

  // ---------------------------------------------------------------------------------------------------------------------- capsule

  TEST(Capsule, ShapesHaveVolumeAndSymmetry)
  {
    for (const Shape kind : {Shape::sphere, Shape::ellipsoid, Shape::oblate, Shape::biconcave})
      {
        CapsuleShapeParameters shape;
        shape.shape               = kind;
        shape.inclination         = 0.2;
        const FittedShape capsule = make_capsule(shape, 3);
        ASSERT_EQ(capsule.control_points.rows(), 642);
        const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12, 1), Derivatives::first);
        EXPECT_NEAR(enclosed_volume(surface, capsule.control_points), sphere_volume, 1e-12);
        EXPECT_LT(inertia_ellipsoid(surface, capsule.control_points).centroid.norm(), 1e-12);
        EXPECT_NO_THROW(check_closed_surface(limit_mesh(capsule.topology, capsule.control_points), "capsule"));
      }
  }

  TEST(Capsule, LimitSurfaceIsTheShape)
  {
    CapsuleShapeParameters shape;
    shape.shape        = Shape::oblate;
    shape.aspect_ratio = 0.5;
    const double a     = std::cbrt(2.);
    double       error[6];
    for (unsigned int level = 2; level < 5; ++level)
      {
        error[level] = 0;
        for (const double angle : {0., 0.25})
          {
            shape.inclination                = angle;
            const FittedShape        capsule = make_capsule(shape, level);
            const SubdivisionSurface surface(capsule.topology, triangle_quadrature(6), Derivatives::none);
            const ControlPoints      X = surface.S() * capsule.control_points;
            for (Eigen::Index q = 0; q < X.rows(); ++q)
              {
                // undo the turn of +x towards +z
                const double c = std::cos(angle * M_PI), s = std::sin(angle * M_PI);
                const double x = c * X(q, 0) + s * X(q, 2), z = -s * X(q, 0) + c * X(q, 2);
                error[level] = std::max(error[level], std::abs(std::sqrt((x * x + X(q, 1) * X(q, 1)) / (a * a) + 4. * z * z / (a * a)) - 1.));
              }
          }
      }
    std::printf("oblate spheroid b/a = 1/2, largest distance from the shape: %.2e %.2e %.2e (orders %.2f %.2f)\n",
                error[2],
                error[3],
                error[4],
                order(error[2], error[3]),
                order(error[3], error[4]));
    EXPECT_LT(error[4], 2e-5);
    EXPECT_GT(order(error[3], error[4]), 1.9);
  }

  /** Inclination, in units of pi, of the long axis of a capsule's cross-section. */
  double
  long_axis_angle(const CapsuleShapeParameters &shape)
  {
    const FittedShape        capsule = make_capsule(shape, 2);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12), Derivatives::first);
    return inertia_ellipsoid(surface, capsule.control_points).inclination / M_PI;
  }

  TEST(Capsule, InclinesTheAxisThatIsNamed)
  {
    CapsuleShapeParameters shape;
    shape.inclination = 0.15;
    const auto expect = [&shape](const double long_axis, const double symmetry) {
      shape.inclined_axis = InclinedAxis::long_axis;
      EXPECT_NEAR(long_axis_angle(shape), long_axis, 1e-6);
      shape.inclined_axis = InclinedAxis::symmetry;
      EXPECT_NEAR(long_axis_angle(shape), symmetry, 1e-6);
    };
    for (const Shape kind : {Shape::oblate, Shape::biconcave})
      {
        shape.shape = kind;
        expect(0.15, -0.35); // the long axis is across the symmetry axis
      }
    shape.shape = Shape::ellipsoid;
    shape.axes  = {{2., 2., 1.}};
    expect(0.15, -0.35);
    shape.axes = {{1., 2., 2.}};
    expect(0.15, -0.35);
    shape.axes = {{1., 1., 2.}}; // prolate: its symmetry axis is the long one
    expect(0.15, 0.15);
    shape.axes = {{2., 1., 1.}};
    expect(0.15, 0.15);
    for (const std::array<double, 3> &axes : {std::array<double, 3>{{3., 2., 1.}}, {{2., 1., 2.}}}) // none, and y
      {
        shape.axes = axes;
        EXPECT_THROW(shape.check(), InputError);
        shape.inclined_axis = InclinedAxis::long_axis;
        EXPECT_NO_THROW(shape.check());
        shape.inclined_axis = InclinedAxis::symmetry;
      }
    shape.axes          = {{1., 2., 3.}};
    shape.inclined_axis = InclinedAxis::long_axis;
    EXPECT_NEAR(long_axis_angle(shape), 0.15, 1e-6);
  }

  TEST(Capsule, AFileIsTurnedByItsOwnAxes)
  {
    TriangleMesh mesh = icosphere(1);
    std::string  text = "OFF\n42 80 0\n";
    for (const Vector3d &x : mesh.vertices)
      text += std::to_string(2. * x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
    for (const auto &[a, b, c] : mesh.faces)
      text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    CapsuleShapeParameters shape;
    shape.shape       = Shape::file;
    shape.inclination = 0.15;
    shape.file        = write_file("ellipsoid.off", text);
    EXPECT_NEAR(long_axis_angle(shape), 0.15, 1e-4);
    shape.inclined_axis = InclinedAxis::symmetry; // z, across the long axis x
    EXPECT_NEAR(long_axis_angle(shape), -0.35, 1e-4);
  }

  TEST(Capsule, PassesThroughTheVerticesOfAFile)
  {
    TriangleMesh mesh = icosphere(1);
    std::string  text = "OFF\n42 80 0\n";
    char         line[200];
    for (Vector3d &x : mesh.vertices)
      {
        x = Vector3d(3. * x[0] + 1., x[1], 2. * x[2]);
        std::snprintf(line, sizeof(line), "%.17g %.17g %.17g\n", x[0], x[1], x[2]);
        text += line;
      }
    for (const auto &[a, b, c] : mesh.faces)
      text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    CapsuleShapeParameters shape;
    shape.shape                = Shape::file;
    shape.file                 = write_file("capsule.off", text);
    const FittedShape  capsule = make_capsule(shape, 4);
    const TriangleMesh limit   = limit_mesh(capsule.topology, capsule.control_points);
    ASSERT_EQ(limit.vertices.size(), 42u);
    const double factor = (limit.vertices[1] - limit.vertices[0]).norm() / (mesh.vertices[1] - mesh.vertices[0]).norm();
    for (std::size_t v = 1; v < 42; ++v)
      EXPECT_LT((limit.vertices[v] - limit.vertices[0] - factor * (mesh.vertices[v] - mesh.vertices[0])).norm(), 1e-13);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12, 1), Derivatives::first);
    EXPECT_NEAR(enclosed_volume(surface, capsule.control_points), sphere_volume, 1e-12);

    shape.file = write_file("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_THROW(make_capsule(shape, 1), InputError);
  }

  TEST(Capsule, SaysWhenTheShapeIsNotFound)
  {
    CapsuleShapeParameters shape;
    shape.shape = Shape::ellipsoid;
    shape.axes  = {{1e200, 1., 1.}}; // whose square is no number
    try
      {
        make_capsule(shape, 1);
        ADD_FAILURE() << "accepted";
      }
    catch (const NumericalError &error)
      {
        EXPECT_NE(std::string(error.what()).find("conjugate gradients"), std::string::npos) << error.what();
      }
  }

  TEST(Capsule, ParametersAreParsedAndChecked)
  {
    CapsuleShapeParameters   shape;
    dealii::ParameterHandler prm;
    shape.add_parameters(prm);
    prm.parse_input_from_string("set Shape = ellipsoid\nset Axes = 3, 2, 1\nset Inclination = 0.25\nset Inclined axis = symmetry\n"
                                "set Mesh file = a.off\nset Aspect ratio = 0.7\n"
                                "set Stress-free shape = oblate\nset Stress-free aspect ratio = 0.95\nset Prestress = 0.05\n");
    EXPECT_EQ(shape.stress_free, StressFreeShape::oblate);
    EXPECT_EQ(shape.stress_free_aspect_ratio, 0.95);
    EXPECT_EQ(shape.prestress, 0.05);
    EXPECT_EQ(shape.shape, Shape::ellipsoid);
    EXPECT_EQ(shape.axes, (std::array<double, 3>{{3., 2., 1.}}));
    EXPECT_EQ(shape.inclination, 0.25);
    EXPECT_EQ(shape.inclined_axis, InclinedAxis::symmetry);
    EXPECT_THROW(shape.check(), InputError); // three different axes
    shape.inclined_axis = InclinedAxis::long_axis;
    EXPECT_EQ(shape.aspect_ratio, 0.7);
    EXPECT_EQ(shape.file, "a.off");
    EXPECT_NO_THROW(shape.check());
    EXPECT_ANY_THROW(prm.parse_input_from_string("set Axes = 3, 2\nend\n"));
    shape.axes[1] = 0.;
    EXPECT_THROW(shape.check(), InputError);
    shape.shape        = Shape::oblate;
    shape.aspect_ratio = 0.;
    EXPECT_THROW(shape.check(), InputError);
    shape.shape = Shape::file;
    shape.file  = "";
    EXPECT_THROW(shape.check(), InputError);
  }

  // ----------------------------------------------------------------------------------------------------------- stress-free shape

  TEST(StressFreeShape, IsTheInitialOneUnlessAskedFor)
  {
    CapsuleShapeParameters shape;
    shape.shape               = Shape::biconcave;
    shape.inclination         = 0.2;
    const FittedShape capsule = make_capsule(shape, 2);
    EXPECT_EQ((make_stress_free_shape(shape, capsule) - capsule.control_points).norm(), 0.);
    shape.prestress = 0.25;
    EXPECT_LT((1.25 * make_stress_free_shape(shape, capsule) - capsule.control_points).norm(), 1e-14);
  }

  TEST(StressFreeShape, HasTheAreaAndTheAxisOfTheInitialOne)
  {
    for (const Shape kind : {Shape::biconcave, Shape::oblate})
      for (const StressFreeShape rest : {StressFreeShape::sphere, StressFreeShape::oblate})
        {
          CapsuleShapeParameters shape;
          shape.shape                      = kind;
          shape.inclination                = 0.2;
          shape.inclined_axis              = InclinedAxis::symmetry;
          shape.stress_free                = rest;
          shape.stress_free_aspect_ratio   = 0.8;
          const FittedShape        capsule = make_capsule(shape, 3);
          const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12, 1), Derivatives::first);
          const double             area = surface_area(surface, capsule.control_points);
          const ControlPoints      x    = make_stress_free_shape(shape, capsule);
          EXPECT_NEAR(surface_area(surface, x), area, 1e-12 * area);
          const InertiaEllipsoid e = inertia_ellipsoid(surface, x);
          EXPECT_LT(e.centroid.norm(), 1e-12);
          const double ratio = rest == StressFreeShape::sphere ? 1. : 0.8;
          EXPECT_NEAR(e.B / e.L, ratio, 1e-5);
          EXPECT_NEAR(e.W / e.L, 1., 1e-5);
          if (rest == StressFreeShape::oblate)
            {
              EXPECT_NEAR(e.inclination / M_PI, -0.3, 1e-5);
            }
          shape.prestress = 0.1;
          EXPECT_NEAR(surface_area(surface, make_stress_free_shape(shape, capsule)), area / 1.21, 1e-12 * area);
        }
  }

  TEST(StressFreeShape, HasTheSameMaterialPoints)
  {
    // The same spheroid twice; and a sphere whose points are those of the ellipsoid before it was stretched.
    CapsuleShapeParameters shape;
    shape.shape                    = Shape::oblate;
    shape.aspect_ratio             = 0.6;
    shape.inclination              = 0.15;
    shape.stress_free              = StressFreeShape::oblate;
    shape.stress_free_aspect_ratio = 0.6;
    FittedShape capsule            = make_capsule(shape, 2);
    EXPECT_LT((make_stress_free_shape(shape, capsule) - capsule.control_points).norm(), 1e-12);

    shape                           = CapsuleShapeParameters();
    shape.shape                     = Shape::ellipsoid;
    shape.axes                      = {{3., 2., 1.}};
    shape.stress_free               = StressFreeShape::sphere;
    capsule                         = make_capsule(shape, 3);
    const ControlPoints unstretched = capsule.control_points * Eigen::Vector3d(1. / 3., 0.5, 1.).asDiagonal();
    const ControlPoints x           = make_stress_free_shape(shape, capsule);
    EXPECT_LT((x.normalized() - unstretched.normalized()).norm(), 1e-12); // of matrices: up to one factor
  }

  TEST(StressFreeShape, IsChecked)
  {
    CapsuleShapeParameters shape;
    for (const double prestress : {-0.5, 9.1, std::nan("")})
      {
        shape.prestress = prestress;
        EXPECT_THROW(shape.check(), InputError);
      }
    shape.prestress   = 0.05;
    shape.stress_free = StressFreeShape::oblate;
    EXPECT_NO_THROW(shape.check());
    for (const double ratio : {0., 1.1, std::nan("")})
      {
        shape.stress_free_aspect_ratio = ratio;
        EXPECT_THROW(shape.check(), InputError);
      }
    shape.stress_free = StressFreeShape::sphere;
    EXPECT_NO_THROW(shape.check());
    shape.shape = Shape::file;
    shape.file  = "a.off";
    EXPECT_THROW(shape.check(), InputError);
    shape.stress_free = StressFreeShape::initial;
    EXPECT_NO_THROW(shape.check());
  }

  // ---------------------------------------------------------------------------------------------------------------------- contour

  TEST(Contour, IsTheEllipseOfAnEllipsoid)
  {
    CapsuleShapeParameters shape;
    shape.shape                         = Shape::ellipsoid;
    shape.axes                          = {{2., 2., 1.}};
    shape.inclination                   = 0.25;
    const FittedShape           capsule = make_capsule(shape, 4);
    const std::vector<Vector2d> contour = shear_plane_contour(limit_mesh(capsule.topology, capsule.control_points));
    ASSERT_GT(contour.size(), 100u);
    const double a = 2. / std::cbrt(4.), b = 1. / std::cbrt(4.);
    double       area = 0, longest = 0;
    for (std::size_t i = 0; i < contour.size(); ++i)
      {
        const Vector2d &p = contour[i], &q = contour[(i + 1) % contour.size()];
        const double    u = (p[0] + p[1]) / std::sqrt(2.), v = (p[1] - p[0]) / std::sqrt(2.); // along and across the long axis
        EXPECT_NEAR(std::hypot(u / a, v / b), 1., 3e-3);
        area += (p[0] * q[1] - p[1] * q[0]) / 2.;
        longest = std::max(longest, (p - q).norm());
      }
    EXPECT_NEAR(area / (M_PI * a * b), 1., 3e-3);
    EXPECT_LT(longest, 0.15);
  }

  TEST(Contour, TakesVerticesOnThePlaneAndTheLargestLoop)
  {
    TriangleMesh mesh = octahedron(); // four vertices have y = 0
    EXPECT_EQ(shear_plane_contour(mesh).size(), 4u);
    for (Vector3d &x : mesh.vertices)
      x[1] += 0.25;
    const std::vector<Vector2d> small = shear_plane_contour(mesh);
    ASSERT_EQ(small.size(), 4u);
    TriangleMesh two = mesh;
    for (const Vector3d &x : mesh.vertices)
      two.vertices.push_back(3. * x + Vector3d(9, 0, 0));
    for (const auto &[a, b, c] : mesh.faces)
      two.faces.push_back({{a + 6, b + 6, c + 6}});
    for (const Vector2d &p : shear_plane_contour(two))
      EXPECT_GT(p[0], 6.);
    for (Vector3d &x : mesh.vertices)
      x[1] += 10.;
    EXPECT_TRUE(shear_plane_contour(mesh).empty());
  }
} // namespace
