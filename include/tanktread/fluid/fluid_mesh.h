// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the octree of cubes, fine near the shell and coarse away from it.

#ifndef tanktread_fluid_fluid_mesh_h
#define tanktread_fluid_fluid_mesh_h

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>

#include <tanktread/fluid/fluid_mesh_parameters.h>

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

namespace tanktread
{
  /** Level and integer position of a cube: along each axis it covers [i h_l, (i+1) h_l] from the lower corner of the box, h_0 being that of rung 0 and h_l = h_0 / 2^l. */
  struct CellKey
  {
    unsigned int       level;
    std::array<int, 3> position;

    /** All of the key in one number: 7 bits of level, 19 bits an axis. */
    std::uint64_t
    packed() const;
  };

  /**
   * Cube of side `side` centred at the origin, periodic in x and y, walls at z = ± side/2 (boundary ids 4 and 5, as deal.II colours them).
   *
   * The coarsest cells asked for are round(side / coarsest cell) along each axis, at least two because a cell must not be its own neighbour; the finest
   * level is the first whose cells are not larger than asked for. For the multigrid's sake the mesh is grown from few cells, four or fewer along each axis where that number
   * can be halved so far, in rungs: rung l has the cells of the finished mesh down to level l, 2:1 balanced. All calls are collective.
   */
  class FluidMesh
  {
  public:
    using Triangulation = dealii::parallel::distributed::Triangulation<3>;

    FluidMesh(MPI_Comm communicator, double side, const FluidMeshParameters &parameters);

    /**
     * Chooses the mesh to climb to: the coarsest one, 2:1 balanced, in which every cell closer than band_width h (in each coordinate) to one of `points` has the
     * finest size h, and every cell closer than `grading` cells of size h_l > h to the cells of that size that contain points is not larger than h_l. It depends on the points alone, not on the mesh before. Returns false if that is the mesh chosen last.
     *
     * @param points on the shell, the same on all ranks, anywhere in x and y (wrapped periodically). Throws NumericalError if one is not between the walls.
     */
    bool
    aim_at(const std::vector<dealii::Point<3>> &points);

    /** Back to the first rung: a uniform mesh of n_rung_0() cells along each axis. Nothing may be attached to the triangulation. */
    void
    restart();

    /** Refines to the next rung, each cell divided once or not at all. Not to be called on the last one. */
    void
    climb();

    bool
    on_last_rung() const
    {
      return rung_ == finest_level_;
    }

    /** aim_at() and, if the mesh is another one, all the way up. Returns true if the mesh changed. */
    bool
    adapt(const std::vector<dealii::Point<3>> &points);

    /** True while every cell closer than `band` finest cells to one of `points` is a finest one, that is, as long as the mesh need not follow the shell. */
    bool
    covers(const std::vector<dealii::Point<3>> &points, double band = 0.5) const;

    /** A cube of some level and a point's position in it, in [0, 1)^3. */
    struct Place
    {
      CellKey          key;
      dealii::Point<3> unit;
    };

    /**
     * The cube of level `level` that contains the point, wrapped into the box in x and y. Cube and position come from one rounding, so a point at a face is at the lower end of
     * the upper cube or (nearly) at the upper end of the lower one, never one cube away. Throws NumericalError if the point is not between the walls or not a number.
     */
    Place
    place(const dealii::Point<3> &point, unsigned int level) const;

    /** Key of an existing cell. */
    CellKey
    key(const dealii::Triangulation<3>::cell_iterator &cell) const;

    double
    cell_size(unsigned int level) const;

    const Triangulation &
    triangulation() const
    {
      return triangulation_;
    }
    Triangulation &
    triangulation()
    {
      return triangulation_;
    }
    double
    side() const
    {
      return side_;
    }
    unsigned int
    finest_level() const
    {
      return finest_level_;
    }
    /** Level of the coarsest cells of a finished mesh. */
    unsigned int
    coarsest_level() const
    {
      return coarsest_level_;
    }
    int
    n_rung_0() const
    {
      return n_rung_0_;
    }
    MPI_Comm
    communicator() const
    {
      return communicator_;
    }

  private:
    using KeySet = std::unordered_set<std::uint64_t>;

    /** Packed keys of the finest cells within `band` finest cells of the points, and of all their ancestors. */
    KeySet
    wanted_cells(const std::vector<dealii::Point<3>> &points, double band) const;

    /** Inserts the cells that have to be divided for the sake of the grading. */
    void
    add_grading(const std::vector<dealii::Point<3>> &points, KeySet &wanted) const;

    /** Inserts a cell and all its ancestors. */
    static void
    insert_with_ancestors(CellKey cell, KeySet &cells);

    MPI_Comm      communicator_;
    double        side_;
    double        band_width_;
    int           grading_, n_rung_0_;
    unsigned int  coarsest_level_ = 0, finest_level_, rung_ = 0;
    bool          aimed_ = false; // has a mesh been chosen?
    KeySet        wanted_;        // of the mesh chosen last
    Triangulation triangulation_;
  };
} // namespace tanktread

#endif
