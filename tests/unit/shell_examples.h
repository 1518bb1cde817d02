// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a small shell and the combinations of laws that the tests of the shell layer share.

#ifndef tanktread_tests_shell_examples_h
#define tanktread_tests_shell_examples_h

#include <tanktread/shell/shell.h>
#include <tanktread/surface/capsule_shape.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  inline ControlPoints
  random_field(const Eigen::Index n, const double size, const unsigned int seed)
  {
    std::mt19937                           engine(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return ControlPoints::NullaryExpr(n, 3, [&]() { return uniform(engine); });
  }

  inline Eigen::Map<const Eigen::VectorXd>
  flat(const ControlPoints &x)
  {
    return {x.data(), x.size()};
  }

  inline double
  total(const Shell::Energy &energy)
  {
    return energy.membrane + energy.bending;
  }

  inline double
  order(const double coarse, const double fine)
  {
    return std::log2(std::abs(coarse / fine));
  }

  /** A small capsule: reference is an ellipsoid with 42 control points, the state a random deformation of it. */
  struct Example
  {
    Example()
      : capsule(make_capsule(ellipsoid(), 1))
      , surface(capsule.topology, triangle_quadrature(3), Derivatives::second)
      , x(1.1 * capsule.control_points + random_field(42, 0.06, 1))
    {}

    static CapsuleShapeParameters
    ellipsoid()
    {
      CapsuleShapeParameters shape;
      shape.shape       = Shape::ellipsoid;
      shape.inclination = 0.15;
      return shape;
    }

    Shell
    shell(const ShellParameters &parameters, const ShellModuli &moduli = {1., 0.3}) const
    {
      return Shell(surface, parameters, moduli, capsule.control_points);
    }

    FittedShape        capsule;
    SubdivisionSurface surface;
    ControlPoints      x;
  };

  /** Every law with every reference curvature, with the name of the combination. */
  inline std::vector<std::pair<std::string, ShellParameters>>
  combinations(const BendingForm form)
  {
    std::vector<std::pair<std::string, ShellParameters>> result;
    for (const MembraneLaw law : {MembraneLaw::neo_hookean, MembraneLaw::skalak})
      for (const ReferenceCurvature reference : {ReferenceCurvature::flat, ReferenceCurvature::initial, ReferenceCurvature::value})
        {
          ShellParameters parameters;
          parameters.law                       = law;
          parameters.area_dilatation           = 3.;
          parameters.reference                 = reference;
          parameters.reference_curvature_value = -0.7;
          parameters.form                      = form;
          result.emplace_back("law " + std::to_string(int(law)) + ", reference " + std::to_string(int(reference)) + ", form " + std::to_string(int(form)),
                              parameters);
        }
    return result;
  }
} // namespace tanktread

#endif
