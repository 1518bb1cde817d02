// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: pieces that the kernels on cubes share: nodes in vector registers, loops over cubes for several instruction sets

#ifndef tanktread_fluid_cube_lanes_h
#define tanktread_fluid_cube_lanes_h

#include <tanktread/fluid/cube_kernel.h>

#include <cstring>
#include <type_traits>

// A vector register holds the four numbers of a node for one, two or four cubes. Everything below the public instantiations is inlined into them, so that
// it is compiled for their instruction set; lambdas would not be. To be included by the files of kernels only.
#define TANKTREAD_INLINE [[gnu::always_inline]] inline
#pragma GCC diagnostic ignored "-Wpsabi" // no call with such arguments is left

namespace tanktread
{
  namespace cube_lanes
  {
    template <typename Number, int width>
    struct Register
    {
      typedef Number type __attribute__((vector_size(width * sizeof(Number))));
      using integer = std::conditional_t<sizeof(Number) == 4, int, long long>;
      typedef integer index __attribute__((vector_size(width * sizeof(Number))));
    };
    template <typename Number, int n_cubes>
    using Lanes = typename Register<Number, 4 * n_cubes>::type;


    template <typename Number>
    TANKTREAD_INLINE Lanes<Number, 1>
                     load_node(const Number *node)
    {
      Lanes<Number, 1> result;
      std::memcpy(&result, node, sizeof(result));
      return result;
    }


    template <typename Number>
    TANKTREAD_INLINE void
    add_to_node(Number *node, const Lanes<Number, 1> value)
    {
      Lanes<Number, 1> sum = load_node(node) + value;
      std::memcpy(node, &sum, sizeof(sum));
    }


    /** The same node of n_cubes cubes that follow one another; `nodes` points to that of the first. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     gather(const Number *u, const unsigned int *nodes)
    {
      if constexpr (n_cubes == 1)
        return load_node(u + 4 * nodes[0]);
      else if constexpr (n_cubes == 2)
        return __builtin_shufflevector(load_node(u + 4 * nodes[0]), load_node(u + 4 * nodes[27]), 0, 1, 2, 3, 4, 5, 6, 7);
      else
        return __builtin_shufflevector(gather<Number, 2>(u, nodes), gather<Number, 2>(u, nodes + 54), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }


    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    scatter(Number *y, const unsigned int *nodes, const Lanes<Number, n_cubes> value)
    {
      if constexpr (n_cubes == 1)
        add_to_node(y + 4 * nodes[0], value);
      else if constexpr (n_cubes == 2)
        {
          add_to_node(y + 4 * nodes[0], (Lanes<Number, 1>)__builtin_shufflevector(value, value, 0, 1, 2, 3));
          add_to_node(y + 4 * nodes[27], (Lanes<Number, 1>)__builtin_shufflevector(value, value, 4, 5, 6, 7));
        }
      else
        {
          scatter<Number, 2>(y, nodes, __builtin_shufflevector(value, value, 0, 1, 2, 3, 4, 5, 6, 7));
          scatter<Number, 2>(y, nodes + 54, __builtin_shufflevector(value, value, 8, 9, 10, 11, 12, 13, 14, 15));
        }
    }


    /** One value for each cube in its three lanes of components, zero in the fourth: what multiplies it becomes harmless there, whatever was read. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     in_components(const Number *values)
    {
      Lanes<Number, n_cubes> result{};
      for (int cube = 0; cube < n_cubes; ++cube)
        for (int c = 0; c < 3; ++c)
          result[4 * cube + c] = values[cube];
      return result;
    }


    /** `in_direction` in the lane of component `direction` of each cube, `else_value` in the other two. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     by_component(const int direction, const Number in_direction, const Number else_value)
    {
      Lanes<Number, n_cubes> result{};
      for (int cube = 0; cube < n_cubes; ++cube)
        for (int c = 0; c < 3; ++c)
          result[4 * cube + c] = c == direction ? in_direction : else_value;
      return result;
    }


    // ---- Gradients ----

    /** Component d of g0, g1, g2 as the three components of the result. */
    template <typename Number, int n_cubes, int d>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     transposed(const Lanes<Number, n_cubes> g0, const Lanes<Number, n_cubes> g1, const Lanes<Number, n_cubes> g2)
    {
      using Index         = typename Register<Number, 4 * n_cubes>::index;
      constexpr int width = 4 * n_cubes;
      Index         first{}, second{};
      for (int cube = 0; cube < n_cubes; ++cube)
        for (int c = 0; c < 4; ++c)
          {
            first[4 * cube + c]  = c == 1 ? width + 4 * cube + d : 4 * cube + d;
            second[4 * cube + c] = c == 2 ? width + 4 * cube + d : 4 * cube + c;
          }
      return __builtin_shuffle(__builtin_shuffle(g0, g1, first), g2, second);
    }


    // ---- Divergence ----

    /**
     * Six times the integrals of linear times quadratic functions on the unit interval, or of linear functions times derivatives of quadratic ones in the lane
     * of the
     * component whose derivative by this direction is in the divergence.
     */
    template <typename Number, int n_cubes>
    struct DivergenceCoefficients
    {
      Lanes<Number, n_cubes> a0, b0, c0, a1, b1, c1;

      TANKTREAD_INLINE explicit DivergenceCoefficients(const int direction)
        : a0(by_component<Number, n_cubes>(direction, -5, 1))
        , b0(by_component<Number, n_cubes>(direction, 4, 2))
        , c0(by_component<Number, n_cubes>(direction, 1, 0))
        , a1(by_component<Number, n_cubes>(direction, -1, 0))
        , b1(by_component<Number, n_cubes>(direction, -4, 2))
        , c1(by_component<Number, n_cubes>(direction, 5, 1))
      {}
    };


    /** q (2 x 2 x 2) = the three-dimensional products of those integrals with u (3 x 3 x 3), each component in its lane. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    contract(const Lanes<Number, n_cubes> *u, Lanes<Number, n_cubes> *q)
    {
      using V = Lanes<Number, n_cubes>;
      V                                             x[18], y[12];
      const DivergenceCoefficients<Number, n_cubes> in_x(0), in_y(1), in_z(2);
      for (int k = 0; k < 9; ++k)
        {
          x[2 * k]     = in_x.a0 * u[3 * k] + in_x.b0 * u[3 * k + 1] + in_x.c0 * u[3 * k + 2];
          x[2 * k + 1] = in_x.a1 * u[3 * k] + in_x.b1 * u[3 * k + 1] + in_x.c1 * u[3 * k + 2];
        }
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 2; ++i)
          {
            y[4 * k + i]     = in_y.a0 * x[6 * k + i] + in_y.b0 * x[6 * k + i + 2] + in_y.c0 * x[6 * k + i + 4];
            y[4 * k + i + 2] = in_y.a1 * x[6 * k + i] + in_y.b1 * x[6 * k + i + 2] + in_y.c1 * x[6 * k + i + 4];
          }
      for (int i = 0; i < 4; ++i)
        {
          q[i]     = in_z.a0 * y[i] + in_z.b0 * y[i + 4] + in_z.c0 * y[i + 8];
          q[i + 4] = in_z.a1 * y[i] + in_z.b1 * y[i + 4] + in_z.c1 * y[i + 8];
        }
    }


    /** The transpose of contract(). */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    expand(const Lanes<Number, n_cubes> *q, Lanes<Number, n_cubes> *u)
    {
      using V = Lanes<Number, n_cubes>;
      V                                             x[18], y[12];
      const DivergenceCoefficients<Number, n_cubes> in_x(0), in_y(1), in_z(2);
      for (int i = 0; i < 4; ++i)
        {
          y[i]     = in_z.a0 * q[i] + in_z.a1 * q[i + 4];
          y[i + 4] = in_z.b0 * q[i] + in_z.b1 * q[i + 4];
          y[i + 8] = in_z.c0 * q[i] + in_z.c1 * q[i + 4];
        }
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 2; ++i)
          {
            x[6 * k + i]     = in_y.a0 * y[4 * k + i] + in_y.a1 * y[4 * k + i + 2];
            x[6 * k + i + 2] = in_y.b0 * y[4 * k + i] + in_y.b1 * y[4 * k + i + 2];
            x[6 * k + i + 4] = in_y.c0 * y[4 * k + i] + in_y.c1 * y[4 * k + i + 2];
          }
      for (int k = 0; k < 9; ++k)
        {
          u[3 * k]     = in_x.a0 * x[2 * k] + in_x.a1 * x[2 * k + 1];
          u[3 * k + 1] = in_x.b0 * x[2 * k] + in_x.b1 * x[2 * k + 1];
          u[3 * k + 2] = in_x.c0 * x[2 * k] + in_x.c1 * x[2 * k + 1];
        }
    }


    /** Adds `factor` times the divergence of u, tested with the linear functions, at the cubes' corners. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    scatter_divergence(const Lanes<Number, n_cubes> *u, const Lanes<Number, n_cubes> factor, const unsigned int *nodes, Number *y)
    {
      Lanes<Number, n_cubes> q[8];
      contract<Number, n_cubes>(u, q);
      for (int j = 0; j < 8; ++j)
        {
          const Lanes<Number, n_cubes> part = factor * q[j];
          for (int cube = 0; cube < n_cubes; ++cube)
            y[nodes[8 * cube + j]] += part[4 * cube] + part[4 * cube + 1] + part[4 * cube + 2];
        }
    }


    /** Pressures of the cubes' corners, each in the lanes of the components, times `factor`. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    gather_pressures(const Number *p, const unsigned int *nodes, const Lanes<Number, n_cubes> factor, Lanes<Number, n_cubes> *q)
    {
      for (int j = 0; j < 8; ++j)
        {
          Number values[n_cubes];
          for (int cube = 0; cube < n_cubes; ++cube)
            values[cube] = p[nodes[8 * cube + j]];
          q[j] = factor * in_components<Number, n_cubes>(values);
        }
    }


    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     sizes(const double *size, const int power)
    {
      Number values[n_cubes];
      for (int cube = 0; cube < n_cubes; ++cube)
        values[cube] = power == 1 ? size[cube] : size[cube] * size[cube];
      return in_components<Number, n_cubes>(values);
    }


    // ---- Quadratic functions at Gauss points ----

    /** Values and derivatives of the quadratic functions at the three Gauss points of the unit interval: v0 a + v1 b + v2 c. */
    template <typename Number>
    struct GaussMatrices
    {
      Number value[3][3], derivative[3][3];
    };
    template <typename Number>
    TANKTREAD_INLINE constexpr GaussMatrices<Number>
    gauss_matrices()
    {
      const double          root     = 0.774596669241483377; // sqrt(3/5)
      const double          x[3]     = {0.5 - 0.5 * root, 0.5, 0.5 + 0.5 * root};
      GaussMatrices<Number> matrices = {};
      for (int q = 0; q < 3; ++q)
        {
          matrices.value[q][0]      = (1 - x[q]) * (1 - 2 * x[q]);
          matrices.value[q][1]      = 4 * x[q] * (1 - x[q]);
          matrices.value[q][2]      = x[q] * (2 * x[q] - 1);
          matrices.derivative[q][0] = 4 * x[q] - 3;
          matrices.derivative[q][1] = 4 - 8 * x[q];
          matrices.derivative[q][2] = 4 * x[q] - 1;
        }
      return matrices;
    }


    /** out = matrix (or its transpose) applied along the direction of stride `step`; adds if `add`. */
    template <typename Number, int step, bool transpose, bool add, typename V>
    TANKTREAD_INLINE void
    along(const Number (&matrix)[3][3], const V *in, V *out)
    {
      for (int line = 0; line < 9; ++line)
        {
          const int start = step == 1 ? 3 * line : step == 3 ? 9 * (line / 3) + line % 3 : line;
          for (int q = 0; q < 3; ++q)
            {
              V sum = (transpose ? matrix[0][q] : matrix[q][0]) * in[start] + (transpose ? matrix[1][q] : matrix[q][1]) * in[start + step] +
                (transpose ? matrix[2][q] : matrix[q][2]) * in[start + 2 * step];
              out[start + q * step] = add ? out[start + q * step] + sum : sum;
            }
        }
    }


    /** Runs `body` over the cubes, n_cubes at a time, and the rest one by one. */
    template <template <typename, int> class Body, typename Number, int n_cubes, typename... Arrays>
    TANKTREAD_INLINE void
    for_cubes(const Cubes &cubes, Arrays... arrays)
    {
      const Body<Number, n_cubes> together{arrays...};
      const Body<Number, 1>       alone{arrays...};
      unsigned int                i = 0;
      for (; i + n_cubes <= cubes.n; i += n_cubes)
        together(cubes.size + i, cubes.velocity_nodes + 27 * i, cubes.pressure_nodes + 8 * i, i);
      for (; i < cubes.n; ++i)
        alone(cubes.size + i, cubes.velocity_nodes + 27 * i, cubes.pressure_nodes + 8 * i, i);
    }


    // Widths measured: registers of 64 bytes pay with AVX-512 only, and the three-dimensional arrays of a cube spill out of the 16 registers of the others.
    template <typename Number>
    constexpr int widest = sizeof(Number) == 4 ? 4 : 2;

#if defined(__x86_64__)
#  define TANKTREAD_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi2"), noinline))
#  define TANKTREAD_AVX2 __attribute__((target("avx2,fma,bmi2"), noinline))

    template <template <typename, int> class Body, typename Number, typename... Arrays>
    TANKTREAD_AVX512 void
    run_avx512(const Cubes &cubes, Arrays... arrays)
    {
      for_cubes<Body, Number, widest<Number>>(cubes, arrays...);
    }
    template <template <typename, int> class Body, typename Number, typename... Arrays>
    TANKTREAD_AVX2 void
    run_avx2(const Cubes &cubes, Arrays... arrays)
    {
      for_cubes<Body, Number, widest<Number> / 2>(cubes, arrays...);
    }
#endif


    template <template <typename, int> class Body, typename Number, typename... Arrays>
    void
    run(const InstructionSet set, const Cubes &cubes, Arrays... arrays)
    {
#if defined(__x86_64__)
      if (set == InstructionSet::avx512)
        return run_avx512<Body, Number>(cubes, arrays...);
      if (set == InstructionSet::avx2)
        return run_avx2<Body, Number>(cubes, arrays...);
#endif
      (void)set;
      for_cubes<Body, Number, 1>(cubes, arrays...);
    }
  } // namespace cube_lanes
} // namespace tanktread

#endif
