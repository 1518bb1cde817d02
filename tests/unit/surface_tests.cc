// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the surface layer.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/contour.h>
#include <tanktread/surface/face_partition.h>
#include <tanktread/surface/interior.h>
#include <tanktread/surface/subdivision_surface.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/surface_operators.h>

#include <deal.II/base/parameter_handler.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>

namespace
{
  using namespace tanktread;
  using Eigen::Vector2d;
  using Eigen::Vector3d;
  using Eigen::VectorXd;

  const double sphere_volume = 4. * M_PI / 3.;

  ControlPoints
  positions(const TriangleMesh &mesh)
  {
    ControlPoints x(mesh.vertices.size(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x.row(i) = mesh.vertices[i];
    return x;
  }

  ControlPoints
  random_field(const Eigen::Index n, const double size, const unsigned int seed)
  {
    std::mt19937                           engine(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return ControlPoints::NullaryExpr(n, 3, [&]() { return uniform(engine); });
  }

  TriangleMesh
  octahedron()
  {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}}, {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}}};
  }

  /** Icosphere with one edge flipped in the midst of vertices of valence 6: valences 5, 6 and 7. */
  TriangleMesh
  flipped_icosphere()
  {
    TriangleMesh                               mesh = icosphere(2);
    std::map<std::pair<int, int>, std::size_t> left;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (unsigned int i = 0; i < 3; ++i)
        left[{mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]}] = f;
    const auto opposite = [](const std::array<int, 3> &face, const int a, const int b) { return face[0] + face[1] + face[2] - a - b; };
    for (const auto &[edge, f] : left)
      if (edge.first > 42 && edge.second > 42)
        {
          const std::size_t g = left.at({edge.second, edge.first});
          const int         c = opposite(mesh.faces[f], edge.first, edge.second), d = opposite(mesh.faces[g], edge.first, edge.second);
          if (c < 12 || d < 12)
            continue;
          mesh.faces[f] = {{edge.first, d, c}};
          mesh.faces[g] = {{edge.second, c, d}};
          break;
        }
    return mesh;
  }

  double
  distance(const SparseMatrix &a, const SparseMatrix &b)
  {
    return SparseMatrix(a - b).norm();
  }

  double
  order(const double coarse, const double fine)
  {
    return std::log2(coarse / fine);
  }

  // ------------------------------------------------------------------------------------------------------------------ quadrature

  TEST(TriangleQuadrature, IsExactToItsDegree)
  {
    const std::map<unsigned int, int> degrees = {{1, 1}, {3, 2}, {6, 4}, {7, 5}, {12, 6}};
    for (const auto &[n, degree] : degrees)
      for (const unsigned int subdivisions : {0, 1, 2})
        {
          const TriangleQuadrature rule = triangle_quadrature(n, subdivisions);
          EXPECT_EQ(rule.weights.size(), Eigen::Index(n << (2 * subdivisions)));
          EXPECT_GT(rule.weights.minCoeff(), 0.);
          EXPECT_GT(rule.points.minCoeff(), 0.);
          EXPECT_LT(rule.points.rowwise().sum().maxCoeff(), 1.);
          for (int i = 0; i <= degree; ++i)
            for (int j = 0; i + j <= degree; ++j)
              {
                const double exact = std::tgamma(i + 1.) * std::tgamma(j + 1.) / std::tgamma(i + j + 3.);
                const double sum   = (rule.points.col(0).array().pow(i) * rule.points.col(1).array().pow(j) * rule.weights.array()).sum();
                EXPECT_NEAR(sum, exact, 1e-15) << n << " points, x^" << i << " y^" << j;
              }
        }
  }

  TEST(TriangleQuadrature, RefusesOtherRules)
  {
    EXPECT_THROW(triangle_quadrature(4), InputError);
    EXPECT_THROW(triangle_quadrature(3, 6), InputError);
  }

  // ---------------------------------------------------------------------------------------------------------------------- meshes

  TEST(Icosphere, IsAnOrientedSphere)
  {
    for (unsigned int level = 0; level < 5; ++level)
      {
        const TriangleMesh mesh = icosphere(level);
        EXPECT_EQ(mesh.vertices.size(), 10 * std::pow(4, level) + 2);
        EXPECT_EQ(mesh.faces.size(), 20 * std::pow(4, level));
        EXPECT_NO_THROW(check_closed_surface(mesh, "icosphere"));
        for (const Vector3d &x : mesh.vertices)
          EXPECT_NEAR(x.norm(), 1., 1e-15);
      }
  }

  TEST(LoopRefine, KeepsTheLimitSurface)
  {
    for (TriangleMesh mesh : {icosphere(0), octahedron(), flipped_icosphere()})
      {
        mesh.vertices.front() *= 1.3;
        const TriangleMesh  fine   = loop_refine(mesh);
        const ControlPoints coarse = vertex_limit_stencils(mesh) * positions(mesh), refined = vertex_limit_stencils(fine) * positions(fine);
        EXPECT_LT((coarse - refined.topRows(coarse.rows())).norm(), 1e-14);
      }
  }

  TEST(CheckClosedSurface, SaysWhatIsWrong)
  {
    const auto message = [](const TriangleMesh &mesh) -> std::string {
      try
        {
          check_closed_surface(mesh, "shell.off");
        }
      catch (const InputError &error)
        {
          return error.what();
        }
      return "accepted";
    };
    const TriangleMesh good = icosphere(1);
    EXPECT_EQ(message(good), "accepted");

    TriangleMesh mesh = good;
    mesh.faces.pop_back();
    EXPECT_NE(message(mesh).find("no second face"), std::string::npos) << message(mesh);
    mesh = good;
    std::swap(mesh.faces[7][0], mesh.faces[7][1]);
    EXPECT_NE(message(mesh).find("same direction"), std::string::npos) << message(mesh);
    mesh = good;
    for (auto &face : mesh.faces)
      std::swap(face[0], face[1]);
    EXPECT_NE(message(mesh).find("enclosed volume"), std::string::npos) << message(mesh);
    mesh = good;
    mesh.vertices.emplace_back(0, 0, 0);
    EXPECT_NE(message(mesh).find("vertex 42 belongs to no face"), std::string::npos) << message(mesh);
    mesh             = good;
    mesh.vertices[5] = mesh.vertices[9];
    EXPECT_NE(message(mesh).find("vertices 5 and 9 have the same position"), std::string::npos) << message(mesh);
    mesh                = good;
    mesh.vertices[3][1] = std::nan("");
    EXPECT_NE(message(mesh).find("vertex 3"), std::string::npos) << message(mesh);
    mesh             = good;
    mesh.faces[4][2] = mesh.faces[4][0];
    EXPECT_NE(message(mesh).find("twice"), std::string::npos) << message(mesh);
    mesh             = good;
    mesh.faces[4][2] = 42;
    EXPECT_NE(message(mesh).find("does not exist"), std::string::npos) << message(mesh);
    EXPECT_NE(message({good.vertices, {}}).find("no faces"), std::string::npos);

    mesh = good;
    for (const Vector3d &x : good.vertices)
      mesh.vertices.push_back(x + Vector3d(5, 0, 0));
    for (const auto &[a, b, c] : good.faces)
      mesh.faces.push_back({{a + 42, b + 42, c + 42}});
    EXPECT_NE(message(mesh).find("several components"), std::string::npos) << message(mesh);
    for (auto &face : mesh.faces) // the two spheres share vertex 0
      for (int &v : face)
        v = v == 42 ? 0 : (v > 42 ? v - 1 : v);
    mesh.vertices.erase(mesh.vertices.begin() + 42);
    EXPECT_NE(message(mesh).find("touches itself at vertex 0"), std::string::npos) << message(mesh);

    TriangleMesh torus;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        {
          const double u = i * M_PI / 3., v = j * M_PI / 3.;
          torus.vertices.emplace_back((2 + std::cos(v)) * std::cos(u), (2 + std::cos(v)) * std::sin(u), std::sin(v));
          const auto id = [](const int k, const int l) { return 6 * (k % 6) + l % 6; };
          torus.faces.push_back({{id(i, j), id(i + 1, j), id(i + 1, j + 1)}});
          torus.faces.push_back({{id(i, j), id(i + 1, j + 1), id(i, j + 1)}});
        }
    EXPECT_NE(message(torus).find("handles"), std::string::npos) << message(torus);
  }

  std::string
  write_file(const std::string &name, const std::string &text)
  {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << text;
    return path;
  }

  TEST(ReadTriangleMesh, ReadsOffAndObj)
  {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1.5e0\n";
    for (const std::string head : {"OFF\n4 4 6\n", "OFF 4 4 0\n# comment\n\n"})
      {
        const TriangleMesh mesh = read_triangle_mesh(write_file("a.off", head + vertices + "3 0 2 1\n3 0 1 3 # last\n3 0 3 2\n3 1 2 3\n"));
        ASSERT_EQ(mesh.faces.size(), 4u);
        EXPECT_EQ(mesh.vertices[3], Vector3d(0, 0, 1.5));
        EXPECT_EQ(mesh.faces[1], (std::array<int, 3>{{0, 1, 3}}));
        EXPECT_NO_THROW(check_closed_surface(mesh, "a.off"));
      }
    const TriangleMesh mesh =
      read_triangle_mesh(write_file("a.obj", "o thing\nv 0 0 0\nv 1 0 0\nvn 1 1 1\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/1 4/2\nf 1//1 4//1 3//1\nf -3 -2 -1\n"));
    ASSERT_EQ(mesh.faces.size(), 4u);
    EXPECT_EQ(mesh.faces[3], (std::array<int, 3>{{1, 2, 3}}));
    EXPECT_NO_THROW(check_closed_surface(mesh, "a.obj"));
  }

  TEST(ReadTriangleMesh, ReadsLegacyVtk)
  {
    const std::string points = "POINTS 4 double\n0 0 0 1 0 0\n0 1 0\n0 0 1.5\nMETADATA\nINFORMATION 0\n\n";
    const std::string cells = "4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n", types = "CELL_TYPES 4\n5\n5\n5\n5\n";
    const std::string split = "5 12\nOFFSETS vtktypeint64\n0 3 6 9 12\nCONNECTIVITY vtktypeint64\n0 2 1 0 1 3 0 3 2\n1 2 3\n";
    const std::string data  = "POINT_DATA 4\nSCALARS POINTS double\nLOOKUP_TABLE default\n1 2 3 4\n";
    for (const std::string &body : {"POLYDATA\n" + points + "POLYGONS " + cells + data,
                                    "POLYDATA\n" + points + "POLYGONS " + split,
                                    "UNSTRUCTURED_GRID\n" + points + "CELLS " + cells + types + data,
                                    "UNSTRUCTURED_GRID\n" + points + "CELLS " + split + types})
      {
        const TriangleMesh mesh = read_triangle_mesh(write_file("a.vtk", "# vtk DataFile Version 5.1\nPOINTS of a title\nASCII\nDATASET " + body));
        ASSERT_EQ(mesh.vertices.size(), 4u) << body;
        ASSERT_EQ(mesh.faces.size(), 4u) << body;
        EXPECT_EQ(mesh.vertices[3], Vector3d(0, 0, 1.5));
        EXPECT_EQ(mesh.faces[1], (std::array<int, 3>{{0, 1, 3}}));
        EXPECT_NO_THROW(check_closed_surface(mesh, "a.vtk"));
      }
  }

  TEST(ReadTriangleMesh, SaysWhereItFails)
  {
    const auto fails = [](const std::string &name, const std::string &text, const std::string &wanted) {
      try
        {
          read_triangle_mesh(write_file(name, text));
          ADD_FAILURE() << "accepted: " << text;
        }
      catch (const InputError &error)
        {
          EXPECT_NE(std::string(error.what()).find(wanted), std::string::npos) << error.what();
        }
    };
    fails("b.off", "4 4 6\n", "line 1");
    fails("b.off", "OFF\n2 1 0\n0 0 0\n", "ends after 1 of 2 vertices");
    fails("b.off", "OFF\n1 1 0\n0 0\n", "line 3");
    fails("b.off", "OFF\n1 1 0\n0 0 0\n4 0 0 0 0\n", "only triangles");
    fails("b.obj", "v 0 0 0\nf 1 1 1 1\n", "line 2");
    fails("b.obj", "f a b c\n", "no vertex number");
    fails("b.stl", "", ".off, .obj or .vtk");
    const std::string head = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n", point = "POINTS 1 float\n0 0 0\n";
    fails("b.vtk", "<VTKFile>\n", "line 1: a legacy VTK file begins");
    fails("b.vtk", "# vtk DataFile Version 3.0\n\nBINARY\n", "line 3: only VTK files in ASCII");
    fails("b.vtk", "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_GRID\n", "line 4: DATASET POLYDATA or");
    fails("b.vtk", head + "POINTS 2 float\n0 0 0\n", "ends where a coordinate is expected");
    fails("b.vtk", head + "POINTS 1 float\n0 zero 0\n", "line 6: 'zero' where a coordinate is expected");
    fails("b.vtk", head + "POINTS -1 float\n", "line 5: -1 where the number of points");
    fails("b.vtk", head + point, "without triangles");
    fails("b.vtk", head + point + "POLYGONS 1 5\n4 0 0 0 0\n", "line 8: a cell with 4 points");
    fails("b.vtk", head + point + "POLYGONS 2 4\nOFFSETS vtktypeint64\n0 4\n", "line 9: a cell that is no triangle");
    fails("b.vtk", head + point + "POLYGONS 2 4\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 0 0 0\n", "three numbers a cell");
    fails("b.vtk", head + point + "LINES 1 3\n2 0 0\n", "LINES: only triangles");
    fails("b.vtk", head + point + "CELLS 1 4\n3 0 0 0\nCELL_TYPES 1\n9\n", "line 10: a cell that is no triangle");
    EXPECT_THROW(read_triangle_mesh("does_not_exist.off"), InputError);
  }

  // ----------------------------------------------------------------------------------------------------------- subdivision surface

  TEST(SubdivisionSurface, PartitionOfUnity)
  {
    for (const TriangleMesh &mesh : {icosphere(0), icosphere(2), octahedron(), flipped_icosphere()})
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(12, 1), Derivatives::second);
        const VectorXd           ones = VectorXd::Ones(mesh.vertices.size()), ones_q = VectorXd::Ones(surface.n_points());
        EXPECT_LT((surface.S() * ones - ones_q).cwiseAbs().maxCoeff(), 1e-14);
        for (const SparseMatrix *D : {&surface.S_1(), &surface.S_2()})
          EXPECT_LT((*D * ones).cwiseAbs().maxCoeff(), 1e-13);
        for (const SparseMatrix *D : {&surface.S_11(), &surface.S_12(), &surface.S_22()})
          EXPECT_LT((*D * ones).cwiseAbs().maxCoeff(), 1e-12);
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
        const auto         row = [&](const SparseMatrix &D, const VectorXd &u) { return D.row(q).dot(u); };
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
          const double             size = surface.S_1().norm(), size_2 = surface.S_11().norm();
          EXPECT_LT(distance((right.S() - left.S()) / (2 * h), surface.S_1()), 1e-8 * size);
          EXPECT_LT(distance((up.S() - down.S()) / (2 * h), surface.S_2()), 1e-8 * size);
          EXPECT_LT(distance((right.S_1() - left.S_1()) / (2 * h), surface.S_11()), 1e-8 * size_2);
          EXPECT_LT(distance((right.S_2() - left.S_2()) / (2 * h), surface.S_12()), 1e-8 * size_2);
          EXPECT_LT(distance((up.S_1() - down.S_1()) / (2 * h), surface.S_12()), 1e-8 * size_2);
          EXPECT_LT(distance((up.S_2() - down.S_2()) / (2 * h), surface.S_22()), 1e-8 * size_2);
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

  TEST(SubdivisionSurface, DenseStencilsAreTheSparseRows)
  {
    for (const TriangleMesh &mesh : {icosphere(2), flipped_icosphere()})
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::second);
        EXPECT_EQ(surface.support_size(), mesh.vertices.size() == 162 && mesh.faces == icosphere(2).faces ? 12u : 16u);
        const ControlPoints x          = random_field(mesh.vertices.size(), 1., 1);
        const SparseMatrix *matrices[] = {&surface.S(), &surface.S_1(), &surface.S_2(), &surface.S_11(), &surface.S_12(), &surface.S_22()};
        for (unsigned int kind = 0; kind < 6; ++kind)
          {
            const ControlPoints wanted = *matrices[kind] * x;
            for (unsigned int q = 0; q < surface.n_points(); ++q)
              {
                Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
                for (unsigned int i = 0; i < surface.support_size(); ++i)
                  sum += surface.stencils(q)[kind * surface.support_size() + i] * x.row(surface.support(q / 3)[i]);
                ASSERT_LT((sum - wanted.row(q)).norm(), 1e-13);
              }
          }
      }
  }

  TEST(SubdivisionSurface, RefusesWhatItCannotDo)
  {
    const SubdivisionSurface surface(icosphere(1), triangle_quadrature(3), Derivatives::first);
    EXPECT_THROW(surface.S_11(), std::logic_error);
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
    const SparseMatrix       direct = surface.S().transpose() * surface.weights().asDiagonal() * surface.S();
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

  // --------------------------------------------------------------------------------------------------------------------- geometry

  TEST(SurfaceGeometry, UnitSphere)
  {
    // The quadrature errors left at the twelve extraordinary vertices scale with the area of their faces.
    for (const unsigned int n : {3, 6, 12})
      {
        double area_error[5], volume_error[5];
        for (unsigned int level = 2; level < 5; ++level)
          {
            const FittedShape        capsule = make_capsule({}, level);
            const SubdivisionSurface surface(capsule.topology, triangle_quadrature(n), Derivatives::first);
            area_error[level]       = std::abs(surface_area(surface, capsule.control_points) / (4. * M_PI) - 1.);
            volume_error[level]     = std::abs(enclosed_volume(surface, capsule.control_points) / sphere_volume - 1.);
            const ControlPoints n_q = normals(surface, capsule.control_points), X = surface.S() * capsule.control_points;
            EXPECT_LT((n_q - X).rowwise().norm().maxCoeff(), 0.1 * std::pow(2., -double(level)));
            EXPECT_NEAR(area_weights(surface, capsule.control_points).sum(), surface_area(surface, capsule.control_points), 1e-12);
          }
        std::printf("sphere, %2u points a face: area error %.2e (order %.2f), volume error %.2e (order %.2f) at 2562 control points\n",
                    n,
                    area_error[4],
                    order(area_error[3], area_error[4]),
                    volume_error[4],
                    order(volume_error[3], volume_error[4]));
        EXPECT_LT(area_error[4], 2e-5);
        EXPECT_LT(volume_error[4], 2e-5);
        EXPECT_GT(order(area_error[3], area_error[4]), 1.9);
        EXPECT_GT(order(volume_error[3], volume_error[4]), 1.9);
      }
  }

  struct CurvatureErrors
  {
    double everywhere, away, largest; // L2 relative to the L2 norm, all over and away from the extraordinary vertices; maximum
  };

  CurvatureErrors
  curvature_errors(const CapsuleShapeParameters &shape, const unsigned int level, const std::function<double(const Vector3d &)> &exact)
  {
    const FittedShape        capsule = make_capsule(shape, level);
    const TriangleMesh       sphere  = icosphere(level);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    const VectorXd           curvature = mean_curvature(surface, capsule.control_points), area = area_weights(surface, capsule.control_points);
    const ControlPoints      s   = (surface.S() * positions(sphere)).rowwise().normalized();
    double                   all = 0, away = 0, norm = 0, largest = 0;
    for (Eigen::Index q = 0; q < area.size(); ++q)
      {
        const double wanted = exact(s.row(q)), error = curvature[q] - wanted;
        double       nearest = 9;
        for (unsigned int v = 0; v < 12; ++v)
          nearest = std::min(nearest, (s.row(q).transpose() - sphere.vertices[v]).norm());
        all += area[q] * error * error;
        away += nearest > 0.3 ? area[q] * error * error : 0.;
        norm += area[q] * wanted * wanted;
        largest = std::max(largest, std::abs(error));
      }
    return {std::sqrt(all / norm), std::sqrt(away / norm), largest};
  }

  void
  expect_curvature_converges(const char *name, const CapsuleShapeParameters &shape, const std::function<double(const Vector3d &)> &exact, const double bound)
  {
    const CurvatureErrors coarse = curvature_errors(shape, 3, exact), fine = curvature_errors(shape, 4, exact), finest = curvature_errors(shape, 5, exact);
    std::printf("mean curvature of the %s, relative L2 error: %.2e %.2e %.2e (orders %.2f %.2f), away from extraordinary vertices %.2e %.2e %.2e "
                "(orders %.2f %.2f), maximum error %.3f %.3f %.3f\n",
                name,
                coarse.everywhere,
                fine.everywhere,
                finest.everywhere,
                order(coarse.everywhere, fine.everywhere),
                order(fine.everywhere, finest.everywhere),
                coarse.away,
                fine.away,
                finest.away,
                order(coarse.away, fine.away),
                order(fine.away, finest.away),
                coarse.largest,
                fine.largest,
                finest.largest);
    EXPECT_LT(fine.everywhere, bound);
    EXPECT_GT(order(coarse.everywhere, fine.everywhere), 1.);
    EXPECT_GT(order(fine.everywhere, finest.everywhere), 1.);
    EXPECT_GT(order(coarse.away, fine.away), 1.8);
    EXPECT_GT(order(fine.away, finest.away), 1.8);
  }

  TEST(SurfaceGeometry, CurvatureOfTheSphereConverges)
  {
    expect_curvature_converges(
      "sphere",
      {},
      [](const Vector3d &) { return -1.; },
      1.5e-3);
  }

  /** Mean and Gaussian curvature (sphere: 1 and 1) of the biconcave disk with R = 1 at r = sin(phi), z = cos(phi) (C0 + C1 r^2 + C2 r^4)/2. */
  std::pair<double, double>
  biconcave_curvature(const double phi)
  {
    const double C0 = 0.2072, C1 = 2.0026, C2 = -1.1228, s = std::sin(phi), c = std::cos(phi);
    const double p = C0 + C1 * s * s + C2 * std::pow(s, 4), p_s = 2 * C1 * s + 4 * C2 * s * s * s, p_ss = 2 * C1 + 12 * C2 * s * s;
    const double z_1 = 0.5 * (-s * p + c * c * p_s), z_2 = 0.5 * (-c * p - 3 * c * s * p_s + c * c * c * p_ss), w = std::hypot(c, z_1);
    const double meridian = (z_1 * -s - c * z_2) / (w * w * w), parallel = s > 1e-9 ? -z_1 / (s * w) : meridian;
    return {(meridian + parallel) / 2., meridian * parallel};
  }

  TEST(SurfaceGeometry, CurvatureOfTheBiconcaveDiskConverges)
  {
    // polar angle of the point, mean curvature, Gaussian curvature; exact values
    const double table[][3] = {{0., -1.899, 3.606201},
                               {0.38976882, -1.8704013, 3.4981983},
                               {0.86526537, -1.614857, 2.58919},
                               {1.0018189, -1.2165344, 1.3852263},
                               {1.0421678, -0.78048574, 0.38207283},
                               {1.0581842, -0.30020683, -0.3564971},
                               {1.075853, 0.32533415, -0.83166043},
                               {1.1080067, 1.2177137, -0.64207519},
                               {1.1636976, 2.0849951, 0.97143001},
                               {1.2032364, 2.1991078, 1.88815},
                               {1.3121299, 1.8313609, 2.3040724},
                               {1.5599133, 2.1881962, 3.3752581}};
    for (const auto &[polar, mean, gaussian] : table)
      {
        double low = 0, high = M_PI / 2;
        while (high - low > 1e-14)
          {
            const double phi = (low + high) / 2, s = std::sin(phi), z = 0.5 * std::cos(phi) * (0.2072 + 2.0026 * s * s - 1.1228 * std::pow(s, 4));
            (std::atan2(s, z) < polar ? low : high) = phi;
          }
        EXPECT_NEAR(biconcave_curvature(low).first, mean, 5e-6);
        EXPECT_NEAR(biconcave_curvature(low).second, gaussian, 5e-6);
      }

    CapsuleShapeParameters shape;
    shape.shape    = Shape::biconcave;
    const double R = std::cbrt(2. / (3. * (0.2072 / 3. + 2. * 2.0026 / 15. - 8. * 1.1228 / 105.)));
    expect_curvature_converges(
      "biconcave disk",
      shape,
      [R](const Vector3d &s) { return -biconcave_curvature(std::acos(std::min(1., std::abs(s[2])))).first / R; },
      5e-3);
  }

  TEST(SurfaceGeometry, GaussBonnet)
  {
    CapsuleShapeParameters shape;
    shape.shape                      = Shape::biconcave;
    const FittedShape        capsule = make_capsule(shape, 4);
    const SubdivisionSurface surface(capsule.topology, triangle_quadrature(3), Derivatives::second);
    const double             total = gaussian_curvature(surface, capsule.control_points).dot(area_weights(surface, capsule.control_points));
    EXPECT_NEAR(total / (4. * M_PI), 1., 1e-4);
  }

  TEST(SurfaceGeometry, VolumeDerivatives)
  {
    for (const TriangleMesh &mesh : {icosphere(1), flipped_icosphere()})
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::first);
        const ControlPoints      x = positions(mesh) + random_field(mesh.vertices.size(), 0.1, 2), dx = random_field(x.rows(), 1., 3);
        const ControlPoints      gradient = volume_gradient(surface, x);
        const double             h = 1e-3, V = enclosed_volume(surface, x);
        // V is cubic: the fourth-order difference is exact.
        const auto   volume = [&](const double t) { return enclosed_volume(surface, x + t * dx); };
        const double slope  = (8. * (volume(h) - volume(-h)) - (volume(2 * h) - volume(-2 * h))) / (12. * h);
        EXPECT_NEAR(slope, gradient.cwiseProduct(dx).sum(), 1e-11 * V);
        EXPECT_NEAR(gradient.cwiseProduct(x).sum(), 3. * V, 1e-13 * V);

        const SparseMatrix  hessian  = volume_hessian(surface, x);
        const ControlPoints change   = (volume_gradient(surface, x + dx) - volume_gradient(surface, x - dx)) / 2.;
        const VectorXd      product  = hessian * Eigen::Map<const VectorXd>(dx.data(), dx.size());
        const VectorXd      expected = Eigen::Map<const VectorXd>(change.data(), change.size());
        EXPECT_LT((product - expected).norm(), 1e-13 * expected.norm());
        EXPECT_LT(distance(hessian, SparseMatrix(hessian.transpose())), 1e-15 * hessian.norm());
      }
  }

  TEST(SurfaceGeometry, InertiaEllipsoid)
  {
    CapsuleShapeParameters shape;
    shape.shape        = Shape::ellipsoid;
    shape.axes         = {{3., 2., 1.}};
    const double scale = 1. / std::cbrt(6.);
    for (const double angle : {0., 0.25, 0.4, 0.5, -0.1, -0.49, 0.8})
      {
        shape.inclination         = angle;
        const FittedShape capsule = make_capsule(shape, 3);
        ControlPoints     x       = capsule.control_points;
        x.rowwise() += Eigen::RowVector3d(0.3, -0.2, 0.1);
        const SubdivisionSurface surface(capsule.topology, triangle_quadrature(12), Derivatives::first);
        const InertiaEllipsoid   e      = inertia_ellipsoid(surface, x);
        const double             folded = angle > 0.5 ? angle - 1. : angle; // in (-1/2, 1/2]
        EXPECT_NEAR(e.L, 3. * scale, 2e-6);
        EXPECT_NEAR(e.B, 1. * scale, 2e-6);
        EXPECT_NEAR(e.W, 2. * scale, 2e-6);
        EXPECT_NEAR(e.taylor_parameter, 0.5, 1e-6);
        EXPECT_NEAR(std::remainder(e.inclination / M_PI - folded, 1.), 0., 1e-6);
        EXPECT_GT(e.inclination, -M_PI / 2.);
        EXPECT_LE(e.inclination, M_PI / 2.);
        EXPECT_LT((e.centroid - Vector3d(0.3, -0.2, 0.1)).norm(), 1e-6);
      }
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

  TEST(Capsule, ParametersAreParsedAndChecked)
  {
    CapsuleShapeParameters   shape;
    dealii::ParameterHandler prm;
    shape.add_parameters(prm);
    prm.parse_input_from_string(
      "subsection Capsule\nset Shape = ellipsoid\nset Axes = 3, 2, 1\nset Inclination = 0.25\nset Inclined axis = symmetry\nset Mesh file = a.off\nset Aspect ratio = 0.7\nend\n");
    EXPECT_EQ(shape.shape, Shape::ellipsoid);
    EXPECT_EQ(shape.axes, (std::array<double, 3>{{3., 2., 1.}}));
    EXPECT_EQ(shape.inclination, 0.25);
    EXPECT_EQ(shape.inclined_axis, InclinedAxis::symmetry);
    EXPECT_THROW(shape.check(), InputError); // three different axes
    shape.inclined_axis = InclinedAxis::long_axis;
    EXPECT_EQ(shape.aspect_ratio, 0.7);
    EXPECT_EQ(shape.file, "a.off");
    EXPECT_NO_THROW(shape.check());
    EXPECT_ANY_THROW(prm.parse_input_from_string("subsection Capsule\nset Axes = 3, 2\nend\n"));
    shape.axes[1] = 0.;
    EXPECT_THROW(shape.check(), InputError);
    shape.shape        = Shape::oblate;
    shape.aspect_ratio = 0.;
    EXPECT_THROW(shape.check(), InputError);
    shape.shape = Shape::file;
    shape.file  = "";
    EXPECT_THROW(shape.check(), InputError);
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

TEST(Interior, AgreesWithTheEllipsoid)
{
  CapsuleShapeParameters parameters;
  parameters.shape               = Shape::ellipsoid;
  parameters.axes                = {{2., 1.5, 1.}};
  const FittedShape        shape = make_capsule(parameters, 3);
  const SubdivisionSurface surface(shape.topology, triangle_quadrature(3), Derivatives::first);
  const Interior           interior(surface, shape.control_points);
  const double             scale  = std::cbrt(1. / 3.);
  const ControlPoints      points = random_field(4000, 1.6, 5);
  unsigned int             inside = 0, checked = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const Vector3d y     = points.row(i);
      const double   level = y.cwiseQuotient(scale * Vector3d(2., 1.5, 1.)).norm();
      if (std::abs(level - 1.) < 2e-3)
        continue;
      ++checked;
      inside += level < 1.;
      EXPECT_EQ(interior.contains(y), level < 1.) << y.transpose() << ", level " << level;
    }
  EXPECT_GT(checked, 3900u);
  EXPECT_GT(inside, 400u);
}

TEST(FacePartition, CoversEveryFaceOnceInEqualParts)
{
  for (const unsigned int level : {2u, 3u})
    for (const unsigned int n_parts : {1u, 2u, 3u, 4u, 7u, 16u})
      {
        const TriangleMesh topology = icosphere(level);
        const auto         parts    = partition_faces(topology, n_parts);
        ASSERT_EQ(parts.size(), n_parts);
        std::vector<unsigned int> times(topology.faces.size(), 0);
        for (const auto &part : parts)
          {
            EXPECT_TRUE(std::is_sorted(part.begin(), part.end()));
            EXPECT_NEAR(part.size() * double(n_parts) / times.size(), 1., 0.1) << n_parts << " parts, level " << level;
            for (const unsigned int face : part)
              ++times[face];
          }
        EXPECT_EQ(times, std::vector<unsigned int>(times.size(), 1));
        EXPECT_EQ(parts, partition_faces(topology, n_parts));
      }
}

TEST(FacePartition, PartsHaveShortBoundaries)
{
  // Halves of a sphere of area 4 pi are divided by a circle of length 2 pi at best; parts taken by face number would have far more edges between them.
  const TriangleMesh                                 topology = icosphere(3);
  const auto                                         parts    = partition_faces(topology, 2);
  std::map<std::set<int>, std::vector<unsigned int>> faces_of_edge;
  for (unsigned int p = 0; p < 2; ++p)
    for (const unsigned int face : parts[p])
      for (unsigned int i = 0; i < 3; ++i)
        faces_of_edge[{topology.faces[face][i], topology.faces[face][(i + 1) % 3]}].push_back(p);
  double length = 0.;
  for (const auto &[edge, p] : faces_of_edge)
    if (p[0] != p[1])
      length += (topology.vertices[*edge.begin()] - topology.vertices[*edge.rbegin()]).norm();
  EXPECT_LT(length, 1.5 * 2. * M_PI);
}

TEST(FacePartition, HandlesMorePartsThanFaces)
{
  const TriangleMesh topology = octahedron();
  EXPECT_THROW(partition_faces(topology, 0), std::logic_error);
  for (const unsigned int n_parts : {8u, 11u})
    {
      const auto parts = partition_faces(topology, n_parts);
      ASSERT_EQ(parts.size(), n_parts);
      for (unsigned int p = 0; p < n_parts; ++p)
        EXPECT_EQ(parts[p], p < 8 ? std::vector<unsigned int>{p} : std::vector<unsigned int>{});
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
