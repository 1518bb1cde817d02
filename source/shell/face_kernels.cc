// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the three products with a face's stencils in which the shell spends its time.

#include <tanktread/base/target_clones.h>
#include <tanktread/shell/face_kernels.h>

#include <algorithm>

#define TANKTREAD_INLINE __attribute__((always_inline)) inline

namespace tanktread
{
  namespace
  {
    /** Four numbers at any address. */
    using Vector4 = double __attribute__((vector_size(32), aligned(8), may_alias));

    TANKTREAD_INLINE Vector4 &
    at(double *p)
    {
      return *reinterpret_cast<Vector4 *>(p);
    }

    TANKTREAD_INLINE const Vector4 &
    at(const double *p)
    {
      return *reinterpret_cast<const Vector4 *>(p);
    }

    /** Most points that are taken at once in stencil_congruence(). */
    constexpr unsigned int max_chunk = 4;

    /**
     * Adds the part of `n_points` <= max_chunk points to one plane (c, d) of the block. First u = H_cd S at all points, then S^T u, four rows of
     * it at a time in registers. N is the support size if known when compiling, else 0.
     */
    template <unsigned int N>
    TANKTREAD_INLINE void
    add_plane(const FaceStencils &face, const unsigned int first, const unsigned int n_points, const double *hessians, double *u, double *plane)
    {
      const unsigned int n = N > 0 ? N : face.n, n_rows = face.n_rows;
      for (unsigned int k = 0; k < n_points; ++k)
        {
          const double *stencils = face.values + std::size_t(first + k) * face.stride;
          for (unsigned int p = 0; p < n_rows; ++p)
            {
              const double *h = hessians + 225 * (first + k) + 45 * p;
              for (unsigned int j = 0; j < n; j += 4)
                {
                  Vector4 sum = h[0] * at(stencils + j);
                  for (unsigned int q = 1; q < n_rows; ++q)
                    sum += h[3 * q] * at(stencils + q * n + j);
                  at(u + (k * n_rows + p) * n + j) = sum;
                }
            }
        }
      for (unsigned int i = 0; i < n; i += 4)
        for (unsigned int j = 0; j < n; j += 12)
          {
            const unsigned int width = std::min(n - j, 12u) / 4;
            Vector4            sum[4][3];
            for (unsigned int r = 0; r < 4; ++r)
              for (unsigned int b = 0; b < width; ++b)
                sum[r][b] = at(plane + (i + r) * n + j + 4 * b);
            for (unsigned int k = 0; k < n_points; ++k)
              for (unsigned int p = 0; p < n_rows; ++p)
                {
                  const double *left = face.values + std::size_t(first + k) * face.stride + p * n + i, *right = u + (k * n_rows + p) * n + j;
                  for (unsigned int r = 0; r < 4; ++r)
                    for (unsigned int b = 0; b < width; ++b)
                      sum[r][b] += left[r] * at(right + 4 * b);
                }
            for (unsigned int r = 0; r < 4; ++r)
              for (unsigned int b = 0; b < width; ++b)
                at(plane + (i + r) * n + j + 4 * b) = sum[r][b];
          }
    }

    template <unsigned int N>
    TANKTREAD_INLINE void
    congruence(const FaceStencils &face, const double *hessians, const bool symmetric, double *u, double *block)
    {
      const unsigned int n = N > 0 ? N : face.n;
      std::fill(block, block + 9 * n * n, 0.);
      for (unsigned int first = 0; first < face.n_points; first += max_chunk)
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int d = symmetric ? c : 0; d < 3; ++d)
            add_plane<N>(face, first, std::min(face.n_points - first, max_chunk), hessians + 15 * c + d, u, block + (3 * c + d) * n * n);
      if (symmetric)
        for (unsigned int c = 1; c < 3; ++c)
          for (unsigned int d = 0; d < c; ++d)
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                block[((3 * c + d) * n + i) * n + j] = block[((3 * d + c) * n + j) * n + i];
    }
  } // namespace


  TANKTREAD_CLONES_AVX2 void
  apply_stencils(const FaceStencils &face, const double *x, double *y)
  {
    for (unsigned int k = 0; k < face.n_points; ++k)
      for (unsigned int p = 0; p < face.n_rows; ++p)
        {
          const double *stencil = face.values + std::size_t(k) * face.stride + p * face.n;
          Vector4       even = stencil[0] * at(x), odd = stencil[1] * at(x + 4);
          for (unsigned int i = 2; i < face.n; i += 2)
            {
              even += stencil[i] * at(x + 4 * i);
              odd += stencil[i + 1] * at(x + 4 * i + 4);
            }
          at(y + 4 * (k * face.n_rows + p)) = even + odd;
        }
  }


  TANKTREAD_CLONES_AVX2 void
  add_transposed_stencils(const FaceStencils &face, const double *g, double *f)
  {
    for (unsigned int i = 0; i < face.n; i += 4)
      {
        Vector4 sum[4] = {at(f + 4 * i), at(f + 4 * i + 4), at(f + 4 * i + 8), at(f + 4 * i + 12)};
        for (unsigned int k = 0; k < face.n_points; ++k)
          for (unsigned int p = 0; p < face.n_rows; ++p)
            {
              const double *stencil = face.values + std::size_t(k) * face.stride + p * face.n + i;
              const Vector4 force   = at(g + 4 * (k * face.n_rows + p));
              for (unsigned int r = 0; r < 4; ++r)
                sum[r] += stencil[r] * force;
            }
        for (unsigned int r = 0; r < 4; ++r)
          at(f + 4 * (i + r)) = sum[r];
      }
  }


  TANKTREAD_CLONES_AVX2 void
  stencil_congruence(const FaceStencils &face, const double *hessians, const bool symmetric, double *scratch, double *block)
  {
    if (face.n == 12)
      congruence<12>(face, hessians, symmetric, scratch, block);
    else
      congruence<0>(face, hessians, symmetric, scratch, block);
  }
} // namespace tanktread
