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
  /** Level and integer position of a cube: along each axis it covers [i h_l, (i+1) h_l] from the lower corner of the box, h_l = coarsest / 2^l. */
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
   * The coarse mesh has round(side / coarsest cell) cells along each axis, at least two because a cell must not be its own neighbour; the finest
   * level is the first whose cells are not larger than asked for. All calls are collective.
   */
  class FluidMesh
  {
  public:
    using Triangulation = dealii::parallel::distributed::Triangulation<3>;

    FluidMesh(MPI_Comm communicator, double side, const FluidMeshParameters &parameters);

    /**
     * Makes the mesh the coarsest one, 2:1 balanced, in which every cell closer than band_width h (in each coordinate) to one of `points` has the
     * finest size h. The result depends on the points alone, not on the mesh before. Returns true if the mesh changed.
     *
     * @param points on the shell, the same on all ranks, anywhere in x and y (wrapped periodically). Throws NumericalError if one is not between the walls.
     */
    bool
    adapt(const std::vector<dealii::Point<3>> &points);

    /** True while every cell closer than half a finest cell to one of `points` is a finest one, that is, as long as the band need not follow the shell. */
    bool
    covers(const std::vector<dealii::Point<3>> &points) const;

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

    MPI_Comm      communicator_;
    double        side_;
    double        band_width_;
    int           n_coarse_;
    unsigned int  finest_level_;
    Triangulation triangulation_;
  };
} // namespace tanktread

#endif
