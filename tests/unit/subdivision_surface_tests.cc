// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the subdivision surface, its assembly pattern and the matrices on it.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <gtest/gtest.h>

#include "surface_examples.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace
{
  using namespace tanktread;
  using Eigen::Vector2d;
  using Eigen::VectorXd;

  const double sphere_volume = 4. * M_PI / 3.;

  // ----------------------------------------------------------------------------------------------------------- subdivision surface

  TEST(SubdivisionSurface, PartitionOfUnity)
  {
    for (const TriangleMesh &mesh : {icosphere(0), icosphere(2), octahedron(), flipped_icosphere()})
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(12, 1), Derivatives::second);
        const VectorXd           ones = VectorXd::Ones(mesh.vertices.size()), ones_q = VectorXd::Ones(surface.n_points());
        EXPECT_LT((surface.S() * ones - ones_q).cwiseAbs().maxCoeff(), 1e-14);
        for (const LimitMap &D : {surface.S_1(), surface.S_2()})
          EXPECT_LT((D * ones).cwiseAbs().maxCoeff(), 1e-13);
        for (const LimitMap &D : {surface.S_11(), surface.S_12(), surface.S_22()})
          EXPECT_LT((D * ones).cwiseAbs().maxCoeff(), 1e-12);
        EXPECT_NEAR(surface.weights().sum(), 0.5 * surface.n_faces(), 1e-10);
      }
  }

  /** Coordinates of the 12 control points around a regular face in a plane where all triangles are alike: (0,0), (1,0), (0,1) at the face's vertices. */
  std::map<int, Vector2d>
  unfold(const TriangleMesh &mesh, const std::size_t f)
  {
    std::map<int, Vector2d> plane = {{mesh.faces[f][0], {0, 0}}, {mesh.faces[f][1], {1, 0}}, {mesh.faces[f][2], {0, 1}}};
    const auto              core  = plane;
    for (unsigned int sweep = 0; sweep < 4; ++sweep)
      for (const auto &face : mesh.faces)
        for (unsigned int i = 0; i < 3; ++i)
          {
            const int a = face[i], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
            if (core.count(a) + core.count(b) + core.count(c) > 0 && plane.count(a) && plane.count(b) && !plane.count(c))
              for (const auto &neighbour : mesh.faces)
                for (unsigned int j = 0; j < 3; ++j)
                  if (neighbour[j] == b && neighbour[(j + 1) % 3] == a && plane.count(neighbour[(j + 2) % 3]))
                    plane[c] = plane[a] + plane[b] - plane[neighbour[(j + 2) % 3]];
          }
    return plane;
  }

  TEST(SubdivisionSurface, ReproducesPolynomialsOnRegularFaces)
  {
    const TriangleMesh       mesh = icosphere(2);
    const TriangleQuadrature rule = triangle_quadrature(6);
    const SubdivisionSurface surface(mesh, rule, Derivatives::second);
    std::size_t              f = 0; // a face whose vertices all have valence 6: the first 12 vertices are the others
    while (std::min({mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]}) < 12)
      ++f;
    const auto plane = unfold(mesh, f);
    ASSERT_EQ(plane.size(), 12u);
    VectorXd s = VectorXd::Zero(mesh.vertices.size()), t = s, ss = s, st = s, tt = s;
    for (const auto &[v, xi] : plane)
      {
        s[v]  = xi[0];
        t[v]  = xi[1];
        ss[v] = xi[0] * xi[0];
        st[v] = xi[0] * xi[1];
        tt[v] = xi[1] * xi[1];
      }
    for (unsigned int k = 0; k < 6; ++k)
      {
        const unsigned int q   = 6 * f + k;
        const auto         row = [&](const LimitMap &D, const VectorXd &u) { return (D * u)[q]; };
        EXPECT_NEAR(row(surface.S(), s), rule.points(k, 0), 1e-14);
        EXPECT_NEAR(row(surface.S(), t), rule.points(k, 1), 1e-14);
        EXPECT_NEAR(row(surface.S_1(), s), 1., 1e-14);
        EXPECT_NEAR(row(surface.S_1(), t), 0., 1e-14);
        EXPECT_NEAR(row(surface.S_2(), s), 0., 1e-14);
        EXPECT_NEAR(row(surface.S_2(), t), 1., 1e-14);
        EXPECT_NEAR(row(surface.S_1(), ss), 2. * rule.points(k, 0), 1e-14);
        EXPECT_NEAR(row(surface.S_2(), st), rule.points(k, 0), 1e-14);
        const double second[3][3] = {{2, 0, 0}, {0, 1, 0}, {0, 0, 2}};
        for (const auto &[j, u] : std::map<int, const VectorXd *>{{0, &ss}, {1, &st}, {2, &tt}})
          {
            EXPECT_NEAR(row(surface.S_11(), *u), second[j][0], 1e-13);
            EXPECT_NEAR(row(surface.S_12(), *u), second[j][1], 1e-13);
            EXPECT_NEAR(row(surface.S_22(), *u), second[j][2], 1e-13);
          }
      }
  }

  TEST(SubdivisionSurface, DerivativesAreThoseOfTheValuesOnEveryFace)
  {
    const double h = 1e-5;
    for (const TriangleMesh &mesh : {icosphere(0), icosphere(2), octahedron(), flipped_icosphere()})
      for (const unsigned int n : {3, 12})
        {
          const TriangleQuadrature rule = triangle_quadrature(n);
          const auto               at   = [&](const double s, const double t) {
            TriangleQuadrature shifted = rule;
            shifted.points.col(0).array() += s;
            shifted.points.col(1).array() += t;
            return SubdivisionSurface(mesh, shifted, Derivatives::first);
          };
          const SubdivisionSurface surface(mesh, rule, Derivatives::second), right = at(h, 0), left = at(-h, 0), up = at(0, h), down = at(0, -h);
          const double             size = surface.S_1().matrix().norm(), size_2 = surface.S_11().matrix().norm();
          EXPECT_LT(distance((right.S().matrix() - left.S().matrix()) / (2 * h), surface.S_1().matrix()), 1e-8 * size);
          EXPECT_LT(distance((up.S().matrix() - down.S().matrix()) / (2 * h), surface.S_2().matrix()), 1e-8 * size);
          EXPECT_LT(distance((right.S_1().matrix() - left.S_1().matrix()) / (2 * h), surface.S_11().matrix()), 1e-8 * size_2);
          EXPECT_LT(distance((right.S_2().matrix() - left.S_2().matrix()) / (2 * h), surface.S_12().matrix()), 1e-8 * size_2);
          EXPECT_LT(distance((up.S_1().matrix() - down.S_1().matrix()) / (2 * h), surface.S_12().matrix()), 1e-8 * size_2);
          EXPECT_LT(distance((up.S_2().matrix() - down.S_2().matrix()) / (2 * h), surface.S_22().matrix()), 1e-8 * size_2);
        }
  }

  TEST(SubdivisionSurface, RefinedMeshGivesTheSameSurface)
  {
    // In the corner at v0 and in the middle of each face the point xi of the refined face is xi/2 and (1/2, 0) + (-xi_2, xi_1 + xi_2)/2 of the coarse one.
    for (TriangleMesh mesh : {icosphere(1), octahedron(), flipped_icosphere()})
      for (const unsigned int n : {3, 12})
        {
          mesh.vertices[0] *= 1.2;
          const TriangleMesh       fine_mesh = loop_refine(mesh);
          const TriangleQuadrature rule      = triangle_quadrature(n);
          TriangleQuadrature       corner = rule, middle = rule;
          corner.points *= 0.5;
          middle.points.col(0)        = (0.5 - 0.5 * rule.points.col(1).array()).matrix();
          middle.points.col(1)        = 0.5 * rule.points.rowwise().sum();
          const ControlPoints fine    = SubdivisionSurface(fine_mesh, rule, Derivatives::none).S() * positions(fine_mesh);
          const ControlPoints corners = SubdivisionSurface(mesh, corner, Derivatives::none).S() * positions(mesh);
          const ControlPoints middles = SubdivisionSurface(mesh, middle, Derivatives::none).S() * positions(mesh);
          for (std::size_t f = 0; f < mesh.faces.size(); ++f)
            {
              EXPECT_LT((corners.middleRows(f * n, n) - fine.middleRows(4 * f * n, n)).norm(), 1e-14);
              EXPECT_LT((middles.middleRows(f * n, n) - fine.middleRows((4 * f + 3) * n, n)).norm(), 1e-14);
            }
        }
  }

  TEST(SubdivisionSurface, MapsAreTheirStencils)
  {
    for (const TriangleMesh &mesh : {icosphere(2), flipped_icosphere()})
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::second);
        EXPECT_EQ(surface.support_size(), mesh.vertices.size() == 162 && mesh.faces == icosphere(2).faces ? 12u : 16u);
        const ControlPoints x      = random_field(mesh.vertices.size(), 1., 1);
        const LimitMap      maps[] = {surface.S(), surface.S_1(), surface.S_2(), surface.S_11(), surface.S_12(), surface.S_22()};
        const ControlPoints y      = random_field(surface.n_points(), 1., 2);
        for (unsigned int kind = 0; kind < 6; ++kind)
          {
            const ControlPoints wanted = maps[kind] * x;
            EXPECT_LT((maps[kind].matrix() * x - wanted).norm(), 1e-11);
            EXPECT_LT((maps[kind].matrix().transpose() * y - maps[kind].transposed_times(y)).norm(), 1e-11);
            EXPECT_LT((maps[kind] * x.col(1) - wanted.col(1)).norm(), 1e-12);
            EXPECT_LT((maps[kind].transposed_times(y.col(2)) - maps[kind].transposed_times(y).col(2)).norm(), 1e-12);
            for (unsigned int q = 0; q < surface.n_points(); ++q)
              {
                Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
                for (unsigned int i = 0; i < surface.support_size(); ++i)
                  sum += surface.stencils(q)[kind * surface.support_size() + i] * x.row(surface.support(q / 3)[i]);
                ASSERT_LT((sum - wanted.row(q)).norm(), 1e-13);
                ASSERT_LT((maps[kind].at(q, x) - wanted.row(q)).norm(), 1e-13);
              }
          }
      }
  }

  TEST(SubdivisionSurface, RefusesWhatItCannotDo)
  {
    const SubdivisionSurface surface(icosphere(1), triangle_quadrature(3), Derivatives::first);
    EXPECT_THROW(surface.S_11(), std::logic_error);
    EXPECT_THROW(surface.S() * VectorXd::Ones(41), std::logic_error);
    EXPECT_THROW(surface.S().transposed_times(VectorXd::Ones(42)), std::logic_error);
    EXPECT_THROW(mean_curvature(surface, positions(icosphere(1))), std::logic_error);
    EXPECT_THROW(normals(surface, ControlPoints::Zero(42, 3)), NumericalError);
    ControlPoints x = positions(icosphere(1));
    x(7, 0)         = std::nan("");
    EXPECT_THROW(surface_area(surface, x), NumericalError);
    EXPECT_THROW(mass_matrix(surface, VectorXd::Ones(3)), std::logic_error);
  }

  TEST(AssemblyPattern, CouplesPointsThatShareAFace)
  {
    const SubdivisionSurface surface(flipped_icosphere(), triangle_quadrature(3), Derivatives::none);
    const SparseMatrix       mass   = mass_matrix(surface, surface.weights());
    const SparseMatrix       direct = surface.S().matrix().transpose() * surface.weights().asDiagonal() * surface.S().matrix();
    EXPECT_LT(distance(mass, direct), 1e-14);
    const SparseMatrix block = surface.pattern().block_matrix();
    EXPECT_EQ(block.nonZeros(), 9 * mass.nonZeros());
    EXPECT_EQ(block.nonZeros(), surface.pattern().n_block_entries());
    EXPECT_TRUE(block.isCompressed());
    for (int I = 0; I < mass.rows(); ++I)
      for (int c = 0; c < 3; ++c)
        {
          SparseMatrix::InnerIterator b(block, 3 * I + c);
          for (SparseMatrix::InnerIterator a(mass, I); a; ++a)
            for (int d = 0; d < 3; ++d, ++b)
              ASSERT_EQ(b.col(), 3 * a.col() + d);
        }
  }

  TEST(AssemblyPattern, AddsAMatrixForThreeComponents)
  {
    const TriangleMesh       mesh = flipped_icosphere();
    const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::first);
    const ControlPoints      x      = positions(mesh);
    const SparseMatrix       mass   = mass_matrix(surface, area_weights(surface, x));
    SparseMatrix             blocks = volume_hessian(surface, x);
    const ControlPoints      field  = random_field(x.rows(), 1., 3);
    const auto               times  = [](const SparseMatrix &matrix, const ControlPoints &y) {
      const VectorXd product = matrix * Eigen::Map<const VectorXd>(y.data(), y.size());
      return ControlPoints(Eigen::Map<const ControlPoints>(product.data(), y.rows(), 3));
    };
    const ControlPoints before = times(blocks, field);
    add_for_three_components(mass, blocks);
    const ControlPoints wanted = before + mass * field;
    EXPECT_LT((times(blocks, field) - wanted).norm(), 1e-14 * wanted.norm());

    Eigen::Matrix3d components;
    components << 1., 2., 3., -4., 5., 6., 7., -8., 9.;
    SparseMatrix mixed = volume_hessian(surface, x);
    add_for_three_components(mass, mixed, components);
    const ControlPoints wanted_of_mixed = before + mass * field * components.transpose();
    EXPECT_LT((times(mixed, field) - wanted_of_mixed).norm(), 1e-14 * wanted_of_mixed.norm());
    EXPECT_THROW(add_for_three_components(blocks, blocks), std::logic_error);
  }

  // -------------------------------------------------------------------------------------------------------------------- operators

  TEST(SurfaceOperators, MassMatrixIntegrates)
  {
    const FittedShape        capsule = make_capsule({}, 3);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12), Derivatives::first);
    const SparseMatrix       mass = mass_matrix(surface, area_weights(surface, capsule.control_points));
    const VectorXd           ones = VectorXd::Ones(mass.rows()), z = capsule.control_points.col(2);
    EXPECT_NEAR(ones.dot(mass * ones), surface_area(surface, capsule.control_points), 1e-12);
    EXPECT_NEAR(z.dot(mass * z), sphere_volume, 1e-4);
    EXPECT_LT(distance(mass, SparseMatrix(mass.transpose())), 1e-15);
  }

  TEST(SurfaceOperators, LaplaceBeltramiHasTheEigenvaluesOfTheSphere)
  {
    double error[2][6];
    for (unsigned int level = 2; level < 5; ++level)
      {
        const FittedShape        capsule = make_capsule({}, level);
        const ControlPoints     &x       = capsule.control_points;
        const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12), Derivatives::first);
        const SparseMatrix       stiffness = laplace_beltrami(surface, x), mass = mass_matrix(surface, area_weights(surface, x));
        EXPECT_LT((stiffness * VectorXd::Ones(x.rows())).cwiseAbs().maxCoeff(), 1e-13);
        EXPECT_LT(distance(stiffness, SparseMatrix(stiffness.transpose())), 1e-14 * stiffness.norm());
        const ControlPoints X           = x.rowwise().normalized();
        const VectorXd      harmonics[] = {X.col(2), X.col(0).cwiseProduct(X.col(2))};
        for (const int l : {1, 2})
          {
            const VectorXd &Y   = harmonics[l - 1];
            error[l - 1][level] = std::abs(Y.dot(stiffness * Y) / Y.dot(mass * Y) / (l * (l + 1)) - 1.);
          }
      }
    std::printf("Laplace-Beltrami eigenvalue, relative error at 2562 control points: l = 1 %.2e (order %.2f), l = 2 %.2e (order %.2f)\n",
                error[0][4],
                order(error[0][3], error[0][4]),
                error[1][4],
                order(error[1][3], error[1][4]));
    for (const int l : {1, 2})
      {
        EXPECT_LT(error[l - 1][4], 1e-5);
        EXPECT_GT(order(error[l - 1][3], error[l - 1][4]), 1.9);
      }
  }
} // namespace
