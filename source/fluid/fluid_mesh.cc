// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the octree of cubes, fine near the shell and coarse away from it.

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/fluid/film_cells.h>
#include <tanktread/fluid/fluid_mesh.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  std::uint64_t
  CellKey::packed() const
  {
    std::uint64_t result = level;
    for (const int i : position)
      result = (result << 19) | static_cast<std::uint64_t>(i);
    return result;
  }


  CellKey
  CellKey::unpacked(std::uint64_t key)
  {
    constexpr std::uint64_t n = std::uint64_t(1) << 19;
    CellKey                 result;
    for (unsigned int d = 3; d-- > 0; key /= n)
      result.position[d] = int(key % n);
    result.level = key;
    return result;
  }


  namespace
  {
    /** Inserts a cell and all its ancestors. */
    void
    insert_with_ancestors(CellKey cell, std::unordered_set<std::uint64_t> &cells)
    {
      while (cells.insert(cell.packed()).second && cell.level > 0)
        {
          --cell.level;
          for (int &i : cell.position)
            i >>= 1;
        }
    }
  } // namespace


  int
  FluidMesh::modulo(const int i, const int n)
  {
    return ((i % n) + n) % n;
  }


  FluidMesh::FluidMesh(const MPI_Comm communicator, const Box &box, const FluidMeshParameters &parameters)
    : communicator_(communicator)
    , box_(box)
    , band_width_(parameters.band_width)
    , grading_(parameters.grading)
    , triangulation_(communicator, Triangulation::limit_level_difference_at_vertices, Triangulation::communicate_vertices_to_p4est)
  {
    const BoxDivision division = divide(box, parameters.coarsest_cell);
    n_rung_0_                  = division.n_rung_0;
    coarsest_level_            = division.coarsest_level;
    regular_level_             = std::max<double>(coarsest_level_, std::ceil(std::log2(cell_size(0) / parameters.finest_cell) - 1e-9));
    film_level_                = regular_level_;
    while (parameters.finest_in_gaps > 0. && cell_size(film_level_ + 1) > (1. - 1e-9) * parameters.finest_in_gaps)
      ++film_level_;
    finest_level_ = regular_level_;
    restart();
  }


  void
  FluidMesh::restart()
  {
    rung_ = 0;
    triangulation_.clear();
    const dealii::Point<3>          lower(box_.lower(0), box_.lower(1), box_.lower(2)), upper(-lower[0], -lower[1], -lower[2]);
    const std::vector<unsigned int> repetitions(n_rung_0_.begin(), n_rung_0_.end());
    dealii::GridGenerator::subdivided_hyper_rectangle(triangulation_, repetitions, lower, upper, true);

    // p4est keeps the 2:1 balance across the periodic faces only if it knows of them before any refinement.
    std::vector<dealii::GridTools::PeriodicFacePair<Triangulation::cell_iterator>> faces;
    for (unsigned int d = 0; d < 3; ++d)
      if (box_.is_periodic(d))
        dealii::GridTools::collect_periodic_faces(triangulation_, 2 * d, 2 * d + 1, d, faces);
    triangulation_.add_periodicity(faces);
  }


  double
  FluidMesh::cell_size(const unsigned int level) const
  {
    return box_.side[0] / n_rung_0_[0] / (1 << level);
  }


  void
  FluidMesh::choose_finest_level(const double gap)
  {
    finest_level_ = regular_level_ + film_halvings(gap, cell_size(regular_level_), film_level_ - regular_level_, finest_level_ - regular_level_);
  }


  bool
  FluidMesh::suits(const double gap) const
  {
    return film_halvings(gap, cell_size(regular_level_), film_level_ - regular_level_, finest_level_ - regular_level_) == finest_level_ - regular_level_;
  }


  FluidMesh::Place
  FluidMesh::place(const dealii::Point<3> &point, const unsigned int level) const
  {
    const std::array<int, 3> n = n_cubes(level);
    Place                    result;
    result.key.level = level;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const double scaled = (point[d] / box_.side[d] + 0.5) * n[d];
        if (!(std::abs(scaled) < 1e9) || (!box_.is_periodic(d) && !(scaled >= 0. && scaled < n[d])))
          throw NumericalError("The shell has left the fluid: coordinate " + std::to_string(point[d]) + " along axis " + std::to_string(d) +
                               ", the faces of the box being at +-" + std::to_string(0.5 * box_.side[d]));
        const int i            = static_cast<int>(std::floor(scaled));
        result.key.position[d] = modulo(i, n[d]);
        result.unit[d]         = scaled - i;
      }
    return result;
  }


  CellKey
  FluidMesh::key(const dealii::Triangulation<3>::cell_iterator &cell) const
  {
    return place(cell->center(), cell->level()).key;
  }


  void
  FluidMesh::insert_range(const unsigned int level, const std::array<int, 3> &low, const std::array<int, 3> &high, KeySet &cells) const
  {
    const std::array<int, 3> n = n_cubes(level);
    std::array<int, 3>       first, last;
    for (unsigned int d = 0; d < 3; ++d)
      {
        first[d] = box_.is_periodic(d) ? low[d] : std::max(0, low[d]);
        last[d]  = box_.is_periodic(d) ? high[d] : std::min(n[d] - 1, high[d]);
      }
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x)
          insert_with_ancestors({level, {{modulo(x, n[0]), modulo(y, n[1]), modulo(z, n[2])}}}, cells);
  }


  FluidMesh::KeySet
  FluidMesh::wanted_cells(const std::vector<dealii::Point<3>> &points, const double band) const
  {
    const std::array<int, 3> n = n_cubes(finest_level_);
    KeySet                   result;
    for (const auto &point : points)
      {
        place(point, finest_level_); // throws if the point is outside
        std::array<int, 3> low, high;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double i = (point[d] / box_.side[d] + 0.5) * n[d];
            low[d]         = std::floor(i - band);
            high[d]        = std::floor(i + band);
          }
        insert_range(finest_level_, low, high, result);
      }
    return result;
  }


  FluidMesh::KeySet
  FluidMesh::cells_with(const std::vector<dealii::Point<3>> &points) const
  {
    KeySet result;
    for (const auto &point : points)
      result.insert(place(point, finest_level_).key.packed());
    return result;
  }


  void
  FluidMesh::add_grading(const std::vector<dealii::Point<3>> &points, KeySet &wanted) const
  {
    // Parents of all cells that are as close as that to a cell with points: the same for many points.
    KeySet done;
    for (const auto &point : points)
      for (unsigned int level = finest_level_; level-- > std::max(1u, coarsest_level_ + 1);)
        {
          const CellKey cell = place(point, level).key;
          if (!done.insert(cell.packed()).second)
            break;
          std::array<int, 3> low, high;
          for (unsigned int d = 0; d < 3; ++d)
            {
              low[d]  = (cell.position[d] - grading_) >> 1;
              high[d] = (cell.position[d] + grading_) >> 1;
            }
          insert_range(level - 1, low, high, wanted);
        }
  }


  bool
  FluidMesh::aim_at(const std::vector<dealii::Point<3>> &points)
  {
    KeySet wanted;
    on_all_ranks(communicator_, [&] {
      wanted       = wanted_cells(points, band_width_);
      with_points_ = cells_with(points);
      if (grading_ > 0)
        add_grading(points, wanted);
    });
    const bool other = dealii::Utilities::MPI::max(int(!aimed_ || wanted != wanted_), communicator_) == 1;
    aimed_           = true;
    wanted_          = std::move(wanted);
    return other;
  }


  void
  FluidMesh::climb()
  {
    std::unordered_map<std::uint64_t, unsigned int> parts;
    boost::signals2::scoped_connection              by_work;
    if (rung_ + 1 == finest_level_ && work_of_points_ > 0. && dealii::Utilities::MPI::n_mpi_processes(communicator_) > 1)
      {
        parts   = parts_with_points();
        by_work = triangulation_.signals.weight.connect([&](const Triangulation::cell_iterator &cell, const Triangulation::CellStatus) {
          constexpr double unit = 1000.; // of a cell; the parts of a cell that is divided are not told apart
          const auto       here = parts.find(key(cell).packed());
          return static_cast<unsigned int>(unit * (1. + (here == parts.end() ? 0. : work_of_points_ * here->second / 8.)));
        });
      }
    const KeySet wanted = rung_ < coarsest_level_ ? KeySet() : at_owners(wanted_, rung_);
    for (const auto &cell : triangulation_.active_cell_iterators())
      if (cell->is_locally_owned() && static_cast<unsigned int>(cell->level()) == rung_ && (rung_ < coarsest_level_ || wanted.count(key(cell).packed())))
        cell->set_refine_flag();
    triangulation_.execute_coarsening_and_refinement();
    ++rung_;
  }


  bool
  FluidMesh::adapt(const std::vector<dealii::Point<3>> &points)
  {
    if (!aim_at(points))
      return false;
    restart();
    while (!on_last_rung())
      climb();
    return true;
  }


  bool
  FluidMesh::covers(const std::vector<dealii::Point<3>> &points, const double band) const
  {
    KeySet asked, wanted;
    on_all_ranks(communicator_, [&] { asked = wanted_cells(points, band); });
    for (const std::uint64_t key : at_owners(asked, finest_level_))
      insert_with_ancestors(CellKey::unpacked(key), wanted);
    bool fine = true;
    for (const auto &cell : triangulation_.active_cell_iterators())
      if (cell->is_locally_owned() && static_cast<unsigned int>(cell->level()) < finest_level_ && wanted.count(key(cell).packed()))
        fine = false;
    return dealii::Utilities::MPI::min(static_cast<int>(fine), communicator_) == 1;
  }
} // namespace tanktread
