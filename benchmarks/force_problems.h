// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: shells with given forces on them, whose flow is measured.

#ifndef tanktread_benchmarks_force_problems_h
#define tanktread_benchmarks_force_problems_h

#include <oracle/given_forces.h>
#include <tanktread/surface/triangle_mesh.h>

#include "capsule_scene.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /** The same limit surface with control points four times as many, `times` times. */
  inline FittedShape
  refined(const FittedShape &coarse, const unsigned int times)
  {
    TriangleMesh mesh = coarse.topology;
    for (Eigen::Index i = 0; i < coarse.control_points.rows(); ++i)
      mesh.vertices[i] = coarse.control_points.row(i);
    for (unsigned int n = 0; n < times; ++n)
      mesh = loop_refine(mesh);
    FittedShape result{mesh, ControlPoints(mesh.vertices.size(), 3)};
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      result.control_points.row(i) = mesh.vertices[i];
    return result;
  }


  /** A sphere that has been sheared for a while; control mesh of level 2. */
  inline FittedShape
  nearly_steady_sphere(const bool bending)
  {
    SceneDescription description = sheared_sphere(32);
    if (!bending)
      description.kinds[0].moduli.bending_modulus = 0.;
    Scene    scene(description, MPI_COMM_WORLD);
    Stepping stepping(scene, 0.2);
    while (stepping.time() < 6. - 1e-9)
      stepping.step();
    return {scene.capsule().topology(), stepping.state().capsules[0].x};
  }


  /** A scene on one control mesh: the shape, where it is, and the nodal forces. */
  struct Problem
  {
    FittedShape                                               shape;
    Eigen::RowVector3d                                        centre = {0.013, 0.031, -0.022};
    double                                                    box;
    int                                                       degree = 0; // of the traction, if the flow is known
    std::function<ControlPoints(const oracle::GivenForces &)> forces;
  };


  /** Waves without a total force. */
  inline ControlPoints
  smooth_forces(const oracle::GivenForces &scene)
  {
    ControlPoints            f    = oracle::waves(scene.X(), 1.5);
    const Eigen::RowVector3d mean = scene.weights().transpose() * f / scene.weights().sum();
    f.rowwise() -= mean;
    return scene.nodal_forces(f);
  }


  /** The coupling's points with second derivatives, which its own surface has with the enriched interface only. */
  inline SubdivisionSurface
  curved_surface(const oracle::GivenForces &scene)
  {
    return {scene.scene.capsule().topology(), *scene.scene.description().kinds[0].coupling_quadrature, Derivatives::second};
  }


  /** Those of a uniform tension 1, 2 kappa_m n. */
  inline ControlPoints
  tension_forces(const oracle::GivenForces &scene)
  {
    const ControlPoints     &x       = scene.state.capsules[0].x;
    const SubdivisionSurface surface = curved_surface(scene);
    const Eigen::VectorXd    kappa   = mean_curvature(surface, x);
    const ControlPoints      normal  = normals(surface, x);
    return scene.nodal_forces(2. * (kappa.asDiagonal() * normal));
  }


  /** Tilted shapes that are not spheres, by name. */
  inline FittedShape
  curved_shape(const std::string &name, const unsigned int level)
  {
    if (name == "steady" || name == "soft")
      {
        static std::map<std::string, FittedShape> known;
        if (known.count(name) == 0)
          known[name] = nearly_steady_sphere(name == "steady");
        return refined(known[name], level - 2);
      }
    CapsuleShapeParameters shape;
    shape.shape        = name == "biconcave" ? Shape::biconcave : name == "oblate" ? Shape::oblate : Shape::ellipsoid;
    shape.axes         = {{name == "ellipsoid3" ? 3. : 2., 1., 1.}};
    shape.aspect_ratio = 0.4;
    shape.inclination  = name == "biconcave" ? 0.2 : 0.15;
    return make_capsule(shape, level);
  }


  inline Problem
  make_problem(const std::string &name, const unsigned int level, const double box)
  {
    Problem result;
    result.box = box;
    if (name != "sphere2" && name != "sphere4" && name != "periodic")
      {
        const std::size_t end = name.find("_tension");
        result.shape          = curved_shape(name.substr(0, end), level);
        result.forces         = end == std::string::npos ? smooth_forces : tension_forces;
        return result;
      }
    const int degree = name == "sphere4" ? 4 : 2;
    result.shape     = make_capsule({}, level);
    result.forces = [degree](const oracle::GivenForces &scene) { return scene.nodal_forces(oracle::exact_on_sphere(scene.X(), scene.centre(), degree).first); };
    if (name == "periodic")
      {
        result.box    = 10.;
        result.centre = {5.013, 5.031, -0.022};
      }
    else
      result.degree = degree;
    return result;
  }


  /** What a shape's curvature has to do with errors on it. */
  struct OfCurvature
  {
    double radius;       // smallest radius of curvature but on the twentieth of the area that is curved most sharply
    double curved_share; // of the squared error: that of the quarter of the area that is curved most sharply
  };


  /** @param squared_errors at the coupling's points. */
  inline OfCurvature
  of_curvature(const oracle::GivenForces &scene, const Eigen::VectorXd &squared_errors)
  {
    const ControlPoints                         &x       = scene.state.capsules[0].x;
    const SubdivisionSurface                     surface = curved_surface(scene);
    const Eigen::VectorXd                        H = mean_curvature(surface, x), K = gaussian_curvature(surface, x);
    std::vector<std::pair<double, Eigen::Index>> sorted;
    for (Eigen::Index q = 0; q < H.size(); ++q)
      sorted.emplace_back(std::abs(H[q]) + std::sqrt(std::max(0., H[q] * H[q] - K[q])), q);
    std::sort(sorted.begin(), sorted.end());

    OfCurvature  result{0., 0.};
    double       passed = 0., all = 0.;
    const double area = scene.weights().sum();
    for (const auto &[kappa, q] : sorted)
      {
        const double error = scene.weights()[q] * squared_errors[q];
        passed += scene.weights()[q];
        all += error;
        if (passed > 0.75 * area)
          result.curved_share += error;
        if (passed <= 0.95 * area)
          result.radius = 1. / kappa;
      }
    result.curved_share /= all;
    return result;
  }
} // namespace tanktread

#endif
