// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: forces of shells extended from their points to the vertices of the cells about them, by averages.

#include <tanktread/coupling/vertex_averages.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tanktread
{
  namespace
  {
    /**
     * Of a vertex, in squares of a cell's side: a plane through it weighs 1, one that passes at a distance of d cells 1 - d. With less than this the average is taken
     * for a part of one, which vanishes with the weight.
     */
    constexpr double least_weight = 0.05;
  } // namespace


  std::array<double, 8>
  hat_functions(const dealii::Point<3> &x)
  {
    std::array<double, 8> result;
    for (unsigned int v = 0; v < 8; ++v)
      result[v] = (v % 2 ? x[0] : 1. - x[0]) * (v / 2 % 2 ? x[1] : 1. - x[1]) * (v / 4 ? x[2] : 1. - x[2]);
    return result;
  }


  VertexAverages::VertexAverages(std::shared_ptr<const NodeSpace> vertices, const double h)
    : vertices_(std::move(vertices))
    , h_(h)
  {}


  void
  VertexAverages::move(std::vector<LocatedShell> shells, const PointInterpolation &points)
  {
    shells_ = std::move(shells);
    points_ = &points;
    group_points();
    hats_.resize(order_.size());
    normals_.resize(order_.size());
    areas_.resize(order_.size());
    for (const Group &group : groups_)
      for (unsigned int i = group.begin; i < group.end; ++i)
        {
          const LocatedShell   &points_of = shells_[group.shell];
          const unsigned int    q         = points.local_points()[order_[i]] - points_of.first;
          const QuadraticPatch &patch     = points_of.shell->patches()[q];
          const Eigen::Vector3d normal    = patch.a_1.cross(patch.a_2).normalized();
          hats_[i]                        = hat_functions(unit_position(i));
          normals_[i]                     = Vector4(normal.data());
          areas_[i]                       = points_of.shell->point_areas()[q];
        }
    set_weights();
  }


  void
  VertexAverages::group_points()
  {
    const auto &cells = points_->cells();
    // Shells are sorted one by one: should two be in one cell, they are two groups, and set_weights() will notice.
    groups_.clear();
    order_.clear();
    for (unsigned int c = 0; c < shells_.size(); ++c)
      {
        const std::size_t first = order_.size();
        order_.resize(first + shells_[c].range.end - shells_[c].range.begin);
        std::iota(order_.begin() + first, order_.end(), shells_[c].range.begin);
        std::stable_sort(order_.begin() + first, order_.end(), [&](const unsigned int r, const unsigned int s) { return cells[r] < cells[s]; });
        for (unsigned int i = first; i < order_.size(); ++i)
          {
            const unsigned int cell = cells[order_[i]];
            if (i == first || groups_.back().cell != cell)
              groups_.push_back({cell, i, i, c});
            ++groups_.back().end;
          }
      }
    std::stable_sort(groups_.begin(), groups_.end(), [](const Group &a, const Group &b) { return a.cell < b.cell; });
  }


  unsigned int
  VertexAverages::group_of_cell(const unsigned int cell) const
  {
    const auto found = std::partition_point(groups_.begin(), groups_.end(), [cell](const Group &group) { return group.cell < cell; });
    return found != groups_.end() && found->cell == cell ? found - groups_.begin() : no_points;
  }


  void
  VertexAverages::set_weights()
  {
    // With each weight the number of the shell and its square: where their variance is not zero, two shells meet.
    VertexArray sums(vertices_->full_size());
    std::fill(sums.begin(), sums.end(), 0.);
    for (const Group &group : groups_)
      {
        const unsigned int *const nodes  = vertices_->cell_nodes(group.cell);
        const double              number = shells_[group.shell].number;
        for (unsigned int i = group.begin; i < group.end; ++i)
          for (unsigned int v = 0; v < 8; ++v)
            {
              const double  weight = hats_[i][v] * areas_[i];
              double *const sum    = &sums[4 * std::size_t(nodes[v])];
              (Vector4::of_four(sum) + Vector4(weight, weight * number, weight * number * number)).store_four(sum);
            }
      }
    vertices_->collect(sums.data());
    seeing_vertices_.clear();
    const double least = least_weight * h_ * h_;
    n_meetings_        = 0;
    for (unsigned int i = 0; i < vertices_->n_owned(); ++i)
      if (const double *const sum = &sums[4 * std::size_t(i)]; sum[0] != 0.)
        {
          const double mean = sum[1] / sum[0];
          seeing_vertices_.push_back({i, static_cast<unsigned int>(std::lround(mean)), 1. / std::max(sum[0], least)});
          n_meetings_ += sum[2] / sum[0] - mean * mean > 1e-12 * (1. + mean * mean);
        }
  }


  VertexForces
  VertexAverages::at_cell(const VertexArray &values, const unsigned int cell) const
  {
    const unsigned int *const nodes = vertices_->cell_nodes(cell);
    VertexForces              result;
    for (unsigned int v = 0; v < 8; ++v)
      {
        result[v] = Vector4::of_four(&values[4 * std::size_t(nodes[v])]);
      }
    return result;
  }


  void
  VertexAverages::add_to_cell(const unsigned int cell, const VertexForces &forces, VertexArray &values) const
  {
    const unsigned int *const nodes = vertices_->cell_nodes(cell);
    for (unsigned int v = 0; v < 8; ++v)
      {
        double *const value = &values[4 * std::size_t(nodes[v])];
        (Vector4::of_four(value) + forces[v]).store_four(value);
      }
  }


  void
  VertexAverages::average(VertexArray &values) const
  {
    vertices_->collect(values.data());
    for (const SeeingVertex &vertex : seeing_vertices_)
      for (unsigned int c = 0; c < 4; ++c)
        values[4 * std::size_t(vertex.node) + c] *= vertex.inverse_weight;
    vertices_->update(values.data());
  }


  void
  VertexAverages::extend(const std::vector<double> &at_points, VertexArray &at_vertices) const
  {
    at_vertices.resize_fast(vertices_->full_size());
    std::fill(at_vertices.begin(), at_vertices.end(), 0.);
    for (const Group &group : groups_)
      {
        VertexForces sums;
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            const Vector4 f(&at_points[3 * std::size_t(order_[i])]), n = normals_[i];
            const double  f_n  = f[0] * n[0] + f[1] * n[1] + f[2] * n[2];
            const Vector4 both = f + -f_n * n + Vector4(0., 0., 0., f_n);
            for (unsigned int v = 0; v < 8; ++v)
              sums[v] += hats_[i][v] * both;
          }
        add_to_cell(group.cell, sums, at_vertices);
      }
    average(at_vertices);
  }


  void
  VertexAverages::add_transposed(VertexArray &dual, std::vector<double> &values) const
  {
    average(dual);
    for (const Group &group : groups_)
      {
        const VertexForces r = at_cell(dual, group.cell);
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            Vector4 both;
            for (unsigned int v = 0; v < 8; ++v)
              both += hats_[i][v] * r[v];
            const Vector4 n      = normals_[i];
            const double  factor = both[3] - (both[0] * n[0] + both[1] * n[1] + both[2] * n[2]);
            double *const value  = &values[3 * std::size_t(order_[i])];
            (Vector4(value) + both + factor * n).store(value);
          }
      }
  }
} // namespace tanktread
