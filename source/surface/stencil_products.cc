// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: stencils of one face times vectors at its control points, and the transpose.

#include <tanktread/base/target_clones.h>
#include <tanktread/surface/stencil_products.h>

#include <cstddef>

namespace tanktread
{
  TANKTREAD_CLONES void
  stencil_products(const StencilRows &rows, const Vector4 *const values, double *results)
  {
    const double *row = rows.begin;
    for (unsigned int p = 0; p < rows.n_rows; ++p, row += rows.stride, results += 3)
      {
        Vector4 sum, other; // two chains, neither waits for the other
        for (unsigned int i = 0; i < rows.n; i += 2)
          {
            sum += row[i] * values[i];
            other += row[i + 1] * values[i + 1];
          }
        (sum + other).store(results);
      }
  }


  TANKTREAD_CLONES void
  add_transposed_stencil_products(const StencilRows &rows, const double *const values, const int *const support, double *const field)
  {
    for (unsigned int i = 0; i < rows.n; ++i)
      {
        double *const entry = field + 3 * std::size_t(support[i]);
        Vector4       sum(entry);
        for (unsigned int p = 0; p < rows.n_rows; ++p)
          sum += rows.begin[std::size_t(p) * rows.stride + i] * Vector4(values + 3 * std::size_t(p));
        sum.store(entry);
      }
  }
} // namespace tanktread
