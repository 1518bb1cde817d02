// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: velocities and their gradients at arbitrary points, and the adjoint.

#include <deal.II/base/mpi.h>

#include <tanktread/base/counts.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/target_clones.h>
#include <tanktread/base/vector4.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/fluid/quadratic_element.h>

#include <array>
#include <cmath>
#include <string>

namespace tanktread
{
  namespace
  {
    /** Velocities or loads at the nodes of a cell: entry [3 k + j][i] for node (i, j, k). */
    using CellValues = Vector4[9][3];

    /** Quadratic Lagrange polynomials with nodes 0, 1/2, 1 along the three axes, and their derivatives with respect to positions in space. */
    struct Shapes
    {
      Shapes(const dealii::Point<3> &unit, const double inverse_size)
      {
        for (unsigned int d = 0; d < 3; ++d)
          {
            value[d] = quadratic_values(unit[d]);
            slope[d] = quadratic_slopes(unit[d]);
            for (double &s : slope[d])
              s *= inverse_size;
          }
      }

      std::array<double, 3> value[3], slope[3];
    };


    /** sum_i factors[i] rows[i] */
    inline Vector4
    combine(const std::array<double, 3> &factors, const Vector4 (&rows)[3])
    {
      return factors[0] * rows[0] + factors[1] * rows[1] + factors[2] * rows[2];
    }


    inline void
    evaluate(const CellValues &u, const Shapes &s, double *const value)
    {
      Vector4 result;
      for (unsigned int k = 0; k < 3; ++k)
        {
          Vector4 plane;
          for (unsigned int j = 0; j < 3; ++j)
            plane += s.value[1][j] * combine(s.value[0], u[3 * k + j]);
          result += s.value[2][k] * plane;
        }
      result.store(value);
    }


    /** The value too, unless null. */
    inline void
    evaluate_gradient(const CellValues &u, const Shapes &s, double *const value, double *const gradient)
    {
      Vector4 result, derivatives[3];
      for (unsigned int k = 0; k < 3; ++k)
        {
          Vector4 plane, plane_x, plane_y;
          for (unsigned int j = 0; j < 3; ++j)
            {
              const Vector4 line = combine(s.value[0], u[3 * k + j]);
              plane += s.value[1][j] * line;
              plane_x += s.value[1][j] * combine(s.slope[0], u[3 * k + j]);
              plane_y += s.slope[1][j] * line;
            }
          derivatives[0] += s.value[2][k] * plane_x;
          derivatives[1] += s.value[2][k] * plane_y;
          derivatives[2] += s.slope[2][k] * plane;
          result += s.value[2][k] * plane;
        }
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          gradient[3 * c + d] = derivatives[d][c];
      if (value != nullptr)
        result.store(value);
    }


    /** Of the velocities of a cell of size one. */
    Vector4
    laplacian(const CellValues &u, const Shapes &s)
    {
      const std::array<double, 3> &x = s.value[0], &y = s.value[1], &z = s.value[2], &second = quadratic_curvatures;
      Vector4                      result;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int j = 0; j < 3; ++j)
          result += (y[j] * z[k]) * combine(second, u[3 * k + j]) + (second[j] * z[k] + y[j] * second[k]) * combine(x, u[3 * k + j]);
      return result;
    }


    /** Adds the functional v -> F . v to `load`. */
    inline void
    integrate(const Shapes &s, const double *const F, CellValues &load)
    {
      const Vector4 force(F);
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int j = 0; j < 3; ++j)
          {
            const Vector4 line = (s.value[2][k] * s.value[1][j]) * force;
            for (unsigned int i = 0; i < 3; ++i)
              load[3 * k + j][i] += s.value[0][i] * line;
          }
    }


    /** Adds the functional v -> F . v + G : grad v to `load`. */
    inline void
    integrate(const Shapes &s, const double *const F, const double *const G, CellValues &load)
    {
      const Vector4 force(F), g_x(G[0], G[3], G[6]), g_y(G[1], G[4], G[7]), g_z(G[2], G[5], G[8]);
      for (unsigned int k = 0; k < 3; ++k)
        {
          const Vector4 plane = s.value[2][k] * force + s.slope[2][k] * g_z, plane_x = s.value[2][k] * g_x, plane_y = s.value[2][k] * g_y;
          for (unsigned int j = 0; j < 3; ++j)
            {
              const Vector4 line = s.value[1][j] * plane + s.slope[1][j] * plane_y, line_x = s.value[1][j] * plane_x;
              for (unsigned int i = 0; i < 3; ++i)
                load[3 * k + j][i] += s.value[0][i] * line + s.slope[0][i] * line_x;
            }
        }
    }


    /** Values at n points of a cell, those numbered `points`; positions and results are by number. */
    TANKTREAD_CLONES void
    evaluate_all(const CellValues &u, const dealii::Point<3> *const positions, const unsigned int *const points, const unsigned int n, double *const values)
    {
      for (unsigned int i = 0; i < n; ++i)
        evaluate(u, Shapes(positions[points[i]], 1.), values + 3 * std::size_t(points[i]));
    }


    /** The transpose: adds to `load`. */
    TANKTREAD_CLONES void
    integrate_all(const dealii::Point<3> *const positions, const unsigned int *const points, const unsigned int n, const double *const forces, CellValues &load)
    {
      for (unsigned int i = 0; i < n; ++i)
        integrate(Shapes(positions[points[i]], 1.), forces + 3 * std::size_t(points[i]), load);
    }


    /** Velocities at the nodes of a cell from those at owned and ghost nodes. */
    void
    gather(const NodeSpace &space, const unsigned int cell, const double *const values, CellValues &result)
    {
      const unsigned int *const nodes = space.cell_nodes(cell);
      for (unsigned int a = 0; a < 27; ++a)
        {
          Vector4 u;
          if (space.is_free(nodes[a]))
            u = Vector4(values + std::size_t(3) * nodes[a]);
          else
            for (const auto &[node, weight] : space.masters(nodes[a]))
              u += weight * Vector4(values + std::size_t(3) * node);
          result[a / 3][a % 3] = u;
        }
    }


    /** The transpose: adds to owned and ghost nodes. */
    void
    scatter(const NodeSpace &space, const unsigned int cell, const CellValues &load, double *const values)
    {
      const unsigned int *const nodes = space.cell_nodes(cell);
      for (unsigned int a = 0; a < 27; ++a)
        {
          const Vector4 &f = load[a / 3][a % 3];
          if (space.is_free(nodes[a]))
            {
              double *const value = values + std::size_t(3) * nodes[a];
              (Vector4(value) + f).store(value);
            }
          else
            for (const auto &[node, weight] : space.masters(nodes[a]))
              {
                double *const value = values + std::size_t(3) * node;
                (Vector4(value) + weight * f).store(value);
              }
        }
    }
  } // namespace


  PointInterpolation::PointInterpolation(const TaylorHoodSpace &space)
    : space_(space)
    , locator_(space.mesh)
  {}


  void
  PointInterpolation::reinit(const std::vector<dealii::Point<3>> &points)
  {
    reinit(points, points.size());
  }


  void
  PointInterpolation::reinit(const std::vector<dealii::Point<3>> &points, const std::size_t n_all)
  {
    local_points_.clear();
    unit_.clear();
    cells_.clear();
    const unsigned int n_points = index_count(points.size(), "points on the shells");
    on_all_ranks(space_.mesh.communicator(), [&] {
      for (unsigned int q = 0; q < n_points; ++q)
        {
          const CellLocator::Location location = locator_.locate(points[q]);
          if (location.cell < 0)
            continue;
          local_points_.push_back(q);
          unit_.push_back(location.unit);
          cells_.push_back(location.cell);
        }
    });
    const std::size_t n_found = dealii::Utilities::MPI::sum(local_points_.size(), space_.mesh.communicator());
    if (n_found != n_all)
      throw NumericalError("Of " + std::to_string(n_all) + " points on the shells " + std::to_string(n_found) + " were found in the fluid mesh.");
    sort_by_cell();
  }


  void
  PointInterpolation::sort_by_cell()
  {
    const unsigned int n = cells_.size();
    starts_.assign(space_.velocity->n_cells() + 1, 0);
    for (const unsigned int cell : cells_)
      ++starts_[cell + 1];
    groups_.clear();
    for (unsigned int cell = 0; cell + 1 < starts_.size(); ++cell)
      {
        if (starts_[cell + 1] > 0)
          groups_.push_back({cell, starts_[cell], starts_[cell] + starts_[cell + 1]});
        starts_[cell + 1] += starts_[cell];
      }
    order_.resize(n);
    for (unsigned int r = 0; r < n; ++r)
      order_[starts_[cells_[r]]++] = r;
  }


  template <typename Function>
  void
  PointInterpolation::for_groups(const FluidBlockVector &velocity, const Function &evaluate_in) const
  {
    const NodeSpace   &nodes = *space_.velocity;
    const FluidVector &u     = velocity.block(velocity_block);
    u.update_ghost_values();
    CellValues local;
    for (const Group &group : groups_)
      {
        gather(nodes, group.cell, u.begin(), local);
        evaluate_in(group, local);
      }
    u.zero_out_ghost_values();
  }


  template <typename Function>
  void
  PointInterpolation::for_points(const FluidBlockVector &velocity, const Function &evaluate_at) const
  {
    for_groups(velocity, [&](const Group &group, const CellValues &u) {
      const double inverse_size = 1. / space_.velocity->cell_sizes()[group.cell];
      for (unsigned int i = group.begin; i < group.end; ++i)
        evaluate_at(order_[i], u, Shapes(unit_[order_[i]], inverse_size));
    });
  }


  void
  PointInterpolation::values(const FluidBlockVector &velocity, std::vector<double> &values) const
  {
    values.resize(3 * local_points_.size());
    for_groups(velocity,
               [&](const Group &group, const CellValues &u) { evaluate_all(u, unit_.data(), &order_[group.begin], group.end - group.begin, values.data()); });
  }


  void
  PointInterpolation::gradients(const FluidBlockVector &velocity, std::vector<double> &gradients) const
  {
    gradients.resize(9 * local_points_.size());
    for_points(velocity,
               [&](const unsigned int r, const CellValues &u, const Shapes &shapes) { evaluate_gradient(u, shapes, nullptr, &gradients[9 * std::size_t(r)]); });
  }


  void
  PointInterpolation::laplacians(const FluidBlockVector &velocity, std::vector<double> &laplacians) const
  {
    laplacians.resize(3 * local_points_.size());
    for_groups(velocity, [&](const Group &group, const CellValues &u) {
      const double inverse_square = std::pow(space_.velocity->cell_sizes()[group.cell], -2);
      for (unsigned int i = group.begin; i < group.end; ++i)
        (inverse_square * laplacian(u, Shapes(unit_[order_[i]], 1.))).store(&laplacians[3 * std::size_t(order_[i])]);
    });
  }


  void
  PointInterpolation::values_and_gradients(const FluidBlockVector &velocity, std::vector<double> &values, std::vector<double> &gradients) const
  {
    values.resize(3 * local_points_.size());
    gradients.resize(9 * local_points_.size());
    for_points(velocity, [&](const unsigned int r, const CellValues &u, const Shapes &shapes) {
      evaluate_gradient(u, shapes, &values[3 * std::size_t(r)], &gradients[9 * std::size_t(r)]);
    });
  }


  void
  PointInterpolation::add_load(const std::vector<double> &forces, const std::vector<double> &moments, FluidBlockVector &load) const
  {
    const NodeSpace &nodes = *space_.velocity;
    FluidVector     &f     = load.block(velocity_block);
    CellValues       local;
    for (const Group &group : groups_)
      {
        for (auto &line : local)
          for (Vector4 &node : line)
            node = Vector4();
        const double inverse_size = 1. / nodes.cell_sizes()[group.cell];
        if (moments.empty())
          integrate_all(unit_.data(), &order_[group.begin], group.end - group.begin, forces.data(), local);
        else
          for (unsigned int i = group.begin; i < group.end; ++i)
            integrate(Shapes(unit_[order_[i]], inverse_size), &forces[3 * std::size_t(order_[i])], &moments[9 * std::size_t(order_[i])], local);
        scatter(nodes, group.cell, local, f.begin());
      }
    f.compress(dealii::VectorOperation::add);
  }
} // namespace tanktread
