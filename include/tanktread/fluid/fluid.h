// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: everything about the fluid that lives as long as its mesh.

#ifndef tanktread_fluid_fluid_h
#define tanktread_fluid_fluid_h

#include <tanktread/fluid/algebraic_stokes.h>
#include <tanktread/fluid/stokes_method.h>
#include <tanktread/fluid/stokes_preconditioner.h>

#include <limits>
#include <memory>
#include <stdexcept>

namespace tanktread
{
  /**
   * A mesh and the spaces, operators and multigrid levels on it, rebuilt together whenever the mesh changes. With StokesMethod::assembled there are matrices in
   * place of the matrix-free operator and of both multigrids: whoever asks for stokes() and preconditioner(), residuals and the linear solver alike, gets those.
   */
  class Fluid
  {
  public:
    Fluid(MPI_Comm communicator, const Box &box, const FluidMeshParameters &parameters, const StokesMethod method = StokesMethod::matrix_free)
      : method_(method)
      , mesh_(communicator, box, parameters)
      , pressure_multigrid_(linear_elements())
    {}

    /** See FluidMesh::set_work_of_cells_with_points(). */
    void
    set_work_of_cells_with_points(const double work)
    {
      mesh_.set_work_of_cells_with_points(work);
    }

    /**
     * Refines around `points`; see FluidMesh::aim_at(). Returns true if the mesh changed: all vectors of before are void then. Collective.
     *
     * @param film width of the thinnest one; see FluidMesh::choose_finest_level().
     */
    bool
    adapt(const std::vector<dealii::Point<3>> &points, const double film = std::numeric_limits<double>::infinity())
    {
      mesh_.choose_finest_level(film);
      return rebuild(points);
    }

    /** The same with finest cells of a level that choose_finest_level() had chosen. */
    bool
    adapt_to_level(const std::vector<dealii::Point<3>> &points, const unsigned int finest_level)
    {
      mesh_.set_finest_level(finest_level);
      return rebuild(points);
    }
    /**
     * One viscosity everywhere until this is called, and again after a change of mesh. Throws std::logic_error with assembled matrices, which are of one.
     * Collective.
     */
    void
    set_viscosity(Viscosity viscosity, const bool for_preconditioner = true)
    {
      if (assembled_)
        throw std::logic_error("Fluid: assembled matrices have one viscosity.");
      viscosity_ = std::make_unique<Viscosity>(std::move(viscosity));
      stokes_->set_viscosity(*viscosity_);
      if (for_preconditioner)
        preconditioner_->set_viscosity(*viscosity_);
    }

    /** Null if it is 1 everywhere. */
    const Viscosity *
    viscosity() const
    {
      return viscosity_.get();
    }

    /**
     * The preconditioner is for A + shift times the velocities' mass matrix from now on, as inertia asks for. Throws std::logic_error for a shift with assembled
     * matrices. Collective.
     */
    void
    set_shift(const double shift)
    {
      if (!assembled_)
        preconditioner_->set_shift(shift);
      else if (shift != 0.)
        throw std::logic_error("Fluid: assembled matrices are without inertia.");
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
    const StokesMap &
    stokes() const
    {
      return assembled_ ? assembled_->map() : *stokes_;
    }
    /** Of the velocities, without levels if matrices are assembled. */
    const Multigrid<float> &
    multigrid() const
    {
      return multigrid_;
    }
    const StokesInverse &
    preconditioner() const
    {
      return assembled_ ? assembled_->inverse() : *preconditioner_;
    }

  private:
    bool
    rebuild(const std::vector<dealii::Point<3>> &points)
    {
      if (!mesh_.aim_at(points))
        return false;
      // What stands on the mesh must go before the mesh changes.
      viscosity_.reset();
      preconditioner_.reset();
      stokes_.reset();
      assembled_.reset();
      space_.reset();
      if (method_ == StokesMethod::assembled)
        assemble();
      else
        make_matrix_free();
      return true;
    }

    static Multigrid<float>::Options
    linear_elements()
    {
      Multigrid<float>::Options options;
      options.elements = 1;
      return options;
    }

    void
    make_matrix_free()
    {
      climb(pressure_multigrid_);
      climb(multigrid_);
      space_          = std::make_unique<TaylorHoodSpace>(mesh_, multigrid_.space());
      stokes_         = std::make_unique<StokesOperator>(*space_);
      preconditioner_ = std::make_unique<StokesPreconditioner>(*space_, multigrid_, pressure_multigrid_);
    }

    void
    assemble()
    {
      mesh_.restart();
      while (!mesh_.on_last_rung())
        mesh_.climb();
      space_     = std::make_unique<TaylorHoodSpace>(mesh_);
      assembled_ = std::make_unique<AlgebraicStokes>(*space_);
    }

    /** The way up is the same each time, so that both multigrids end on the same mesh with the same partition. */
    void
    climb(Multigrid<float> &multigrid)
    {
      mesh_.restart();
      multigrid.start(mesh_);
      while (!mesh_.on_last_rung())
        multigrid.climb(mesh_);
    }

    const StokesMethod                    method_;
    FluidMesh                             mesh_;
    Multigrid<float>                      multigrid_;
    Multigrid<float>                      pressure_multigrid_;
    std::unique_ptr<TaylorHoodSpace>      space_;
    std::unique_ptr<StokesOperator>       stokes_;
    std::unique_ptr<StokesPreconditioner> preconditioner_;
    std::unique_ptr<AlgebraicStokes>      assembled_; // in place of the two above, or null
    std::unique_ptr<Viscosity>            viscosity_;
  };
} // namespace tanktread

#endif
