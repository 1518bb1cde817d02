// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where the unknowns of each capsule stand in the monolithic vectors, and which rank owns them.

#ifndef tanktread_solver_shell_layout_h
#define tanktread_solver_shell_layout_h

#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/shell/shell_configuration.h>

#include <mpi.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** Block of the monolithic vectors that holds the shells' unknowns. */
  constexpr unsigned int shell_block = pressure_block + 1;

  /** Unknowns of one capsule in that block: dpi and the density dg = M^{-1} dG of the nodal forces, flattened. */
  struct ShellUnknowns
  {
    double        pressure_jump = 0.;
    ControlPoints density;
  };

  /**
   * Capsule c has the entries c n, ..., (c + 1) n - 1 of the shell block, n = 1 + 3 NP; all of them belong to one rank, and each rank has capsules that follow
   * each other. Where there are more ranks than capsules, a team of ranks that follow each other, its owner the first, works on each capsule; otherwise each rank
   * works on its own ones alone.
   */
  class ShellLayout
  {
  public:
    ShellLayout(unsigned int n_capsules, unsigned int n_control_points, MPI_Comm communicator);

    unsigned int
    n_capsules() const
    {
      return n_capsules_;
    }
    /** Rank that owns capsule c. */
    unsigned int
    owner(unsigned int c) const;
    bool
    owns(const unsigned int c) const
    {
      return owner(c) == rank_;
    }
    MPI_Comm
    communicator() const
    {
      return communicator_;
    }
    /** Whether this rank is in the team of capsule c. */
    bool
    works_on(unsigned int c) const;
    /** The team that this rank is in. */
    MPI_Comm
    team() const
    {
      return *team_;
    }

    /** Zero vector with blocks (u, p, shells). Collective. */
    FluidBlockVector
    vector(const TaylorHoodSpace &space) const;

    /** The unknowns of all capsules, on all ranks. Collective. */
    std::vector<ShellUnknowns>
    unknowns(const FluidBlockVector &vector) const;

    /** Stores unknowns of capsule c, or what belongs to the rows of the flux and of the forces, on the rank that owns it; does nothing elsewhere. */
    void
    set(FluidBlockVector &vector, unsigned int c, double pressure_jump, const ControlPoints &density) const;

  private:
    /** First capsule of a rank. */
    unsigned int
    first_capsule(unsigned int rank) const;

    unsigned int              n_capsules_, n_control_points_;
    MPI_Comm                  communicator_;
    unsigned int              rank_, n_ranks_;
    std::shared_ptr<MPI_Comm> team_;
  };
} // namespace tanktread

#endif
