// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities and their gradients at arbitrary points, and the adjoint.

#include <deal.II/fe/fe_tools.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/point_interpolation.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  CellLocator::CellLocator(const FluidMesh &mesh)
    : mesh_(mesh)
  {
    int index = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cells_.emplace(mesh.key(cell).packed(), index++);
          levels_.push_back(cell->level());
        }
    std::sort(levels_.begin(), levels_.end(), std::greater<unsigned int>());
    levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
  }


  CellLocator::Location
  CellLocator::locate(const dealii::Point<3> &point) const
  {
    Location result;
    for (const unsigned int level : levels_)
      {
        const FluidMesh::Place place = mesh_.place(point, level);
        const auto             found = cells_.find(place.key.packed());
        if (found == cells_.end())
          continue;
        result.cell = found->second;
        result.unit = place.unit;
        break;
      }
    return result;
  }


  PointInterpolation::PointInterpolation(const TaylorHoodSpace &space)
    : space_(space)
    , locator_(space.mesh)
    , lexicographic_to_hierarchic_(dealii::FETools::lexicographic_to_hierarchic_numbering<3>(2))
  {
    for (const auto &cell : space.velocity.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        cells_.push_back(cell);
  }


  const PointInterpolation::ResolvedCell &
  PointInterpolation::resolve(const int cell)
  {
    const auto found = resolved_.find(cell);
    if (found != resolved_.end())
      return found->second;

    std::vector<dealii::types::global_dof_index> dofs(27);
    cells_[cell]->get_dof_indices(dofs);
    const auto  &constraints = space_.velocity.constraints();
    const auto  &partitioner = *space_.velocity.partitioner();
    ResolvedCell result;
    for (unsigned int a = 0; a < 27; ++a)
      {
        const auto dof = dofs[lexicographic_to_hierarchic_[a]];
        if (!constraints.is_constrained(dof))
          result[a].masters.emplace_back(partitioner.global_to_local(dof), 1.);
        else
          for (const auto &[master, weight] : *constraints.get_constraint_entries(dof))
            result[a].masters.emplace_back(partitioner.global_to_local(master), weight);
      }
    return resolved_.emplace(cell, std::move(result)).first->second;
  }


  namespace
  {
    /** Quadratic Lagrange polynomials with nodes 0, 1/2, 1 and their derivatives. */
    void
    lagrange(const double x, std::array<double, 3> &value, std::array<double, 3> &derivative)
    {
      value      = {{(1. - x) * (1. - 2. * x), 4. * x * (1. - x), x * (2. * x - 1.)}};
      derivative = {{4. * x - 3., 4. - 8. * x, 4. * x - 1.}};
    }
  } // namespace


  void
  PointInterpolation::reinit(const std::vector<dealii::Point<3>> &points)
  {
    n_points_ = points.size();
    local_points_.clear();
    row_start_.assign(1, 0);
    entries_.clear();
    for (unsigned int q = 0; q < n_points_; ++q)
      {
        space_.mesh.place(points[q], 0); // throws on all ranks alike, also on those without cells
        const CellLocator::Location location = locator_.locate(points[q]);
        if (location.cell < 0)
          continue;
        const ResolvedCell                  &cell = resolve(location.cell);
        const double                         h    = space_.mesh.cell_size(cells_[location.cell]->level());
        std::array<std::array<double, 3>, 3> n, dn;
        for (unsigned int d = 0; d < 3; ++d)
          lagrange(location.unit[d], n[d], dn[d]);
        for (unsigned int a = 0; a < 27; ++a)
          {
            const unsigned int i = a % 3, j = (a / 3) % 3, k = a / 9;
            const double       value = n[0][i] * n[1][j] * n[2][k];
            const double       dx = dn[0][i] * n[1][j] * n[2][k] / h, dy = n[0][i] * dn[1][j] * n[2][k] / h, dz = n[0][i] * n[1][j] * dn[2][k] / h;
            for (const auto &[index, weight] : cell[a].masters)
              entries_.push_back({index, weight * value, {{weight * dx, weight * dy, weight * dz}}});
          }
        local_points_.push_back(q);
        row_start_.push_back(entries_.size());
      }
    const unsigned int n_found = dealii::Utilities::MPI::sum(static_cast<unsigned int>(local_points_.size()), space_.mesh.communicator());
    if (n_found != n_points_)
      throw NumericalError("Of " + std::to_string(n_points_) + " points on the shell " + std::to_string(n_found) + " were found in the fluid mesh.");
  }


  void
  PointInterpolation::values(const FluidBlockVector &velocity, std::vector<double> &values) const
  {
    values.assign(3 * n_points_, 0.);
    for (unsigned int c = 0; c < 3; ++c)
      {
        const FluidVector &u = velocity.block(c);
        u.update_ghost_values();
        for (std::size_t r = 0; r < local_points_.size(); ++r)
          {
            double sum = 0.;
            for (std::size_t e = row_start_[r]; e < row_start_[r + 1]; ++e)
              sum += entries_[e].value * u.local_element(entries_[e].index);
            values[3 * local_points_[r] + c] = sum;
          }
        u.zero_out_ghost_values();
      }
    dealii::Utilities::MPI::sum(values, space_.mesh.communicator(), values);
  }


  void
  PointInterpolation::values_and_gradients(const FluidBlockVector &velocity, std::vector<double> &values, std::vector<double> &gradients) const
  {
    this->values(velocity, values);
    gradients.assign(9 * n_points_, 0.);
    for (unsigned int c = 0; c < 3; ++c)
      {
        const FluidVector &u = velocity.block(c);
        u.update_ghost_values();
        for (std::size_t r = 0; r < local_points_.size(); ++r)
          for (std::size_t e = row_start_[r]; e < row_start_[r + 1]; ++e)
            for (unsigned int d = 0; d < 3; ++d)
              gradients[9 * local_points_[r] + 3 * c + d] += entries_[e].gradient[d] * u.local_element(entries_[e].index);
        u.zero_out_ghost_values();
      }
    dealii::Utilities::MPI::sum(gradients, space_.mesh.communicator(), gradients);
  }


  void
  PointInterpolation::add_load(const std::vector<double> &forces, const std::vector<double> &moments, FluidBlockVector &load) const
  {
    for (unsigned int c = 0; c < 3; ++c)
      {
        FluidVector &f = load.block(c);
        for (std::size_t r = 0; r < local_points_.size(); ++r)
          {
            const unsigned int q = local_points_[r];
            for (std::size_t e = row_start_[r]; e < row_start_[r + 1]; ++e)
              {
                const Entry &entry = entries_[e];
                double       sum   = entry.value * forces[3 * q + c];
                if (!moments.empty())
                  for (unsigned int d = 0; d < 3; ++d)
                    sum += entry.gradient[d] * moments[9 * q + 3 * c + d];
                f.local_element(entry.index) += sum;
              }
          }
        f.compress(dealii::VectorOperation::add);
      }
  }
} // namespace tanktread
