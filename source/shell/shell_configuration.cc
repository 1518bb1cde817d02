// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the geometry of a capsule's shell at given control points, computed once.

#include <tanktread/shell/shell_configuration.h>
#include <tanktread/surface/surface_geometry.h>

#include <utility>

namespace tanktread
{
  namespace
  {
    template <typename Value, typename Make>
    const Value &
    kept(std::optional<Value> &value, const Make &make)
    {
      if (!value)
        value = make();
      return *value;
    }
  } // namespace


  ShellConfiguration::ShellConfiguration(const Capsule &capsule, ControlPoints x)
    : capsule_(capsule)
    , x_(std::move(x))
  {}


  double
  ShellConfiguration::volume() const
  {
    return kept(volume_, [&] { return enclosed_volume(capsule_.surface(), x_); });
  }


  const ControlPoints &
  ShellConfiguration::volume_gradient() const
  {
    return kept(volume_gradient_, [&] { return tanktread::volume_gradient(capsule_.surface(), x_); });
  }


  const SparseMatrix &
  ShellConfiguration::volume_hessian() const
  {
    return kept(volume_hessian_, [&] { return tanktread::volume_hessian(capsule_.surface(), x_); });
  }


  const ControlPoints &
  ShellConfiguration::normal_field() const
  {
    return kept(normal_field_, [&] { return capsule_.density(volume_gradient()); });
  }


  double
  ShellConfiguration::normal_square() const
  {
    return normal_field().cwiseProduct(volume_gradient()).sum();
  }


  const ControlPoints &
  ShellConfiguration::points() const
  {
    return kept(points_, [&]() -> ControlPoints { return capsule_.coupling_surface().S() * x_; });
  }


  const Eigen::VectorXd &
  ShellConfiguration::point_areas() const
  {
    return kept(point_areas_, [&] { return area_weights(capsule_.coupling_surface(), x_); });
  }


  const std::vector<QuadraticPatch> &
  ShellConfiguration::patches() const
  {
    return kept(patches_, [&] { return quadratic_patches(capsule_.coupling_surface(), x_); });
  }


  ShellConfigurations
  shell_configurations(const Capsule &capsule, const ShellFields &x)
  {
    ShellConfigurations result;
    for (const ControlPoints &positions : x)
      result.push_back(std::make_shared<ShellConfiguration>(capsule, positions));
    return result;
  }
} // namespace tanktread
