// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the strain form adds to the Laplace form in the cells that the shell cuts.

#include <tanktread/base/target_clones.h>
#include <tanktread/coupling/transposed_part.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    inline Vector4
    vector(const std::array<float, 4> &v)
    {
      return {v[0], v[1], v[2]};
    }


    inline double
    dot(const std::array<float, 4> &v, const Vector4 &u)
    {
      return v[0] * u[0] + v[1] * u[1] + v[2] * u[2];
    }


    using Rows = std::array<std::array<std::array<double, 9>, 8>, 27>;

    /** rows[b][v] = factor sum over the nodes a of one side of amplitudes[a][v] (products with b, or those of the whole cell minus them). */
    TANKTREAD_CLONES void
    set_rows(const GradientProducts                      &inside,
             const std::array<bool, 27>                  &node_inside,
             const std::array<std::array<double, 8>, 27> &amplitudes,
             const bool                                   inner,
             const double                                 factor,
             Rows                                        &rows)
    {
      const GradientProducts &whole = whole_gradient_products();
      for (unsigned int b = 0; b < 27; ++b)
        {
          rows[b] = {};
          for (unsigned int a = 0; a < 27; ++a)
            if (node_inside[a] != inner)
              for (unsigned int v = 0; v < 8; ++v)
                for (unsigned int k = 0; k < 9; ++k)
                  rows[b][v][k] += factor * amplitudes[a][v] * (inner ? inside[b][a][k] : whole[b][a][k] - inside[b][a][k]);
        }
    }
  } // namespace


  TransposedPart::TransposedPart(const GradientProducts                      &inside,
                                 const std::array<bool, 27>                  &node_inside,
                                 const std::array<std::array<double, 8>, 27> &amplitudes,
                                 const double                                 ratio)
    : nodes{}
    , self{}
  {
    // psi has the amplitudes of the nodes outside in its inner part, and minus those of the nodes inside in its outer part.
    const bool   inner  = ratio > 1.;
    const double factor = (inner ? 1. : -1.) * (std::max(ratio, 1.) - std::min(ratio, 1.));
    Rows         rows;
    set_rows(inside, node_inside, amplitudes, inner, factor, rows);
    for (unsigned int b = 0; b < 27; ++b)
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int c = 0; c < 3; ++c)
            nodes[b][v][d][c] = rows[b][v][3 * d + c];
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int w = 0; w < 8; ++w)
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int c = 0; c < 3; ++c)
            {
              double sum = 0.;
              for (unsigned int b = 0; b < 27; ++b)
                if (node_inside[b] != inner)
                  sum += (inner ? 1. : -1.) * amplitudes[b][v] * rows[b][w][3 * d + c];
              self[v][w][d][c] = sum;
            }
  }


  void
  TransposedPart::add_loads(const double h, const std::array<Vector4, 8> &f, std::array<Vector4, 27> &loads) const
  {
    for (unsigned int b = 0; b < 27; ++b)
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          loads[b] += (-h * f[v][d]) * vector(nodes[b][v][d]);
  }


  void
  TransposedPart::add_response(const double h, const std::array<Vector4, 27> &u, std::array<Vector4, 8> &r) const
  {
    for (unsigned int v = 0; v < 8; ++v)
      {
        double sum[3] = {};
        for (unsigned int b = 0; b < 27; ++b)
          for (unsigned int d = 0; d < 3; ++d)
            sum[d] += dot(nodes[b][v][d], u[b]);
        r[v] += -h * Vector4(sum);
      }
  }


  void
  TransposedPart::add_self_response(const double h, const std::array<Vector4, 8> &f, std::array<Vector4, 8> &r) const
  {
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int w = 0; w < 8; ++w)
        for (unsigned int d = 0; d < 3; ++d)
          r[v] += (-h * f[w][d]) * vector(self[v][w][d]);
  }
} // namespace tanktread
