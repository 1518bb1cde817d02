// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the basis that diagonalises the Laplace and mass matrices of a cube.

#ifndef tanktread_fluid_cube_modes_h
#define tanktread_fluid_cube_modes_h

#include <tanktread/fluid/cube_lanes.h>

namespace tanktread
{
  namespace cube_lanes
  {
    /** To the eigenvectors of M^{-1} K, up to a scaling: (1, 4, 1), (1, 0, -1), (1, -2, 1). */
    template <typename V>
    TANKTREAD_INLINE void
    to_modes(V &a, V &b, V &c)
    {
      const V even = a + c, odd = a - c;
      a = even + 4 * b;
      c = even - 2 * b;
      b = odd;
    }


    /** The transpose. */
    template <typename V>
    TANKTREAD_INLINE void
    from_modes(V &a, V &b, V &c)
    {
      const V even = a + c, middle = 4 * a - 2 * c;
      a = even + b;
      c = even - b;
      b = middle;
    }


    /** Along three axes of nodes. */
    template <typename V>
    TANKTREAD_INLINE void
    to_all_modes(V *u)
    {
      for (int k = 0; k < 9; ++k)
        to_modes(u[3 * k], u[3 * k + 1], u[3 * k + 2]);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
          to_modes(u[9 * k + i], u[9 * k + i + 3], u[9 * k + i + 6]);
      for (int i = 0; i < 9; ++i)
        to_modes(u[i], u[i + 9], u[i + 18]);
    }


    template <typename V>
    TANKTREAD_INLINE void
    from_all_modes(V *u)
    {
      for (int i = 0; i < 9; ++i)
        from_modes(u[i], u[i + 9], u[i + 18]);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
          from_modes(u[9 * k + i], u[9 * k + i + 3], u[9 * k + i + 6]);
      for (int k = 0; k < 9; ++k)
        from_modes(u[3 * k], u[3 * k + 1], u[3 * k + 2]);
    }
  } // namespace cube_lanes
} // namespace tanktread

#endif
