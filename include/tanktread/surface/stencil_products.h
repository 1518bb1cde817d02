// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: stencils of one face times vectors at its control points, and the transpose.

#ifndef tanktread_surface_stencil_products_h
#define tanktread_surface_stencil_products_h

#include <tanktread/base/vector4.h>

namespace tanktread
{
  /** Rows of numbers over the control points of a face: row p begins at `begin + p * stride` and has n numbers, a multiple of two. */
  struct StencilRows
  {
    const double *begin;
    unsigned int  stride, n_rows, n;
  };

  /** results[3 p + c] = sum_i rows(p, i) values[i]_c */
  void
  stencil_products(const StencilRows &rows, const Vector4 *values, double *results);

  /** The transpose: field[3 support[i] + c] += sum_p rows(p, i) values[3 p + c]. */
  void
  add_transposed_stencil_products(const StencilRows &rows, const double *values, const int *support, double *field);
} // namespace tanktread

#endif
