// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the octree of cubes, fine near the shell and coarse away from it.

#ifndef tanktread_fluid_fluid_mesh_h
#define tanktread_fluid_fluid_mesh_h

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>

#include <tanktread/fluid/fluid_mesh_parameters.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace tanktread
{
  /**
   * Level and integer position of a cube: along each axis it covers [i h_l, (i+1) h_l] from the lower corner of the box, h_0 being that of rung 0 and h_l = h_0
   * / 2^l.
   */
  struct CellKey
  {
    unsigned int       level;
    std::array<int, 3> position;

    /** All of the key in one number: 7 bits of level, 19 bits an axis. */
    std::uint64_t
    packed() const;
    /** Inverse of packed(). */
    static CellKey
    unpacked(std::uint64_t key);
  };

  /**
   * Cubes that fill a box. Boundary ids are as deal.II colours them: 2d and 2d + 1 for the lower and the upper face of axis d.
   *
   * The coarsest cells are those that divide() makes of the box; the finest level is the first whose cells are not larger than asked for, or a finer one if
   * films ask for it (choose_finest_level()). For the multigrid's
   * sake the mesh is grown from few cells, n_rung_0(), in rungs: rung l has the cells of the finished mesh down to level l, 2:1 balanced. All calls are
   * collective.
   */
  class FluidMesh
  {
  public:
    using Triangulation = dealii::parallel::distributed::Triangulation<3>;

    /** Throws InputError if no cubes near the coarsest size asked for fill the box, or nothing holds the liquid; see divide(). */
    FluidMesh(MPI_Comm communicator, const Box &box, const FluidMeshParameters &parameters);

    /**
     * Makes the finest level that of films of width `gap` in a, see film_halvings(); only with `finest_in_gaps`. Not collective; `gap` has to be the same on all
     * ranks. A level that is not the one of before holds from the next aim_at() on, which is to follow at once: until restart() the mesh has other cells.
     */
    void
    choose_finest_level(double gap);
    /** One that has been chosen before. */
    void
    set_finest_level(const unsigned int level)
    {
      finest_level_ = level;
    }

    /** Whether choose_finest_level() would leave the finest level as it is. */
    bool
    suits(double gap) const;

    /** Whether the finest level follows films at all. */
    bool
    follows_films() const
    {
      return film_level_ > regular_level_;
    }

    /** How much more work a cell with points in it is than another one: ranks get cells of the finished mesh by their work. The same on all ranks, from the next climb() on. */
    void
    set_work_of_cells_with_points(const double work)
    {
      work_of_points_ = work;
    }

    /** The level of the smallest cells that films may ask for: finest_level() if none may. */
    unsigned int
    film_level() const
    {
      return film_level_;
    }

    /**
     * Chooses the mesh to climb to: the coarsest one, 2:1 balanced, in which every cell closer than band_width h (in each coordinate) to one of `points` has
     * the finest size h, and every cell closer than `grading` cells of size h_l > h to the cells of that size that contain points is not larger than h_l. It
     * depends on the points alone, not on the mesh before. Returns false if that is the mesh chosen last.
     *
     * @param points on the shells, each on one rank or on several, anywhere along periodic axes. Throws NumericalError, on all ranks, if one is not between the faces with
     * prescribed velocity.
     */
    bool
    aim_at(const std::vector<dealii::Point<3>> &points);

    /** Back to the first rung: a uniform mesh of n_rung_0() cells along the axes. Nothing may be attached to the triangulation. */
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

    /** True while every cell closer than `band` finest cells to one of `points` of any rank is a finest one, that is, as long as the mesh need not follow the shells. */
    bool
    covers(const std::vector<dealii::Point<3>> &points, double band = 0.5) const;

    /**
     * For each set of points the ranks that own cells within two finest cells of one of them, in order: those with parts of cubes of twice the finest size that contain
     * points, or touch such cubes. Sets may differ from rank to rank. Of the finished mesh. Collective. Throws NumericalError, on all ranks, if a point is not between the
     * faces with prescribed velocity.
     */
    std::vector<std::vector<unsigned int>>
    ranks_near(const std::vector<std::vector<dealii::Point<3>>> &points) const;

    /** A cube of some level and a point's position in it, in [0, 1)^3. */
    struct Place
    {
      CellKey          key;
      dealii::Point<3> unit;
    };

    /**
     * The cube of level `level` that contains the point, wrapped into the box along periodic axes. Cube and position come from one rounding, so a point at a
     * face is at the lower end of the upper cube or (nearly) at the upper end of the lower one, never one cube away. Throws NumericalError if the point is not
     * between the faces with prescribed velocity or not a number.
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
    const Box &
    box() const
    {
      return box_;
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
    /** Cells of the first rung along the axes. */
    const std::array<int, 3> &
    n_rung_0() const
    {
      return n_rung_0_;
    }
    /** How many cubes of a level there are room for along the axes. */
    std::array<int, 3>
    n_cubes(const unsigned int level) const
    {
      return {{n_rung_0_[0] << level, n_rung_0_[1] << level, n_rung_0_[2] << level}};
    }
    MPI_Comm
    communicator() const
    {
      return communicator_;
    }

  private:
    using KeySet = std::unordered_set<std::uint64_t>;

    /** From 0 to n - 1. */
    static int
    modulo(int i, int n);

    /** Packed keys of the finest cells within `band` finest cells of the points, and of all their ancestors. */
    KeySet
    wanted_cells(const std::vector<dealii::Point<3>> &points, double band) const;

    /** A point in the cube, on no face of cells inside it. */
    dealii::Point<3>
    point_in(const CellKey &cube) const;

    /** Points in the cubes that ranks_near() asks for, one in each. */
    std::vector<dealii::Point<3>>
    places_near(const std::vector<dealii::Point<3>> &points) const;

    /** Cubes of a level, told by their packed keys, on the ranks that own their cells: those that one rank or another asks for. Collective. */
    KeySet
    at_owners(const KeySet &cubes, unsigned int level) const;

    /** Packed keys of the finest cubes with points. */
    KeySet
    cells_with(const std::vector<dealii::Point<3>> &points) const;

    /** How many of the eight parts of a cell have points, by the packed keys of the cells; those of this rank, on the last rung but one. Collective. */
    std::unordered_map<std::uint64_t, unsigned int>
    parts_with_points() const;

    /** Inserts the cells that have to be divided for the sake of the grading. */
    void
    add_grading(const std::vector<dealii::Point<3>> &points, KeySet &wanted) const;

    /**
     * Inserts the cubes of a level from position `low` to position `high` and all their ancestors, wrapped along periodic axes; those beyond other faces are
     * left out.
     */
    void
    insert_range(unsigned int level, const std::array<int, 3> &low, const std::array<int, 3> &high, KeySet &cells) const;

    MPI_Comm           communicator_;
    Box                box_;
    double             band_width_;
    int                grading_;
    std::array<int, 3> n_rung_0_;
    unsigned int       coarsest_level_, finest_level_, rung_ = 0;
    unsigned int       regular_level_, film_level_; // the least and the largest finest level
    bool               aimed_ = false;              // has a mesh been chosen?
    KeySet             wanted_;                     // by the points of this rank, of the mesh chosen last
    KeySet             with_points_;                // finest cubes, likewise
    double             work_of_points_ = 0.;
    Triangulation      triangulation_;
  };
} // namespace tanktread

#endif
