// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: forces of one shell extended from its points to the vertices of the cells about it, by averages.

#include <tanktread/coupling/vertex_averages.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace tanktread
{
  std::array<double, 8>
  hat_functions(const dealii::Point<3> &x)
  {
    std::array<double, 8> result;
    for (unsigned int v = 0; v < 8; ++v)
      result[v] = (v % 2 ? x[0] : 1. - x[0]) * (v / 2 % 2 ? x[1] : 1. - x[1]) * (v / 4 ? x[2] : 1. - x[2]);
    return result;
  }


  VertexAverages::VertexAverages(std::shared_ptr<const NodeSpace> vertices)
    : vertices_(std::move(vertices))
  {}


  void
  VertexAverages::move(const ShellConfiguration &shell, const PointInterpolation &points, const PointRange &range, const unsigned int first)
  {
    points_ = &points;
    group_points(range);
    hats_.resize(order_.size());
    normals_.resize(order_.size());
    areas_.resize(order_.size());
    for (unsigned int i = 0; i < order_.size(); ++i)
      {
        const unsigned int    q      = points.local_points()[order_[i]] - first;
        const QuadraticPatch &patch  = shell.patches()[q];
        const Eigen::Vector3d normal = patch.a_1.cross(patch.a_2).normalized();
        hats_[i]                     = hat_functions(unit_position(i));
        normals_[i]                  = Vector4(normal.data());
        areas_[i]                    = shell.point_areas()[q];
      }
    set_weights();
  }


  void
  VertexAverages::group_points(const PointRange &range)
  {
    const auto &cells = points_->cells();
    order_.resize(range.end - range.begin);
    std::iota(order_.begin(), order_.end(), range.begin);
    std::stable_sort(order_.begin(), order_.end(), [&](const unsigned int r, const unsigned int s) { return cells[r] < cells[s]; });
    groups_.clear();
    group_of_cell_.assign(vertices_->n_cells(), no_points);
    for (unsigned int i = 0; i < order_.size(); ++i)
      {
        const unsigned int cell = cells[order_[i]];
        if (groups_.empty() || groups_.back().cell != cell)
          {
            group_of_cell_[cell] = groups_.size();
            groups_.push_back({cell, i, i});
          }
        ++groups_.back().end;
      }
  }


  void
  VertexAverages::set_weights()
  {
    VertexArray sums(vertices_->full_size());
    std::fill(sums.begin(), sums.end(), 0.);
    for (const Group &group : groups_)
      {
        const unsigned int *const nodes = vertices_->cell_nodes(group.cell);
        for (unsigned int i = group.begin; i < group.end; ++i)
          for (unsigned int v = 0; v < 8; ++v)
            sums[4 * std::size_t(nodes[v])] += hats_[i][v] * areas_[i];
      }
    vertices_->collect(sums.data());
    inverse_weights_.resize(vertices_->n_owned());
    // Vertices of cut cells that see no point belong to corners that are barely cut: nothing is extended to them.
    for (std::size_t i = 0; i < inverse_weights_.size(); ++i)
      inverse_weights_[i] = sums[4 * i] > 1e-14 ? 1. / sums[4 * i] : 0.;
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
    for (std::size_t i = 0; i < inverse_weights_.size(); ++i)
      for (unsigned int c = 0; c < 4; ++c)
        values[4 * i + c] *= inverse_weights_[i];
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
