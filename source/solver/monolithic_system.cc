// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the linear system of a Newton iteration and its preconditioner.

#include <deal.II/base/mpi.h>

#include <tanktread/solver/monolithic_system.h>

namespace tanktread
{
  FluidBlockVector
  monolithic_vector(const TaylorHoodSpace &space, const unsigned int n_control_points)
  {
    const MPI_Comm     communicator = space.mesh.communicator();
    const unsigned int size         = 1 + 3 * n_control_points;
    dealii::IndexSet   owned(size);
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      owned.add_range(0, size);
    FluidBlockVector result;
    space.reinit(result, shell_block + 1);
    result.block(shell_block).reinit(owned, communicator);
    result.collect_sizes();
    return result;
  }


  ShellUnknowns
  shell_unknowns(const FluidBlockVector &vector, const MPI_Comm communicator)
  {
    const auto         &block = vector.block(shell_block);
    std::vector<double> values(block.size());
    std::copy(block.begin(), block.end(), values.begin());
    MPI_Bcast(values.data(), values.size(), MPI_DOUBLE, 0, communicator);
    return {values[0], Eigen::Map<const ControlPoints>(values.data() + 1, (values.size() - 1) / 3, 3)};
  }


  void
  set_shell_unknowns(FluidBlockVector &vector, const ShellUnknowns &unknowns)
  {
    auto &block = vector.block(shell_block);
    if (block.locally_owned_size() == 0)
      return;
    block.local_element(0) = unknowns.pressure_jump;
    std::copy(unknowns.force.data(), unknowns.force.data() + unknowns.force.size(), block.begin() + 1);
  }


  void
  MonolithicOperator::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    const auto         &coupling     = shell_.coupling();
    const MPI_Comm      communicator = stokes_.space().mesh.communicator();
    const ShellUnknowns unknowns     = shell_unknowns(src, communicator);
    ControlPoints       moments, dx;
    {
      const Timings::Scope scope(timings_, "- coupling");
      coupling.extend(unknowns.force, forces_);
      moments = coupling.velocity_moments(src, forces_);
    }
    {
      const Timings::Scope scope(timings_, "- shell");
      dx = shell_.displacement(moments);
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
      const ControlPoints  force = unknowns.force + unknowns.pressure_jump * shell_.volume_gradient();
      if (shell_.points_move())
        coupling.spread_with_motion(-force, dx, -shell_.density(), dst);
      else
        coupling.spread(-1., force, forces_, dst);
    }
    const Timings::Scope scope(timings_, "- shell");
    set_shell_unknowns(dst, {-shell_.flux(moments, dx), shell_.damped(unknowns.force + shell_.stiffness_times(dx))});
  }


  MonolithicPreconditioner::MonolithicPreconditioner(const StokesPreconditioner &stokes,
                                                     const LinearisedShell      &shell,
                                                     const double                volume,
                                                     Timings *const              timings)
    : stokes_(stokes)
    , shell_(shell)
    , volume_(volume)
    , timings_(timings)
  {
    stokes.space().reinit(loads_);
  }


  void
  MonolithicPreconditioner::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    const ShellUnknowns r = shell_unknowns(src, stokes_.space().mesh.communicator());
    const ShellUnknowns z{-r.pressure_jump / volume_, r.force};
    for (unsigned int b = 0; b <= pressure_block; ++b)
      loads_.block(b) = src.block(b);
    {
      const Timings::Scope scope(timings_, "- coupling");
      shell_.coupling().spread_plainly(z.force + z.pressure_jump * shell_.volume_gradient(), loads_);
    }
    stokes_.vmult(dst, loads_, timings_);
    set_shell_unknowns(dst, z);
  }
} // namespace tanktread
