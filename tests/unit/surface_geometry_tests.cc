// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of volume, areas, normals, curvatures, inertia ellipsoid and interior of a surface.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/interior.h>
#include <tanktread/surface/surface_geometry.h>

#include <gtest/gtest.h>

#include "surface_examples.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace
{
  using namespace tanktread;
  using Eigen::Vector3d;
  using Eigen::VectorXd;

  const double sphere_volume = 4. * M_PI / 3.;

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

  /** Two meshes with random deformations of them, coarse enough for a rule with 3 points a face to have errors that one sees. */
  std::vector<std::pair<TriangleMesh, ControlPoints>>
  crumpled_shapes()
  {
    std::vector<std::pair<TriangleMesh, ControlPoints>> result;
    for (const TriangleMesh &mesh : {icosphere(1), flipped_icosphere()})
      result.emplace_back(mesh, positions(mesh) + random_field(mesh.vertices.size(), 0.1, 2));
    return result;
  }

  Eigen::Map<const VectorXd>
  flat(const ControlPoints &x)
  {
    return {x.data(), x.size()};
  }

  TEST(SurfaceGeometry, VolumeDerivatives)
  {
    for (const auto &[mesh, x] : crumpled_shapes())
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::first);
        const ControlPoints      dx       = random_field(x.rows(), 1., 3);
        const ControlPoints      gradient = volume_gradient(surface, x);
        const double             h = 1e-3, V = enclosed_volume(surface, x);
        // V is cubic: the fourth-order difference is exact.
        const auto   volume = [&, &x = x](const double t) { return enclosed_volume(surface, x + t * dx); };
        const double slope  = (8. * (volume(h) - volume(-h)) - (volume(2 * h) - volume(-2 * h))) / (12. * h);
        EXPECT_NEAR(slope, gradient.cwiseProduct(dx).sum(), 1e-11 * V);
        EXPECT_NEAR(gradient.cwiseProduct(x).sum(), 3. * V, 1e-13 * V);
        EXPECT_LT(gradient.colwise().sum().norm(), 1e-13 * gradient.rowwise().norm().sum());
      }
  }

  TEST(SurfaceGeometry, VolumeHessianLeavesOutTheReferencePoint)
  {
    const FittedShape smooth = make_capsule({}, 3);
    auto              shapes = crumpled_shapes();
    shapes.emplace_back(smooth.topology, smooth.control_points);
    for (const auto &[mesh, x] : shapes)
      {
        const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::first);
        const SparseMatrix       hessian = volume_hessian(surface, x);
        EXPECT_LT(distance(hessian, SparseMatrix(hessian.transpose())), 1e-15 * hessian.norm());
        // The gradient is quadratic: the difference is exact. Where the mean of the points stays, what is left out is the same for all of them.
        for (const bool mean_stays : {true, false})
          {
            ControlPoints dx = random_field(x.rows(), 1., 3);
            if (mean_stays)
              dx.rowwise() -= dx.colwise().mean().eval();
            const ControlPoints change  = (volume_gradient(surface, x + dx) - volume_gradient(surface, x - dx)) / 2.;
            const VectorXd      product = hessian * flat(dx);
            ControlPoints       error   = Eigen::Map<const ControlPoints>(product.data(), x.rows(), 3) - change;
            std::printf("volume Hessian beside the gradient's difference, mean %s: %.1e\n", mean_stays ? "stays" : "moves", error.norm() / change.norm());
            EXPECT_LT(error.norm(), 3e-4 * change.norm());
            error.rowwise() -= error.colwise().mean().eval();
            EXPECT_TRUE(!mean_stays || error.norm() < 1e-13 * change.norm()) << error.norm();
          }
      }
  }

  TEST(SurfaceGeometry, DoesNotDependOnTheOrigin)
  {
    for (const auto &[mesh, x] : crumpled_shapes())
      for (const Eigen::RowVector3d &shift : {Eigen::RowVector3d(3.1, -7.7, 1.3), Eigen::RowVector3d(1000., 1000., -1000.)})
        {
          const SubdivisionSurface surface(mesh, triangle_quadrature(3), Derivatives::first);
          const ControlPoints      moved    = x.rowwise() + shift;
          const double             rounding = 1e-15 * (10. + shift.norm()); // of the moved points
          const double             V        = enclosed_volume(surface, x);
          EXPECT_NEAR(enclosed_volume(surface, moved), V, 10. * rounding * V);
          const ControlPoints v = volume_gradient(surface, x), v_moved = volume_gradient(surface, moved);
          EXPECT_LT((v_moved - v).norm(), 10. * rounding * v.norm());
          EXPECT_LT(v_moved.colwise().sum().norm(), 1e-13 * v.rowwise().norm().sum());
          const SparseMatrix H = volume_hessian(surface, x);
          EXPECT_LT(distance(volume_hessian(surface, moved), H), 10. * rounding * H.norm());
          const InertiaEllipsoid e = inertia_ellipsoid(surface, x), e_moved = inertia_ellipsoid(surface, moved);
          for (const auto &[here, there] : {std::pair<double, double>{e.L, e_moved.L}, {e.B, e_moved.B}, {e.W, e_moved.W}})
            EXPECT_NEAR(there, here, 10. * rounding);
          EXPECT_NEAR(e_moved.taylor_parameter, e.taylor_parameter, 10. * rounding);
          EXPECT_NEAR(e_moved.inclination, e.inclination, 100. * rounding); // of a shape that is nearly round
          EXPECT_LT((e_moved.centroid.transpose() - shift - e.centroid.transpose()).norm(), 10. * rounding);
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
} // namespace
