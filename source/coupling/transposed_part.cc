// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the strain form adds to the Laplace form in the cells that the shell cuts.

#include <tanktread/base/target_clones.h>
#include <tanktread/coupling/transposed_part.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    using Sums = std::array<std::array<std::array<double, 9>, 8>, 27>;

    /** rows[b][v] = factor sum over the nodes a of one side of amplitudes[a][v] (products with b, or those of the whole cell minus them). */
    TANKTREAD_CLONES void
    set_rows(const GradientProducts                      &inside,
             const std::array<bool, 27>                  &node_inside,
             const std::array<std::array<double, 8>, 27> &amplitudes,
             const bool                                   inner,
             const double                                 factor,
             Sums                                        &rows)
    {
      const GradientProducts &whole = whole_gradient_products();
      for (unsigned int b = 0; b < 27; ++b)
        {
          rows[b] = {};
          for (unsigned int a = 0; a < 27; ++a)
            if (node_inside[a] != inner)
              for (unsigned int v = 0; v < 8; ++v)
                if (amplitudes[a][v] != 0.) // most are, the functions of a vertex vanish at two thirds of the nodes
                  for (unsigned int k = 0; k < 9; ++k)
                    rows[b][v][k] += factor * amplitudes[a][v] * (inner ? inside[b][a][k] : whole[b][a][k] - inside[b][a][k]);
        }
    }


    using Rows = TransposedPart::Rows;

    /** y[c] += factor sum over vertices and d of rows[d][c][vertex] f[d][vertex]. */
    [[gnu::always_inline]] inline void
    add_product(const Rows &rows, const double factor, const double (&f)[3][8], Vector4 &y)
    {
      double sums[3][8] = {};
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int v = 0; v < 8; ++v)
            sums[c][v] += rows[d][c][v] * f[d][v];
      double total[3] = {};
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int v = 0; v < 8; ++v)
          total[c] += sums[c][v];
      y += factor * Vector4(total);
    }


    TANKTREAD_CLONES void
    add_products(const Rows *const rows, const unsigned int n, const double factor, const std::array<Vector4, 8> &f, Vector4 *const y)
    {
      double by_direction[3][8];
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          by_direction[d][v] = f[v][d];
      for (unsigned int b = 0; b < n; ++b)
        add_product(rows[b], factor, by_direction, y[b]);
    }


    /** The transpose. */
    TANKTREAD_CLONES void
    add_transposed_products(const Rows *const rows, const unsigned int n, const double factor, const Vector4 *const u, std::array<Vector4, 8> &r)
    {
      double sums[3][8] = {};
      for (unsigned int b = 0; b < n; ++b)
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int c = 0; c < 3; ++c)
            {
              const double u_c = u[b][c];
              for (unsigned int v = 0; v < 8; ++v)
                sums[d][v] += rows[b][d][c][v] * u_c;
            }
      for (unsigned int v = 0; v < 8; ++v)
        r[v] += factor * Vector4(sums[0][v], sums[1][v], sums[2][v]);
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
    Sums         rows;
    set_rows(inside, node_inside, amplitudes, inner, factor, rows);
    for (unsigned int b = 0; b < 27; ++b)
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int c = 0; c < 3; ++c)
            nodes[b][d][c][v] = rows[b][v][3 * d + c];
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int w = 0; w < 8; ++w)
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int c = 0; c < 3; ++c)
            {
              double sum = 0.;
              for (unsigned int b = 0; b < 27; ++b)
                if (node_inside[b] != inner)
                  sum += (inner ? 1. : -1.) * amplitudes[b][v] * rows[b][w][3 * d + c];
              self[v][d][c][w] = sum;
            }
  }


  void
  TransposedPart::add_loads(const double h, const std::array<Vector4, 8> &f, std::array<Vector4, 27> &loads) const
  {
    add_products(nodes.data(), 27, -h, f, loads.data());
  }


  void
  TransposedPart::add_response(const double h, const std::array<Vector4, 27> &u, std::array<Vector4, 8> &r) const
  {
    add_transposed_products(nodes.data(), 27, -h, u.data(), r);
  }


  void
  TransposedPart::add_self_response(const double h, const std::array<Vector4, 8> &f, std::array<Vector4, 8> &r) const
  {
    add_products(self.data(), 8, -h, f, r.data());
  }
} // namespace tanktread
