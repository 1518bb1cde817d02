// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: everything about the fluid that lives as long as its mesh.

#ifndef tanktread_fluid_fluid_h
#define tanktread_fluid_fluid_h

#include <tanktread/fluid/stokes_preconditioner.h>

#include <memory>

namespace tanktread
{
  /** A mesh and the spaces, operators and multigrid levels on it, rebuilt together whenever the mesh changes. */
  class Fluid
  {
  public:
    Fluid(MPI_Comm communicator, double side, const FluidMeshParameters &parameters)
      : mesh_(communicator, side, parameters)
    {}

    /** Refines around `points`; see FluidMesh::aim_at(). Returns true if the mesh changed: all vectors of before are void then. Collective. */
    bool
    adapt(const std::vector<dealii::Point<3>> &points)
    {
      if (!mesh_.aim_at(points))
        return false;
      // What stands on the mesh must go before the mesh changes.
      preconditioner_.reset();
      stokes_.reset();
      space_.reset();
      mesh_.restart();
      multigrid_.start(mesh_);
      while (!mesh_.on_last_rung())
        multigrid_.climb(mesh_);
      space_          = std::make_unique<TaylorHoodSpace>(mesh_, multigrid_.space());
      stokes_         = std::make_unique<StokesOperator>(*space_);
      preconditioner_ = std::make_unique<StokesPreconditioner>(*space_, multigrid_);
      return true;
    }

    /** The preconditioner is for A + shift times the velocities' mass matrix from now on, as inertia asks for. Collective. */
    void
    set_shift(const double shift)
    {
      multigrid_.set_shift(shift);
    }

    const FluidMesh &
    mesh() const
    {
      return mesh_;
    }
    const TaylorHoodSpace &
    space() const
    {
      return *space_;
    }
    const StokesOperator &
    stokes() const
    {
      return *stokes_;
    }
    const Multigrid<float> &
    multigrid() const
    {
      return multigrid_;
    }
    const StokesPreconditioner &
    preconditioner() const
    {
      return *preconditioner_;
    }

  private:
    FluidMesh                             mesh_;
    Multigrid<float>                      multigrid_;
    std::unique_ptr<TaylorHoodSpace>      space_;
    std::unique_ptr<StokesOperator>       stokes_;
    std::unique_ptr<StokesPreconditioner> preconditioner_;
  };
} // namespace tanktread

#endif
