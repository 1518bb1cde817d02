// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the fine mesh that the limit surface is drawn by.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/limit_picture.h>
#include <tanktread/surface/surface_geometry.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include "surface_examples.h"
#include <cmath>

namespace
{
  using namespace tanktread;
  using Eigen::Vector2d;

  /** Coordinates of the corners of the triangles that n subdivisions make of a face, in the order in which they are numbered. */
  std::vector<Vector2d>
  corners(const unsigned int n)
  {
    std::vector<Vector2d> triangles = {{0, 0}, {1, 0}, {0, 1}};
    for (unsigned int l = 0; l < n; ++l)
      {
        std::vector<Vector2d> fine;
        for (std::size_t t = 0; t < triangles.size(); t += 3)
          {
            const Vector2d a = triangles[t], b = triangles[t + 1], c = triangles[t + 2], ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
            fine.insert(fine.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
          }
        triangles = fine;
      }
    return triangles;
  }

  /** The surface at those corners, evaluated patch by patch. */
  SubdivisionSurface
  surface_at(const TriangleMesh &topology, const std::vector<Vector2d> &points)
  {
    TriangleQuadrature at{{Eigen::Index(points.size()), 2}, Eigen::VectorXd::Zero(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i)
      at.points.row(i) = points[i];
    return {topology, at, Derivatives::first};
  }

  std::vector<unsigned int>
  valences(const TriangleMesh &mesh)
  {
    std::vector<unsigned int> result(mesh.vertices.size(), 0);
    for (const auto &face : mesh.faces)
      for (const int vertex : face)
        ++result[vertex];
    return result;
  }

  double
  volume(const std::vector<std::array<int, 3>> &faces, const ControlPoints &x)
  {
    double sum = 0;
    for (const auto &[a, b, c] : faces)
      sum += x.row(a).dot(x.row(b).cross(x.row(c))) / 6.;
    return sum;
  }

  FittedShape
  biconcave(const unsigned int level)
  {
    CapsuleShapeParameters parameters;
    parameters.shape = Shape::biconcave;
    return make_capsule(parameters, level);
  }

  TEST(LimitPicture, PointsAndNormalsAreThoseOfTheLimitSurface)
  {
    for (TriangleMesh mesh : {icosphere(1), octahedron(), flipped_icosphere()})
      for (const unsigned int n : {0, 1, 2, 3})
        {
          for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
            mesh.vertices[i] *= 1. + 0.1 * std::sin(double(3 * i));
          const ControlPoints         x = positions(mesh);
          const LimitPicture          picture(mesh, n);
          const std::vector<Vector2d> points  = corners(n);
          const SubdivisionSurface    surface = surface_at(mesh, points);
          const ControlPoints         X = picture.S() * x, normal = picture.normals(x), wanted = surface.S() * x, wanted_normal = normals(surface, x);
          const auto                  valence    = valences(mesh);
          unsigned int                n_compared = 0;
          ASSERT_EQ(picture.faces().size(), mesh.faces.size() << (2 * n));
          ASSERT_EQ(X.rows(), Eigen::Index(picture.faces().size() / 2 + 2));
          for (std::size_t q = 0; q < 3 * picture.faces().size(); ++q)
            {
              const int vertex = picture.faces()[q / 3][q % 3];
              if (std::size_t(vertex) < valence.size() && valence[vertex] != 6)
                continue; // extraordinary: there the patches end
              ++n_compared;
              ASSERT_LT((X.row(vertex) - wanted.row(q)).norm(), 1e-13);
              ASSERT_LT((normal.row(vertex) - wanted_normal.row(q)).norm(), 1e-12);
            }
          EXPECT_EQ(n_compared > 0, n > 0 || mesh.vertices.size() > 6);
          EXPECT_LT((picture.S() * Eigen::VectorXd::Ones(x.rows()) - Eigen::VectorXd::Ones(X.rows())).cwiseAbs().maxCoeff(), 1e-14);
        }
  }

  TEST(LimitPicture, NormalsAreExactAtExtraordinaryVertices)
  {
    // At the vertices of regular solids they are radial; a linear map L turns them to L^{-T} n.
    Eigen::Matrix3d L;
    L << 1.2, 0.3, -0.1, 0., 0.8, 0.4, 0.2, -0.3, 1.1;
    for (const TriangleMesh &mesh : {icosphere(0), octahedron()})
      for (const unsigned int n : {0, 2})
        {
          const ControlPoints x      = positions(mesh);
          const ControlPoints found  = LimitPicture(mesh, n).normals(x * L.transpose());
          const ControlPoints wanted = (x * L.inverse()).rowwise().normalized();
          EXPECT_LT((found.topRows(x.rows()) - wanted).norm(), 1e-13);
        }
  }

  TEST(LimitPicture, IsAClosedSurfaceWithNormalsOutward)
  {
    const FittedShape shape = biconcave(2);
    for (const unsigned int n : {0, 1, 2, 3})
      {
        const LimitPicture  picture(shape.topology, n);
        const ControlPoints X = picture.S() * shape.control_points, normal = picture.normals(shape.control_points);
        TriangleMesh        mesh{{}, picture.faces()};
        for (Eigen::Index i = 0; i < X.rows(); ++i)
          mesh.vertices.emplace_back(X.row(i));
        EXPECT_NO_THROW(check_closed_surface(mesh, "picture"));
        EXPECT_LT((normal.rowwise().norm() - Eigen::VectorXd::Ones(X.rows())).cwiseAbs().maxCoeff(), 1e-14);
        for (const auto &[a, b, c] : picture.faces())
          for (const int vertex : {a, b, c})
            {
              const Eigen::RowVector3d of_face = (X.row(b) - X.row(a)).cross(X.row(c) - X.row(a)).normalized();
              ASSERT_GT(of_face.dot(normal.row(vertex)), 0.7);
            }
      }
  }

  TEST(LimitPicture, VolumeConvergesWithSecondOrder)
  {
    for (const FittedShape &shape : {biconcave(1), biconcave(2)})
      {
        const double wanted = enclosed_volume(SubdivisionSurface(shape.topology, triangle_quadrature(12, 3), Derivatives::first), shape.control_points);
        double       error[4];
        for (unsigned int n = 0; n < 4; ++n)
          {
            const LimitPicture picture(shape.topology, n);
            error[n] = std::abs(volume(picture.faces(), picture.S() * shape.control_points) - wanted);
          }
        EXPECT_LT(error[3], 3e-3 * wanted);
        EXPECT_NEAR(order(error[1], error[2]), 2., 0.1);
        EXPECT_NEAR(order(error[2], error[3]), 2., 0.05);
      }
  }

  TEST(LimitPicture, RefusesASurfaceWithoutNormals)
  {
    EXPECT_THROW(LimitPicture(octahedron(), 1).normals(ControlPoints::Zero(6, 3)), NumericalError);
  }
} // namespace
