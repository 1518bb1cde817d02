// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid beyond the box.

#include <tanktread/solver/unbounded_liquid.h>

namespace tanktread
{
  namespace
  {
    Columns
    columns(const ControlPoints &field)
    {
      Columns result;
      for (unsigned int c = 0; c < 3; ++c)
        {
          result[c].resize(field.rows());
          Eigen::VectorXd::Map(result[c].data(), field.rows()) = field.col(c);
        }
      return result;
    }
  } // namespace


  UnboundedLiquid::UnboundedLiquid(const TaylorHoodSpace &space, const double viscosity_ratio)
    : viscosity_ratio_(viscosity_ratio)
    , faces_(space)
  {}


  void
  UnboundedLiquid::set(const State &state, const ShellConfigurations &shells, const ShellFields &velocities)
  {
    const Columns &places = faces_.places();
    Columns        velocity;
    velocity.fill(std::vector<double>(places[0].size(), 0.));
    for (std::size_t c = 0; c < shells.size(); ++c)
      {
        const CapsuleState  &capsule = state.capsules[c];
        const ControlPoints &v       = shells[c]->volume_gradient();
        const Columns        x       = columns(capsule.x);
        add_stokeslets(x, columns(capsule.force + capsule.pressure_jump * v), places, velocity);
        if (viscosity_ratio_ == 1.)
          continue;
        const Eigen::RowVector3d mean = velocities[c].colwise().mean();
        add_double_layer(x, columns(velocities[c].rowwise() - mean), columns(v), 1. - viscosity_ratio_, places, velocity);
      }
    faces_.set(velocity);
  }
} // namespace tanktread
