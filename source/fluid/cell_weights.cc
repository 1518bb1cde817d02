// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: quadrature over the part of a cube that lies inside the shell.

#include <tanktread/base/target_clones.h>
#include <tanktread/fluid/cell_weights.h>
#include <tanktread/fluid/quadratic_element.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tanktread
{
  namespace
  {
    using Vector3 = std::array<double, 3>;

    Vector3
    operator-(const Vector3 &a, const Vector3 &b)
    {
      return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    }
    double
    dot(const Vector3 &a, const Vector3 &b)
    {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    Vector3
    cross(const Vector3 &a, const Vector3 &b)
    {
      return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }


    constexpr int n_gauss = 5;

    /** Places for the Gauss points of an axis in a vector register; the last ones are zero. */
    constexpr int n_lanes = 8;

    /** Coefficients by rising power of the polynomials that are one at one of the Gauss points and zero at the others: [power][point]. */
    struct LagrangePolynomials
    {
      double coefficient[n_gauss][n_lanes] = {};

      LagrangePolynomials()
      {
        const std::array<double, n_gauss> &points = fine_gauss_abscissae();
        for (int g = 0; g < n_gauss; ++g)
          {
            double c[n_gauss] = {1.};
            for (int other = 0, degree = 0; other < n_gauss; ++other)
              if (other != g)
                {
                  const double scale = 1. / (points[g] - points[other]);
                  ++degree;
                  for (int k = degree; k >= 0; --k)
                    c[k] = scale * ((k > 0 ? c[k - 1] : 0.) - points[other] * c[k]);
                }
            for (int k = 0; k < n_gauss; ++k)
              coefficient[k][g] = c[k];
          }
      }
    };

    const LagrangePolynomials lagrange;


    /** Points with weights: of a cell, in eight boxes of six tetrahedra, each cut into three at most, with two slivers. */
    struct WeightedPoints
    {
      struct Point
      {
        Vector3 x;
        double  weight;
      };

      void
      add(const Vector3 &x, const double weight)
      {
        points[n++] = {x, weight};
      }

      int                                 n = 0;
      std::array<Point, 8 * 6 * (12 + 6)> points;
    };


    /** Adds what the points are at the 5 x 5 x 5 Gauss points. */
    TANKTREAD_CLONES void
    condense(const int n, const WeightedPoints::Point *const points, CellWeights &weights)
    {
      double sums[n_gauss * n_gauss][n_lanes] = {};
      for (int q = 0; q < n; ++q)
        {
          double l[3][n_lanes];
          for (int d = 0; d < 3; ++d)
            for (int g = 0; g < n_lanes; ++g)
              {
                const double x = points[q].x[d];
                const auto  &c = lagrange.coefficient;
                l[d][g]        = c[0][g] + x * (c[1][g] + x * (c[2][g] + x * (c[3][g] + x * c[4][g])));
              }
          for (int k = 0; k < n_gauss; ++k)
            for (int j = 0; j < n_gauss; ++j)
              {
                const double factor = points[q].weight * l[2][k] * l[1][j];
                for (int i = 0; i < n_lanes; ++i)
                  sums[n_gauss * k + j][i] += factor * l[0][i];
              }
        }
      for (int line = 0; line < n_gauss * n_gauss; ++line)
        for (int i = 0; i < n_gauss; ++i)
          weights[n_gauss * line + i] += sums[line][i];
    }


    /** All of a box with one corner at `low`. */
    CellWeights
    box_weights(const Vector3 &low, const double size)
    {
      // Three Gauss points integrate degree four exactly.
      static const UnitGauss<3> rule;
      const auto               &points = rule.abscissa, &w = rule.weight;
      WeightedPoints            all;
      for (int q = 0; q < 27; ++q)
        all.add({low[0] + size * points[q % 3], low[1] + size * points[q / 3 % 3], low[2] + size * points[q / 9]},
                size * size * size * w[q % 3] * w[q / 3 % 3] * w[q / 9]);
      CellWeights result = {};
      condense(all.n, all.points.data(), result);
      return result;
    }


    /** Of the eight boxes of half the size. */
    const std::array<CellWeights, 8> &
    half_box_weights()
    {
      static const auto result = [] {
        std::array<CellWeights, 8> weights;
        for (int corner = 0; corner < 8; ++corner)
          weights[corner] = box_weights({0.5 * (corner % 2), 0.5 * (corner / 2 % 2), 0.5 * (corner / 4)}, 0.5);
        return weights;
      }();
      return result;
    }


    /** The quadratic interpolant of nodal values, its value and gradient. */
    double
    evaluate(const std::array<double, 27> &phi, const Vector3 &x, Vector3 &gradient)
    {
      const std::array<double, 3> v[3] = {quadratic_values(x[0]), quadratic_values(x[1]), quadratic_values(x[2])},
                                  d[3] = {quadratic_slopes(x[0]), quadratic_slopes(x[1]), quadratic_slopes(x[2])};
      double value                     = 0.;
      gradient                         = {0., 0., 0.};
      for (int k = 0; k < 3; ++k)
        {
          double plane = 0., plane_x = 0., plane_y = 0.;
          for (int j = 0; j < 3; ++j)
            {
              const double *const p    = &phi[3 * j + 9 * k];
              const double        line = v[0][0] * p[0] + v[0][1] * p[1] + v[0][2] * p[2];
              plane += v[1][j] * line;
              plane_y += d[1][j] * line;
              plane_x += v[1][j] * (d[0][0] * p[0] + d[0][1] * p[1] + d[0][2] * p[2]);
            }
          value += v[2][k] * plane;
          gradient[0] += v[2][k] * plane_x;
          gradient[1] += v[2][k] * plane_y;
          gradient[2] += d[2][k] * plane;
        }
      return value;
    }


    struct Vertex
    {
      Vector3 x;
      double  phi;
    };
    using Tetrahedron = std::array<Vertex, 4>;


    /** The point of an edge where the linear phi is zero. */
    Vertex
    zero_between(const Vertex &a, const Vertex &b)
    {
      const double t = a.phi / (a.phi - b.phi);
      return {{a.x[0] + t * (b.x[0] - a.x[0]), a.x[1] + t * (b.x[1] - a.x[1]), a.x[2] + t * (b.x[2] - a.x[2])}, 0.};
    }


    void
    add_tetrahedron(const Vector3 &a, const Vector3 &b, const Vector3 &c, const Vector3 &d, WeightedPoints &points)
    {
      // Four points, exact for degree two.
      constexpr double near = 0.58541019662496845, far = 0.13819660112501051;
      const double     weight    = std::abs(dot(cross(b - a, c - a), d - a)) / 24.;
      const Vector3   *corner[4] = {&a, &b, &c, &d};
      for (int q = 0; q < 4; ++q)
        {
          Vector3 x = {0., 0., 0.};
          for (int v = 0; v < 4; ++v)
            for (int e = 0; e < 3; ++e)
              x[e] += (v == q ? near : far) * (*corner[v])[e];
          points.add(x, weight);
        }
    }


    /** The sliver between a flat triangle of the cut and the zero of the quadratic phi; `outward` is the normal of the triangle with length twice its area. */
    void
    add_sliver(const std::array<double, 27> &phi, const Vector3 &a, const Vector3 &b, const Vector3 &c, const Vector3 &uphill, WeightedPoints &points)
    {
      Vector3      normal = cross(b - a, c - a);
      const double length = std::sqrt(dot(normal, normal));
      if (length < 1e-14)
        return;
      const double sign = dot(normal, uphill) < 0. ? -1. / length : 1. / length;
      for (double &n : normal)
        n *= sign;
      const Vector3 *corner[3] = {&a, &b, &c};
      for (int q = 0; q < 3; ++q)
        {
          Vector3 x, gradient;
          for (int e = 0; e < 3; ++e)
            x[e] = ((*corner[0])[e] + (*corner[1])[e] + (*corner[2])[e]) / 6. + 0.5 * (*corner[q])[e];
          const double value = evaluate(phi, x, gradient), slope = dot(gradient, normal);
          // Where the interpolant turns away from the cut there is no sliver to speak of.
          if (slope < 0.1)
            continue;
          const double delta = std::clamp(-value / slope, -0.25, 0.25);
          for (int e = 0; e < 3; ++e)
            x[e] += 0.5 * delta * normal[e];
          points.add(x, delta * length / 6.);
        }
    }


    /** The part of a tetrahedron where phi, linear in it, is negative, and the sliver on its cut. */
    void
    add_negative_part(const std::array<double, 27> &phi, Tetrahedron t, WeightedPoints &points)
    {
      // By values, not by numbers, so that a cell and its mirror image are divided alike.
      std::sort(t.begin(), t.end(), [](const Vertex &v, const Vertex &w) { return v.phi < w.phi; });
      const auto middle     = std::find_if(t.begin(), t.end(), [](const Vertex &v) { return !(v.phi < 0.); });
      const auto n_negative = middle - t.begin();
      if (n_negative == 0)
        return;
      if (n_negative == 4)
        return add_tetrahedron(t[0].x, t[1].x, t[2].x, t[3].x, points);
      // From a negative vertex to a positive one phi rises.
      const Vector3 uphill = [&] {
        Vector3 inside = {0., 0., 0.}, outside = {0., 0., 0.};
        for (auto v = t.begin(); v != t.end(); ++v)
          for (int e = 0; e < 3; ++e)
            (v < middle ? inside : outside)[e] += v->x[e] / (v < middle ? n_negative : 4 - n_negative);
        return outside - inside;
      }();
      if (n_negative == 1)
        {
          const Vector3 p = zero_between(t[0], t[1]).x, q = zero_between(t[0], t[2]).x, r = zero_between(t[0], t[3]).x;
          add_tetrahedron(t[0].x, p, q, r, points);
          add_sliver(phi, p, q, r, uphill, points);
        }
      else if (n_negative == 3)
        {
          const Vector3 p = zero_between(t[0], t[3]).x, q = zero_between(t[1], t[3]).x, r = zero_between(t[2], t[3]).x;
          // The prism between the triangles t0 t1 t2 and p q r.
          add_tetrahedron(t[0].x, t[1].x, t[2].x, r, points);
          add_tetrahedron(t[0].x, t[1].x, q, r, points);
          add_tetrahedron(t[0].x, p, q, r, points);
          add_sliver(phi, p, q, r, uphill, points);
        }
      else
        {
          const Vector3 p = zero_between(t[0], t[2]).x, q = zero_between(t[0], t[3]).x, r = zero_between(t[1], t[2]).x, s = zero_between(t[1], t[3]).x;
          // The prism between the triangles t0 p q and t1 r s.
          add_tetrahedron(t[0].x, p, q, s, points);
          add_tetrahedron(t[0].x, p, r, s, points);
          add_tetrahedron(t[0].x, t[1].x, r, s, points);
          add_sliver(phi, p, q, s, uphill, points);
          add_sliver(phi, p, r, s, uphill, points);
        }
    }


    void
    add_half_box(const std::array<double, 27> &phi, const int corner, WeightedPoints &points, CellWeights &weights)
    {
      const int i0 = corner % 2, j0 = corner / 2 % 2, k0 = corner / 4;
      Vertex    vertex[8];
      int       n_negative = 0;
      for (int v = 0; v < 8; ++v)
        {
          const int i = i0 + v % 2, j = j0 + v / 2 % 2, k = k0 + v / 4;
          vertex[v] = {{0.5 * i, 0.5 * j, 0.5 * k}, phi[i + 3 * j + 9 * k]};
          n_negative += vertex[v].phi < 0.;
        }
      if (n_negative == 8)
        for (std::size_t g = 0; g < weights.size(); ++g)
          weights[g] += half_box_weights()[corner][g];
      else if (n_negative > 0)
        // Around the diagonal from 0 to 7: one tetrahedron for each order in which the axes can be walked along.
        for (const auto &[first, second] : {std::pair{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}})
          add_negative_part(phi, {vertex[0], vertex[first], vertex[second], vertex[7]}, points);
    }
  } // namespace


  const CellWeights &
  whole_weights()
  {
    static const CellWeights result = box_weights({0., 0., 0.}, 1.);
    return result;
  }


  CellWeights
  inside_weights(const std::array<double, 27> &phi)
  {
    WeightedPoints points;
    CellWeights    result = {};
    for (int corner = 0; corner < 8; ++corner)
      add_half_box(phi, corner, points, result);
    condense(points.n, points.points.data(), result);
    return result;
  }


  const std::array<double, 5> &
  fine_gauss_abscissae()
  {
    static const std::array<double, 5> result = UnitGauss<5>().abscissa;
    return result;
  }
} // namespace tanktread
