// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the linear system of a Newton iteration and its preconditioner.

#include <tanktread/solver/monolithic_system.h>

namespace tanktread
{
  namespace
  {
    std::vector<double>
    pressure_jumps(const std::vector<ShellUnknowns> &unknowns)
    {
      std::vector<double> result;
      for (const ShellUnknowns &of_capsule : unknowns)
        result.push_back(of_capsule.pressure_jump);
      return result;
    }
  } // namespace


  ShellFields
  densities(const std::vector<ShellUnknowns> &unknowns)
  {
    ShellFields result;
    for (const ShellUnknowns &of_capsule : unknowns)
      result.push_back(of_capsule.density);
    return result;
  }


  ShellFields
  densities_with_pressure(const std::vector<ShellUnknowns> &unknowns, const LinearisedShells &shells)
  {
    ShellFields result;
    for (unsigned int c = 0; c < shells.size(); ++c)
      result.push_back(unknowns[c].density + unknowns[c].pressure_jump * shells[c].normal_field());
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
      extend(src, densities(unknowns), pressure_jumps(unknowns), forces_);
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
      if (shells_.points_move())
        {
          ShellFields change = densities_with_pressure(unknowns, shells_), present = shells_.densities();
          for (unsigned int c = 0; c < shells_.size(); ++c)
            {
              change[c] *= -1.;
              present[c] *= -1.;
            }
          coupling.spread_with_motion(change, dx, present, dst);
        }
      else
        coupling.spread(-1., forces_, dst);
    }
    const Timings::Scope scope(timings_, "- shell");
    for (unsigned int c = 0; c < shells_.size(); ++c)
      layout_.set(dst, c, -shells_[c].flux(moments[c], dx[c]), shells_.damped(c, shells_[c].force(unknowns[c].density) + shells_[c].stiffness_times(dx[c])));
  }


  MonolithicPreconditioner::MonolithicPreconditioner(const StokesInverse        &stokes,
                                                     const LinearisedShells     &shells,
                                                     const ShellLayout          &layout,
                                                     const PressureJumpResponse &pressure_jumps,
                                                     Timings *const              timings)
    : stokes_(stokes)
    , shells_(shells)
    , layout_(layout)
    , pressure_jumps_(pressure_jumps)
    , timings_(timings)
  {
    stokes.space().reinit(loads_);
  }


  void
  MonolithicPreconditioner::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    std::vector<ShellUnknowns> z = layout_.unknowns(src);
    {
      const Timings::Scope      scope(timings_, "- shell");
      const std::vector<double> jumps = pressure_jumps_.pressure_jumps(src.block(pressure_block), pressure_jumps(z));
      for (unsigned int c = 0; c < shells_.size(); ++c)
        {
          z[c].pressure_jump = jumps[c];
          z[c].density       = shells_[c].density(z[c].density); // what came were forces
        }
    }
    for (unsigned int b = 0; b <= pressure_block; ++b)
      loads_.block(b) = src.block(b);
    {
      const Timings::Scope scope(timings_, "- coupling");
      shells_.coupling().spread_plainly(densities_with_pressure(z, shells_), loads_);
    }
    stokes_.vmult(dst, loads_, timings_);
    for (unsigned int c = 0; c < shells_.size(); ++c)
      layout_.set(dst, c, z[c].pressure_jump, z[c].density);
  }
} // namespace tanktread
