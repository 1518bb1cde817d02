// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the octree of cubes, fine near the shell and coarse away from it.

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <tanktread/base/exceptions.h>
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


  FluidMesh::FluidMesh(const MPI_Comm communicator, const double side, const FluidMeshParameters &parameters)
    : communicator_(communicator)
    , side_(side)
    , band_width_(parameters.band_width)
    , grading_(parameters.grading)
    , n_rung_0_(std::max(2, static_cast<int>(std::lround(side / parameters.coarsest_cell))))
    , triangulation_(communicator, Triangulation::limit_level_difference_at_vertices)
  {
    for (; n_rung_0_ > 4 && n_rung_0_ % 2 == 0; n_rung_0_ /= 2)
      ++coarsest_level_;
    finest_level_ = std::max<double>(coarsest_level_, std::ceil(std::log2(side / n_rung_0_ / parameters.finest_cell) - 1e-9));
    restart();
  }


  void
  FluidMesh::restart()
  {
    rung_ = 0;
    triangulation_.clear();
    dealii::GridGenerator::subdivided_hyper_cube(triangulation_, n_rung_0_, -0.5 * side_, 0.5 * side_, true);

    // p4est keeps the 2:1 balance across the periodic faces only if it knows of them before any refinement.
    std::vector<dealii::GridTools::PeriodicFacePair<Triangulation::cell_iterator>> faces;
    dealii::GridTools::collect_periodic_faces(triangulation_, 0, 1, 0, faces);
    dealii::GridTools::collect_periodic_faces(triangulation_, 2, 3, 1, faces);
    triangulation_.add_periodicity(faces);
  }


  double
  FluidMesh::cell_size(const unsigned int level) const
  {
    return side_ / n_rung_0_ / (1 << level);
  }


  FluidMesh::Place
  FluidMesh::place(const dealii::Point<3> &point, const unsigned int level) const
  {
    const int n = n_rung_0_ << level;
    Place     result;
    result.key.level = level;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const double scaled = (point[d] / side_ + 0.5) * n;
        if (!(std::abs(scaled) < 1e9) || (d == 2 && !(scaled >= 0. && scaled < n)))
          throw NumericalError("The shell has left the fluid: coordinate " + std::to_string(point[d]) + " along axis " + std::to_string(d) +
                               ", walls at z = +-" + std::to_string(0.5 * side_) + '.');
        const int i            = static_cast<int>(std::floor(scaled));
        result.key.position[d] = ((i % n) + n) % n;
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
  FluidMesh::insert_with_ancestors(CellKey cell, KeySet &cells)
  {
    while (cells.insert(cell.packed()).second && cell.level > 0)
      {
        --cell.level;
        for (int &i : cell.position)
          i >>= 1;
      }
  }


  FluidMesh::KeySet
  FluidMesh::wanted_cells(const std::vector<dealii::Point<3>> &points, const double band) const
  {
    const int n = n_rung_0_ << finest_level_;
    KeySet    result;
    for (const auto &point : points)
      {
        place(point, finest_level_); // throws if the point is outside
        std::array<int, 3> low, high;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double i = (point[d] / side_ + 0.5) * n;
            low[d]         = std::floor(i - band);
            high[d]        = std::floor(i + band);
          }
        for (int z = std::max(0, low[2]); z <= std::min(n - 1, high[2]); ++z)
          for (int y = low[1]; y <= high[1]; ++y)
            for (int x = low[0]; x <= high[0]; ++x)
              insert_with_ancestors({finest_level_, {((x % n) + n) % n, ((y % n) + n) % n, z}}, result);
      }
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
          const int  n_parents = n_rung_0_ << (level - 1);
          const auto parent    = [&](const unsigned int d, const int shift) { return (cell.position[d] + shift) >> 1; };
          for (int z = std::max(0, parent(2, -grading_)); z <= std::min(n_parents - 1, parent(2, grading_)); ++z)
            for (int y = parent(1, -grading_); y <= parent(1, grading_); ++y)
              for (int x = parent(0, -grading_); x <= parent(0, grading_); ++x)
                insert_with_ancestors({level - 1, {((x % n_parents) + n_parents) % n_parents, ((y % n_parents) + n_parents) % n_parents, z}}, wanted);
        }
  }


  bool
  FluidMesh::aim_at(const std::vector<dealii::Point<3>> &points)
  {
    KeySet wanted = wanted_cells(points, band_width_);
    if (grading_ > 0)
      add_grading(points, wanted);
    const bool other = !aimed_ || wanted != wanted_;
    aimed_           = true;
    wanted_          = std::move(wanted);
    return other;
  }


  void
  FluidMesh::climb()
  {
    for (const auto &cell : triangulation_.active_cell_iterators())
      if (cell->is_locally_owned() && static_cast<unsigned int>(cell->level()) == rung_ && (rung_ < coarsest_level_ || wanted_.count(key(cell).packed())))
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
    const KeySet wanted = wanted_cells(points, band);
    bool         fine   = true;
    for (const auto &cell : triangulation_.active_cell_iterators())
      if (cell->is_locally_owned() && static_cast<unsigned int>(cell->level()) < finest_level_ && wanted.count(key(cell).packed()))
        fine = false;
    return dealii::Utilities::MPI::min(static_cast<int>(fine), communicator_) == 1;
  }
} // namespace tanktread
