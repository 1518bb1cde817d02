// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of quadrature rules, triangle meshes, their files and their partition.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/face_partition.h>
#include <tanktread/surface/subdivision_surface.h>
#include <tanktread/surface/triangle_quadrature.h>

#include <gtest/gtest.h>

#include "surface_examples.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace
{
  using namespace tanktread;
  using Eigen::Vector3d;

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

  TEST(LoopRefine, IsUndone)
  {
    for (const TriangleMesh &mesh : {icosphere(0), icosphere(2), octahedron()})
      {
        const TriangleMesh fine   = loop_refine(mesh);
        const auto         coarse = loop_coarsen(fine);
        ASSERT_TRUE(coarse);
        EXPECT_EQ(coarse->faces, mesh.faces);
        EXPECT_EQ(coarse->vertices.size(), mesh.vertices.size());
        const ControlPoints made = loop_subdivision(*coarse) * positions(mesh);
        EXPECT_LT((made - positions(fine)).norm(), 1e-15 * made.norm());
      }
    TriangleMesh other = icosphere(2);
    std::rotate(other.faces[7].begin(), other.faces[7].begin() + 1, other.faces[7].end());
    EXPECT_FALSE(loop_coarsen(other));
    EXPECT_FALSE(loop_coarsen(icosphere(0)));
    EXPECT_FALSE(loop_coarsen(octahedron()));
  }

  /** What is said of the mesh. */
  std::string
  message(const TriangleMesh &mesh)
  {
    try
      {
        check_closed_surface(mesh, "shell.off");
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "accepted";
  }

  /** Of 6 times 6 quadrilaterals, halved. */
  TriangleMesh
  faceted_torus()
  {
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
    return torus;
  }

  TEST(CheckClosedSurface, SaysWhatIsWrong)
  {
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

    const TriangleMesh torus = faceted_torus();
    EXPECT_NE(message(torus).find("handles"), std::string::npos) << message(torus);
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
} // namespace
