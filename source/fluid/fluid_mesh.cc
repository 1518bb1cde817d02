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
    , n_coarse_(std::max(2, static_cast<int>(std::lround(side / parameters.coarsest_cell))))
    , finest_level_(std::max(0., std::ceil(std::log2(side / n_coarse_ / parameters.finest_cell) - 1e-9)))
    , triangulation_(communicator, Triangulation::limit_level_difference_at_vertices)
  {
    dealii::GridGenerator::subdivided_hyper_cube(triangulation_, n_coarse_, -0.5 * side, 0.5 * side, true);

    // p4est keeps the 2:1 balance across the periodic faces only if it knows of them before any refinement.
    std::vector<dealii::GridTools::PeriodicFacePair<Triangulation::cell_iterator>> faces;
    dealii::GridTools::collect_periodic_faces(triangulation_, 0, 1, 0, faces);
    dealii::GridTools::collect_periodic_faces(triangulation_, 2, 3, 1, faces);
    triangulation_.add_periodicity(faces);
  }


  double
  FluidMesh::cell_size(const unsigned int level) const
  {
    return side_ / n_coarse_ / (1 << level);
  }


  FluidMesh::Place
  FluidMesh::place(const dealii::Point<3> &point, const unsigned int level) const
  {
    const int n = n_coarse_ << level;
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


  FluidMesh::KeySet
  FluidMesh::wanted_cells(const std::vector<dealii::Point<3>> &points, const double band) const
  {
    const int  n = n_coarse_ << finest_level_;
    KeySet     result;
    const auto insert_with_ancestors = [&](CellKey cell) {
      while (result.insert(cell.packed()).second && cell.level > 0)
        {
          --cell.level;
          for (int &i : cell.position)
            i >>= 1;
        }
    };
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
              insert_with_ancestors({finest_level_, {((x % n) + n) % n, ((y % n) + n) % n, z}});
      }
    return result;
  }


  bool
  FluidMesh::adapt(const std::vector<dealii::Point<3>> &points)
  {
    const KeySet wanted  = wanted_cells(points, band_width_);
    bool         changed = false;
    // A cell is divided if it contains a wanted finest cell. p4est refines and coarsens by one level a call.
    for (unsigned int sweep = 0; sweep <= 2 * finest_level_ + 2; ++sweep)
      {
        for (const auto &cell : triangulation_.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const unsigned int level = cell->level();
              CellKey            k     = key(cell);
              if (level < finest_level_ && wanted.count(k.packed()))
                cell->set_refine_flag();
              else if (level > 0)
                {
                  --k.level;
                  for (int &i : k.position)
                    i >>= 1;
                  if (!wanted.count(k.packed()))
                    cell->set_coarsen_flag();
                }
            }
        const auto checksum = triangulation_.get_checksum();
        triangulation_.execute_coarsening_and_refinement();
        // The checksum lives on rank 0 only.
        const bool same = dealii::Utilities::MPI::broadcast(communicator_, checksum == triangulation_.get_checksum(), 0);
        if (same)
          return changed;
        changed = true;
      }
    throw NumericalError("The fluid mesh did not settle around the shell.");
  }


  bool
  FluidMesh::covers(const std::vector<dealii::Point<3>> &points) const
  {
    const KeySet wanted = wanted_cells(points, 0.5);
    bool         fine   = true;
    for (const auto &cell : triangulation_.active_cell_iterators())
      if (cell->is_locally_owned() && static_cast<unsigned int>(cell->level()) < finest_level_ && wanted.count(key(cell).packed()))
        fine = false;
    return dealii::Utilities::MPI::min(static_cast<int>(fine), communicator_) == 1;
  }
} // namespace tanktread
