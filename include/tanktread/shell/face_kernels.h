// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the three products with a face's stencils in which the shell spends its time.

#ifndef tanktread_shell_face_kernels_h
#define tanktread_shell_face_kernels_h

#include <cstddef>

namespace tanktread
{
  /**
   * The stencils of a face: point k has `n_rows` rows of length `n`, the first at values + k * stride. 3-vectors are padded to 4 numbers (x, y, z, 0) in all
   * functions below. On x86 the functions exist for AVX2 and for any processor; the loader chooses.
   */
  struct FaceStencils
  {
    const double *values;
    unsigned int  stride, n_points, n_rows, n;
  };

  /** y[k n_rows + p] = sum_i stencil(k, p, i) x[i]. */
  void
  apply_stencils(const FaceStencils &face, const double *x, double *y);

  /** f[i] += sum_kp stencil(k, p, i) g[k n_rows + p]. */
  void
  add_transposed_stencils(const FaceStencils &face, const double *g, double *f);

  /**
   * block[c][d][i][j] = sum_kpq stencil(k, p, i) H_k[3 p + c][3 q + d] stencil(k, q, j), 9 n^2 numbers. H_k begins at hessians + 225 k and has rows of length
   * 15,
   * of which the first 3 n_rows are used. With `symmetric` all H_k have to be symmetric, and a third of the work is saved. `scratch` has room for
   * 4 n_rows n numbers.
   */
  void
  stencil_congruence(const FaceStencils &face, const double *hessians, bool symmetric, double *scratch, double *block);
} // namespace tanktread

#endif
