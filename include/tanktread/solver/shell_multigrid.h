// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a V-cycle on Loop's control meshes for matrices of the shell.

#ifndef tanktread_solver_shell_multigrid_h
#define tanktread_solver_shell_multigrid_h

#include <Eigen/LU>
#include <tanktread/solver/loop_hierarchy.h>

#include <mpi.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /**
   * Approximates S^{-1}, S = Z_tau + tau K_pi of LinearisedShell, by a V-cycle: coarse matrices P^T S P with Loop's subdivision P, by which the limit surfaces of
   * coarse control meshes are among those of finer ones; two steps of Chebyshev's method with the PatchInverses before and after; the
   * coarsest matrix inverted. The map is linear and always the same, as a factor of rows of a linear system has to be.
   *
   * Matrices are in single precision; fields in double: S has stiff components, of which single precision would leave enough to disturb the soft ones.
   *
   * The ranks of the communicator divide the rows of the finer levels. Needs S to be positive, or nearly so: convergence_factor() tells.
   */
  class ShellMultigrid
  {
  public:
    /** @param hierarchy with as many parts as `team` has ranks, this rank's. */
    ShellMultigrid(std::shared_ptr<const LoopHierarchy> hierarchy, MPI_Comm team);

    /** @param S with the pattern of AssemblyPattern::block_matrix(), the same on all ranks. Collective. */
    void
    set_up(const SparseMatrix &S);

    /** The V-cycle applied to f, which all ranks have to know; so they do the result. Collective. */
    ControlPoints
    solve(const ControlPoints &f) const;

    /** By how much a V-cycle reduces errors that it reduces least, about: of a few random ones. Above one, or not a number, if it does not. Collective. */
    double
    convergence_factor() const;

  private:
    /** Matrices and fields of a level. */
    struct Level
    {
      BlockRows           S, B;
      double              largest_eigenvalue = 0.; // of B S
      std::vector<int>    counts, starts;          // numbers of a field on each rank, and where they begin; if the level is divided
      mutable PaddedField b, x, r, z;
    };

    /** All ranks get the rows of all. */
    void
    exchange(std::size_t l, PaddedField &field) const;
    void
    residual(std::size_t l) const;
    /** Two steps of Chebyshev's method from x, or from zero. */
    void
    smooth(std::size_t l, bool from_zero) const;
    void
    cycle(std::size_t l) const;
    void
    estimate_eigenvalue(std::size_t l);

    std::shared_ptr<const LoopHierarchy> hierarchy_;
    MPI_Comm                             team_;
    std::vector<Level>                   levels_;
    Eigen::PartialPivLU<Eigen::MatrixXd> coarsest_;
  };
} // namespace tanktread

#endif
