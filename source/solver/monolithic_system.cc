// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the linear system of a Newton iteration and its preconditioner.

#include <tanktread/solver/monolithic_system.h>

namespace tanktread
{
  ShellFields
  forces(const std::vector<ShellUnknowns> &unknowns)
  {
    ShellFields result;
    for (const ShellUnknowns &of_capsule : unknowns)
      result.push_back(of_capsule.force);
    return result;
  }


  ShellFields
  forces_with_pressure(const std::vector<ShellUnknowns> &unknowns, const LinearisedShells &shells)
  {
    ShellFields result;
    for (unsigned int c = 0; c < shells.size(); ++c)
      result.push_back(unknowns[c].force + unknowns[c].pressure_jump * shells[c].volume_gradient());
    return result;
  }


  void
  MonolithicOperator::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    const Coupling                  &coupling = shells_.coupling();
    const std::vector<ShellUnknowns> unknowns = layout_.unknowns(src);
    ShellFields                      moments, dx;
    {
      const Timings::Scope scope(timings_, "- coupling");
      coupling.extend(forces(unknowns), forces_);
      moments = coupling.velocity_moments(src, forces_);
    }
    {
      const Timings::Scope scope(timings_, "- shell");
      dx = shells_.displacements(moments);
    }
    {
      const Timings::Scope scope(timings_, "- Stokes operator");
      stokes_.vmult(dst, src);
    }
    if (inertia_ != nullptr)
      {
        const Timings::Scope scope(timings_, "- inertia");
        inertia_->add_derivative(src, dst);
      }
    {
      const Timings::Scope scope(timings_, "- coupling");
      ShellFields          force = forces_with_pressure(unknowns, shells_);
      if (shells_.points_move())
        {
          ShellFields density = shells_.densities();
          for (unsigned int c = 0; c < shells_.size(); ++c)
            {
              force[c] *= -1.;
              density[c] *= -1.;
            }
          coupling.spread_with_motion(force, dx, density, dst);
        }
      else
        coupling.spread(-1., force, forces_, dst);
    }
    const Timings::Scope scope(timings_, "- shell");
    for (unsigned int c = 0; c < shells_.size(); ++c)
      layout_.set(dst, c, -shells_[c].flux(moments[c], dx[c]), shells_.damped(c, unknowns[c].force + shells_[c].stiffness_times(dx[c])));
  }


  MonolithicPreconditioner::MonolithicPreconditioner(const StokesPreconditioner &stokes,
                                                     const LinearisedShells     &shells,
                                                     const ShellLayout          &layout,
                                                     const double                volume,
                                                     Timings *const              timings)
    : stokes_(stokes)
    , shells_(shells)
    , layout_(layout)
    , volume_(volume)
    , timings_(timings)
  {
    stokes.space().reinit(loads_);
  }


  void
  MonolithicPreconditioner::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    std::vector<ShellUnknowns> z = layout_.unknowns(src);
    for (ShellUnknowns &of_capsule : z)
      of_capsule.pressure_jump /= -volume_;
    for (unsigned int b = 0; b <= pressure_block; ++b)
      loads_.block(b) = src.block(b);
    {
      const Timings::Scope scope(timings_, "- coupling");
      shells_.coupling().spread_plainly(forces_with_pressure(z, shells_), loads_);
    }
    stokes_.vmult(dst, loads_, timings_);
    for (unsigned int c = 0; c < shells_.size(); ++c)
      layout_.set(dst, c, z[c].pressure_jump, z[c].force);
  }
} // namespace tanktread
