// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which ranks hold which capsules, and where the unknowns of each stand in the monolithic vectors.

#ifndef tanktread_coupling_shell_layout_h
#define tanktread_coupling_shell_layout_h

#include <tanktread/fluid/taylor_hood_space.h>
#include <tanktread/shell/capsules.h>
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
   * The ranks form teams, ranks that follow each other, and each capsule belongs to one team: with more capsules than ranks a team is one rank, which holds several
   * capsules; with more ranks than capsules several ranks share the work on one. What belongs to a capsule (control points, forces, matrices) is held by the ranks
   * of its team, the same on all of them, and by no other. A rank tells its capsules by their place 0, 1, ... in own(), in the order of their numbers in the scene.
   *
   * In the shell block of monolithic vectors capsule c has n = 1 + 3 NP_c entries, on the first rank of its team, its leader.
   *
   * Sums and maxima over capsules count each capsule once and are the same on all ranks, bit by bit. Collective: all functions that communicate, which say so.
   */
  class ShellLayout
  {
  public:
    /**
     * Capsules belong to teams by their numbers, to begin with. Keeps `capsules` by reference. @param n_teams 0: as many as there are ranks or capsules, whichever
     * is less. Collective.
     */
    ShellLayout(const Capsules &capsules, MPI_Comm communicator, unsigned int n_teams = 0);

    const Capsules &
    capsules() const
    {
      return capsules_;
    }
    /** Of all ranks. */
    unsigned int
    n_capsules() const
    {
      return capsules_.size();
    }
    unsigned int
    n_teams() const
    {
      return n_teams_;
    }
    unsigned int
    team_of(const unsigned int c) const
    {
      return team_of_[c];
    }
    /** Number of the team that a rank is in. */
    unsigned int
    team_of_rank(unsigned int rank) const;
    /** First rank of a team. */
    unsigned int
    leader(unsigned int team) const;

    /** Numbers of the capsules of this rank's team, in order. */
    const std::vector<unsigned int> &
    own() const
    {
      return own_;
    }
    unsigned int
    n_own() const
    {
      return own_.size();
    }
    /** Kind of the i-th of them. */
    const Capsule &
    capsule(const unsigned int i) const
    {
      return capsules_[own_[i]];
    }
    /** Whether this rank is the first of its team, which holds the entries of vectors and counts in sums. */
    bool
    leads() const
    {
      return leader(team_) == rank_;
    }
    unsigned int
    rank() const
    {
      return rank_;
    }
    unsigned int
    n_ranks() const
    {
      return n_ranks_;
    }
    MPI_Comm
    communicator() const
    {
      return communicator_;
    }
    /** The team that this rank is in. */
    MPI_Comm
    team() const
    {
      return *team_communicator_;
    }
    bool
    is_team_of_one() const
    {
      return team_size_ == 1;
    }

    /** Gives capsule c to team `team_of[c]`. Vectors and all that is held by own() are void then. The argument must be the same on all ranks. */
    void
    assign(std::vector<unsigned int> team_of);

    /** Sum and maximum over all capsules of what this rank has of its own ones. Collective. */
    double
    sum(double of_own) const;
    double
    max(double of_own) const;
    /** A number for each of the rank's own capsules: those of all capsules by their numbers, on all ranks. Collective. */
    std::vector<double>
    gathered(const std::vector<double> &of_own, unsigned int n_each = 1) const;
    /** Numbers of the team's leader on all of its ranks; nothing for a team of one rank. Collective in the team. */
    void
    share(double *values, std::size_t n) const;

    /** Zero vector with blocks (u, p, shells). Collective. */
    FluidBlockVector
    vector(const TaylorHoodSpace &space) const;

    /** The unknowns of this rank's capsules. Collective in the team. */
    std::vector<ShellUnknowns>
    unknowns(const FluidBlockVector &vector) const;

    /** Stores unknowns of the rank's i-th capsule, or what belongs to the rows of the flux and of the forces, on the leader; does nothing on other ranks. */
    void
    set(FluidBlockVector &vector, unsigned int i, double pressure_jump, const ControlPoints &density) const;

  private:
    /** Entries of the shell block before those of the rank's i-th capsule. */
    std::size_t
    first_entry(unsigned int i) const;

    const Capsules                 &capsules_;
    MPI_Comm                        communicator_;
    unsigned int                    rank_, n_ranks_, n_teams_, team_, team_size_;
    std::shared_ptr<const MPI_Comm> team_communicator_;
    std::vector<unsigned int>       team_of_, own_;
  };
} // namespace tanktread

#endif
