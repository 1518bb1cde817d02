// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: one V-cycle for the velocities.

#ifndef tanktread_fluid_multigrid_h
#define tanktread_fluid_multigrid_h

#include <tanktread/fluid/cell_averages.h>
#include <tanktread/fluid/chebyshev.h>
#include <tanktread/fluid/first_rung_solver.h>
#include <tanktread/fluid/laplace_operator.h>
#include <tanktread/fluid/level_transfer.h>

#include <memory>

namespace tanktread
{
  /**
   * Climbs with a mesh to its last rung and keeps what the V-cycle needs of each rung: global coarsening, so that every rung is a complete mesh with its own
   * hanging nodes and its own periodicity. Smoothing by Chebyshev polynomials in D^{-1} A, D the diagonal; FirstRungSolver on the first rung. Number: float is
   * enough for a preconditioner.
   */
  template <typename Number>
  class Multigrid
  {
  public:
    struct Options
    {
      /** Before and after the coarse correction. */
      ChebyshevOptions smoother;
      /** Degree of the elements: 2 for velocities, 1 for scalars like the pressure, in the first of three components, without a condition on any face. */
      unsigned int elements = 2;
    };

    explicit Multigrid(const Options &options = {});

    /** `mesh` is on its first rung. */
    void
    start(const FluidMesh &mesh);

    /** Lets the mesh climb one rung and keeps the way between. Collective. */
    void
    climb(FluidMesh &mesh);

    /**
     * Makes the V-cycle one for (mu grad u, grad v). Cells of coarser rungs take the mean of mu over their volume.
     *
     * @param viscosities mu of each cell of the last rung. Collective.
     */
    void
    set_viscosity(const std::vector<double> &viscosities);

    /**
     * Makes it one for the form of the Stokes equations with that viscosity, LaplaceOperator::set_strain_form(): on the last rung it is smoothed with, on
     * coarser ones (mu grad u, grad v) stands for it. Collective.
     */
    void
    set_viscosity(const Viscosity &viscosity);

    /**
     * From now on v_cycle() is for A + shift times the mass matrix, also after the next climb. Costs about as much as two cycles unless that is so already.
     * Collective.
     */
    void
    set_shift(double shift);

    /** Array for the right-hand side on the last rung: owned entries of a full array. */
    Number *
    right_hand_side()
    {
      return levels_.back().b.data();
    }
    /** Result of the V-cycle, likewise. */
    const Number *
    solution() const
    {
      return levels_.back().x.data();
    }

    /** solution() = approximately A^{-1} right_hand_side(), a fixed linear map, symmetric and positive. Collective. */
    void
    v_cycle();

    /** Nodes on the last rung. */
    const std::shared_ptr<const NodeSpace> &
    space() const
    {
      return levels_.back().space;
    }
    unsigned int
    n_levels() const
    {
      return levels_.size();
    }
    /** Estimated largest eigenvalue of D^{-1} A on the last rung; zero if that is the first one. */
    double
    largest_eigenvalue() const
    {
      return levels_.size() > 1 ? levels_.back().smoother->largest_eigenvalue() : 0.;
    }

  private:
    using Smoother = ChebyshevSmoother<LaplaceOperator<Number>, Number, 4>;

    struct Level
    {
      std::shared_ptr<const NodeSpace>         space;
      std::unique_ptr<LaplaceOperator<Number>> laplace;
      dealii::AlignedVector<Number>            x, b; // full arrays
      // On all rungs but the first:
      std::unique_ptr<Smoother>              smoother;
      std::unique_ptr<LevelTransfer<Number>> transfer; // from the level before
      std::unique_ptr<CellAverages>          averages; // for the level before
    };

    std::shared_ptr<const NodeSpace>
    nodes(const FluidMesh &mesh) const;
    /** Operator and arrays of the last level, whose space is known. */
    void
    make_operator();
    /** Of rungs below number `end`, `values` being those of the cells of rung end - 1. */
    void
    set_viscosity(std::vector<double> values, unsigned int end);
    /** Diagonal and largest eigenvalue. */
    void
    prepare_smoother(Level &level);
    void
    cycle(unsigned int l);

    Options                                  options_;
    double                                   shift_ = 0.;
    std::vector<Level>                       levels_;
    std::unique_ptr<FirstRungSolver<Number>> first_rung_solver_;
  };
} // namespace tanktread

#endif
