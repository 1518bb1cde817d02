// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: forces of shells extended from their points to the vertices of the cells about them, by averages.

#ifndef tanktread_coupling_vertex_averages_h
#define tanktread_coupling_vertex_averages_h

#include <tanktread/base/vector4.h>
#include <tanktread/fluid/point_interpolation.h>
#include <tanktread/shell/shell_configuration.h>

#include <array>
#include <memory>
#include <vector>

namespace tanktread
{
  /** Four numbers at each vertex of this rank's cells: f_t and f_n, or what is dual to them. A full array of the linear NodeSpace with four components. */
  using VertexArray = dealii::AlignedVector<double>;

  /** The same at the vertices of one cell. */
  using VertexForces = std::array<Vector4, 8>;

  /** Consecutive entries among the points of all shells on this rank: those of one shell. */
  struct PointRange
  {
    unsigned int begin = 0, end = 0;
  };

  /** A shell and its points on this rank. */
  struct LocatedShell
  {
    const ShellConfiguration *shell;
    PointRange                range;  // among the points of all shells on this rank
    unsigned int              first;  // number of its first point among those of all shells
    unsigned int              number; // of the shell
  };

  /**
   * f_t and f_n at a vertex x_v are averages of the forces per area at the points X_q of the surface with the mesh's linear hat functions as weights,
   *
   *     f_v = sum_q M_v(X_q) f_q dA_q / max(sum_q M_v(X_q) dA_q, 0.05 h^2),   f_t = f - f_n n,   f_n = f . n,
   *
   * so that f_v vanishes continuously when the last point leaves a vertex. extend() is this map, add_transposed() its transpose. Of several shells at once if no vertex sees two of them.
   */
  class VertexAverages
  {
  public:
    /** @param vertices linear nodes with four components. @param h side of the cells at the shells. */
    VertexAverages(std::shared_ptr<const NodeSpace> vertices, double h);

    /** @param shells in the order of their points. @param points of all shells, kept by reference. Collective. */
    void
    move(std::vector<LocatedShell> shells, const PointInterpolation &points);

    const std::vector<LocatedShell> &
    shells() const
    {
      return shells_;
    }

    /** Vertices of this rank that see points of two shells: there must be none. */
    unsigned int
    n_meetings() const
    {
      return n_meetings_;
    }

    /** A free vertex of this rank that sees points. */
    struct SeeingVertex
    {
      unsigned int node, shell; // the latter's number
      double       inverse_weight;
    };
    const std::vector<SeeingVertex> &
    seeing_vertices() const
    {
      return seeing_vertices_;
    }

    /** @param at_points force times area at the points of all shells on this rank, 3 numbers each. Collective. */
    void
    extend(const std::vector<double> &at_points, VertexArray &at_vertices) const;

    /** values += transpose of extend() times `dual`, whose entries at vertices of other ranks have been added to by this rank; void afterwards. Collective. */
    void
    add_transposed(VertexArray &dual, std::vector<double> &values) const;

    /** Points of one cell: places [begin, end) in the order of cells. */
    struct Group
    {
      unsigned int cell, begin, end, shell; // the latter's place in shells()
    };
    static constexpr unsigned int no_points = static_cast<unsigned int>(-1);

    const std::vector<Group> &
    groups() const
    {
      return groups_;
    }
    /** Number of a cell's group, or no_points. */
    unsigned int
    group_of_cell(unsigned int cell) const;
    unsigned int
    n_points() const
    {
      return order_.size();
    }
    /** Which of the local points of all shells is at place i. */
    unsigned int
    point(const unsigned int i) const
    {
      return order_[i];
    }
    const Vector4 &
    normal(const unsigned int i) const
    {
      return normals_[i];
    }
    /** Area of the point at place i. */
    double
    area(const unsigned int i) const
    {
      return areas_[i];
    }
    const dealii::Point<3> &
    unit_position(const unsigned int i) const
    {
      return points_->unit_positions()[order_[i]];
    }

    /** Of `values` at the vertices of a cell. */
    VertexForces
    at_cell(const VertexArray &values, unsigned int cell) const;
    void
    add_to_cell(unsigned int cell, const VertexForces &forces, VertexArray &values) const;

    const NodeSpace &
    vertices() const
    {
      return *vertices_;
    }

  private:
    void
    group_points();
    void
    set_weights();
    /** Sums over cells and ranks become averages, known at all vertices of this rank's cells. */
    void
    average(VertexArray &values) const;

    std::shared_ptr<const NodeSpace>   vertices_;
    double                             h_;
    const PointInterpolation          *points_ = nullptr;
    std::vector<LocatedShell>          shells_;
    std::vector<unsigned int>          order_;  // local points by cell
    std::vector<Group>                 groups_; // cells ascending
    std::vector<std::array<double, 8>> hats_;   // M_v at the points, in that order
    std::vector<Vector4>               normals_;
    std::vector<double>                areas_;
    std::vector<SeeingVertex>          seeing_vertices_;
    unsigned int                       n_meetings_ = 0;
  };

  /** The trilinear functions of the eight vertices of the unit cube. */
  std::array<double, 8>
  hat_functions(const dealii::Point<3> &x);
} // namespace tanktread

#endif
