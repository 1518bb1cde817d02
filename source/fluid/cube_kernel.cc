// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Taylor-Hood element matrices of cubes, applied without being stored.

#include <tanktread/fluid/cube_kernel.h>


#include <cstring>
#include <type_traits>

// A vector register holds the four numbers of a node for one, two or four cubes. Everything below the three public instantiations is inlined into them, so that
// it is compiled for their instruction set; lambdas would not be.
#define TANKTREAD_INLINE [[gnu::always_inline]] inline
#pragma GCC diagnostic ignored "-Wpsabi" // no call with such arguments is left

namespace tanktread
{
  namespace
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


    // ---- Laplace ----

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


    /** By the Laplace matrix of a cube and, if `with_mass`, `mass_factor` / size^3 times its mass matrix. */
    template <typename Number, bool with_mass = false, typename V>
    TANKTREAD_INLINE void
    multiply_by_laplace(V *u, const V size, const V mass_factor = V{})
    {
      for (int k = 0; k < 9; ++k)
        to_modes(u[3 * k], u[3 * k + 1], u[3 * k + 2]);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
          to_modes(u[9 * k + i], u[9 * k + i + 3], u[9 * k + i + 6]);
      for (int i = 0; i < 9; ++i)
        to_modes(u[i], u[i + 9], u[i + 18]);
      // On the unit interval M = sum_m mass_m r_m r_m^T and K = sum_m mass_m eigenvalue_m r_m r_m^T with the rows r_m of to_modes().
      constexpr Number mass[3] = {Number(1. / 36), Number(1. / 12), Number(1. / 45)}, eigenvalue[3] = {0, 12, 60};
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i)
            if constexpr (with_mass)
              u[i + 3 * j + 9 * k] *= (size * (eigenvalue[i] + eigenvalue[j] + eigenvalue[k]) + mass_factor) * (mass[i] * mass[j] * mass[k]);
            else
              u[i + 3 * j + 9 * k] *= size * (mass[i] * mass[j] * mass[k] * (eigenvalue[i] + eigenvalue[j] + eigenvalue[k]));
      for (int i = 0; i < 9; ++i)
        from_modes(u[i], u[i + 9], u[i + 18]);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
          from_modes(u[9 * k + i], u[9 * k + i + 3], u[9 * k + i + 6]);
      for (int k = 0; k < 9; ++k)
        from_modes(u[3 * k], u[3 * k + 1], u[3 * k + 2]);
    }


    // ---- Divergence ----

    /**
     * Six times the integrals of linear times quadratic functions on the unit interval, or of linear functions times derivatives of quadratic ones in the lane of the
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


    // ---- Loops over cubes ----

    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     sizes(const double *size, const int power)
    {
      Number values[n_cubes];
      for (int cube = 0; cube < n_cubes; ++cube)
        values[cube] = power == 1 ? size[cube] : size[cube] * size[cube];
      return in_components<Number, n_cubes>(values);
    }


    template <typename Number, int n_cubes>
    struct Laplace
    {
      const Number *u;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int) const
      {
        using V = Lanes<Number, n_cubes>;
        V v[27];
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        multiply_by_laplace<Number>(v, sizes<Number, n_cubes>(size, 1));
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y, nodes + a, v[a]);
      }
    };


    template <typename Number, int n_cubes>
    struct Helmholtz
    {
      const double *mass;
      const Number *u;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int cube) const
      {
        using V   = Lanes<Number, n_cubes>;
        const V h = sizes<Number, n_cubes>(size, 1);
        V       v[27];
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        multiply_by_laplace<Number, true>(v, h, sizes<Number, n_cubes>(mass + cube, 1));
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y, nodes + a, v[a]);
      }
    };


    template <typename Number, int n_cubes>
    struct PressureGradient
    {
      const Number *p;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *p_nodes, const unsigned int) const
      {
        using V = Lanes<Number, n_cubes>;
        V q[8], v[27];
        gather_pressures<Number, n_cubes>(p, p_nodes, sizes<Number, n_cubes>(size, 2) * Number(1. / 216), q);
        expand<Number, n_cubes>(q, v);
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y, nodes + a, v[a]);
      }
    };


    template <typename Number, int n_cubes>
    struct Stokes
    {
      const Number *u, *p;
      Number       *y_u, *y_p;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *p_nodes, const unsigned int) const
      {
        using V = Lanes<Number, n_cubes>;
        V       v[27], w[27], q[8];
        const V area = sizes<Number, n_cubes>(size, 2) * Number(1. / 216);
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        contract<Number, n_cubes>(v, q);
        for (int j = 0; j < 8; ++j)
          {
            const V part = area * q[j];
            for (int cube = 0; cube < n_cubes; ++cube)
              y_p[p_nodes[8 * cube + j]] -= part[4 * cube] + part[4 * cube + 1] + part[4 * cube + 2];
          }
        gather_pressures<Number, n_cubes>(p, p_nodes, area, q);
        expand<Number, n_cubes>(q, w);
        multiply_by_laplace<Number>(v, sizes<Number, n_cubes>(size, 1));
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y_u, nodes + a, v[a] - w[a]);
      }
    };


    // ---- Strain form ----

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


    /** v = matrix of the strain form without `least` (grad u^T, grad v), times v. @param viscosity 27 numbers for the first of the cubes, those of the others follow. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    multiply_by_viscous(Lanes<Number, n_cubes> *v, const Lanes<Number, n_cubes> h, const Number *viscosity, const Number least)
    {
      using V                                = Lanes<Number, n_cubes>;
      constexpr GaussMatrices<Number> matrix = gauss_matrices<Number>();
      V                               a[27], b[27], g_x[27], g_y[27], g_z[27];
      along<Number, 1, false, false>(matrix.derivative, v, a);
      along<Number, 3, false, false>(matrix.value, a, b);
      along<Number, 9, false, false>(matrix.value, b, g_x);
      along<Number, 1, false, false>(matrix.value, v, a);
      along<Number, 3, false, false>(matrix.derivative, a, b);
      along<Number, 9, false, false>(matrix.value, b, g_y);
      along<Number, 3, false, false>(matrix.value, a, b);
      along<Number, 9, false, false>(matrix.derivative, b, g_z);

      constexpr Number weight[3] = {Number(5. / 18), Number(8. / 18), Number(5. / 18)};
      for (int q = 0; q < 27; ++q)
        {
          Number mu[n_cubes];
          for (int cube = 0; cube < n_cubes; ++cube)
            mu[cube] = viscosity[27 * cube + q];
          const V volume = h * (weight[q % 3] * weight[q / 3 % 3] * weight[q / 9]);
          const V factor = volume * in_components<Number, n_cubes>(mu), excess = factor - least * volume;
          const V x = g_x[q], y = g_y[q], z = g_z[q];
          g_x[q] = factor * x + excess * transposed<Number, n_cubes, 0>(x, y, z);
          g_y[q] = factor * y + excess * transposed<Number, n_cubes, 1>(x, y, z);
          g_z[q] = factor * z + excess * transposed<Number, n_cubes, 2>(x, y, z);
        }

      along<Number, 9, true, false>(matrix.derivative, g_z, b);
      along<Number, 3, true, false>(matrix.value, b, a);
      along<Number, 9, true, false>(matrix.value, g_y, b);
      along<Number, 3, true, true>(matrix.derivative, b, a);
      along<Number, 1, true, false>(matrix.value, a, v);
      along<Number, 9, true, false>(matrix.value, g_x, b);
      along<Number, 3, true, false>(matrix.value, b, a);
      along<Number, 1, true, true>(matrix.derivative, a, v);
    }


    template <typename Number, int n_cubes>
    struct Viscous
    {
      const Number *viscosity, *u;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int first_cube) const
      {
        Lanes<Number, n_cubes> v[27];
        for (int i = 0; i < 27; ++i)
          v[i] = gather<Number, n_cubes>(u, nodes + i);
        multiply_by_viscous<Number, n_cubes>(v, sizes<Number, n_cubes>(size, 1), viscosity + 27 * std::size_t(first_cube), Number(0));
        for (int i = 0; i < 27; ++i)
          scatter<Number, n_cubes>(y, nodes + i, v[i]);
      }
    };


    /** As Stokes, with the strain form without `least` (grad u^T, grad v). */
    template <typename Number, int n_cubes>
    struct ViscousStokes
    {
      const Number *viscosity;
      Number        least;
      const Number *u, *p;
      Number       *y_u, *y_p;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *p_nodes, const unsigned int first_cube) const
      {
        using V = Lanes<Number, n_cubes>;
        V       v[27], w[27], q[8];
        const V area = sizes<Number, n_cubes>(size, 2) * Number(1. / 216);
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        contract<Number, n_cubes>(v, q);
        for (int j = 0; j < 8; ++j)
          {
            const V part = area * q[j];
            for (int cube = 0; cube < n_cubes; ++cube)
              y_p[p_nodes[8 * cube + j]] -= part[4 * cube] + part[4 * cube + 1] + part[4 * cube + 2];
          }
        gather_pressures<Number, n_cubes>(p, p_nodes, area, q);
        expand<Number, n_cubes>(q, w);
        multiply_by_viscous<Number, n_cubes>(v, sizes<Number, n_cubes>(size, 1), viscosity + 27 * std::size_t(first_cube), least);
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y_u, nodes + a, v[a] - w[a]);
      }
    };


    // ---- Strain form with weights at 5 x 5 x 5 points ----

    template <typename Number>
    struct FineGaussMatrices
    {
      Number value[5][3], derivative[5][3];
    };
    template <typename Number>
    TANKTREAD_INLINE constexpr FineGaussMatrices<Number>
    fine_gauss_matrices()
    {
      const double              x[5]     = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155, 0.95308992296933200};
      FineGaussMatrices<Number> matrices = {};
      for (int q = 0; q < 5; ++q)
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


    /** out = matrix (or its transpose) applied along the middle one of three indices, of which n_left is the fastest; adds if `add`. */
    template <typename Number, int n_left, int n_right, bool transpose, bool add, typename V>
    TANKTREAD_INLINE void
    along_middle(const Number (&matrix)[5][3], const V *in, V *out)
    {
      constexpr int n_in = transpose ? 5 : 3, n_out = transpose ? 3 : 5;
      for (int right = 0; right < n_right; ++right)
        for (int left = 0; left < n_left; ++left)
          for (int i = 0; i < n_out; ++i)
            {
              V sum{};
              for (int k = 0; k < n_in; ++k)
                sum += (transpose ? matrix[k][i] : matrix[i][k]) * in[(right * n_in + k) * n_left + left];
              V &result = out[(right * n_out + i) * n_left + left];
              result    = add ? result + sum : sum;
            }
    }


    template <typename Number, int n_cubes>
    struct WeightedViscous
    {
      const Number *weights, *u;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int first_cube) const
      {
        using V                                    = Lanes<Number, n_cubes>;
        constexpr FineGaussMatrices<Number> matrix = fine_gauss_matrices<Number>();
        const V                             h      = sizes<Number, n_cubes>(size, 1);
        V                                   v[27], a[45], b[75], g_x[125], g_y[125], g_z[125];
        for (int i = 0; i < 27; ++i)
          v[i] = gather<Number, n_cubes>(u, nodes + i);
        along_middle<Number, 1, 9, false, false>(matrix.derivative, v, a);
        along_middle<Number, 5, 3, false, false>(matrix.value, a, b);
        along_middle<Number, 25, 1, false, false>(matrix.value, b, g_x);
        along_middle<Number, 1, 9, false, false>(matrix.value, v, a);
        along_middle<Number, 5, 3, false, false>(matrix.derivative, a, b);
        along_middle<Number, 25, 1, false, false>(matrix.value, b, g_y);
        along_middle<Number, 5, 3, false, false>(matrix.value, a, b);
        along_middle<Number, 25, 1, false, false>(matrix.derivative, b, g_z);
        for (int q = 0; q < 125; ++q)
          {
            Number weight[n_cubes];
            for (int cube = 0; cube < n_cubes; ++cube)
              weight[cube] = weights[125 * std::size_t(first_cube + cube) + q];
            const V factor = h * in_components<Number, n_cubes>(weight);
            const V x = g_x[q], y = g_y[q], z = g_z[q];
            g_x[q] = factor * (x + transposed<Number, n_cubes, 0>(x, y, z));
            g_y[q] = factor * (y + transposed<Number, n_cubes, 1>(x, y, z));
            g_z[q] = factor * (z + transposed<Number, n_cubes, 2>(x, y, z));
          }
        along_middle<Number, 25, 1, true, false>(matrix.derivative, g_z, b);
        along_middle<Number, 5, 3, true, false>(matrix.value, b, a);
        along_middle<Number, 25, 1, true, false>(matrix.value, g_y, b);
        along_middle<Number, 5, 3, true, true>(matrix.derivative, b, a);
        along_middle<Number, 1, 9, true, false>(matrix.value, a, v);
        along_middle<Number, 25, 1, true, false>(matrix.value, g_x, b);
        along_middle<Number, 5, 3, true, false>(matrix.value, b, a);
        along_middle<Number, 1, 9, true, true>(matrix.derivative, a, v);
        for (int i = 0; i < 27; ++i)
          scatter<Number, n_cubes>(y, nodes + i, v[i]);
      }
    };


    // ---- Inertia ----

    template <typename Number>
    struct GaussRule
    {
      Number point[3], weight[3];
    };
    template <typename Number>
    TANKTREAD_INLINE constexpr GaussRule<Number>
    gauss_rule()
    {
      const double root = 0.774596669241483377; // sqrt(3/5)
      return {{Number(0.5 - 0.5 * root), Number(0.5), Number(0.5 + 0.5 * root)}, {Number(5. / 18), Number(8. / 18), Number(5. / 18)}};
    }


    /** Component d of each cube in all four of its lanes. */
    template <typename Number, int n_cubes, int d>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     component(const Lanes<Number, n_cubes> v)
    {
      typename Register<Number, 4 * n_cubes>::index index{};
      for (int lane = 0; lane < 4 * n_cubes; ++lane)
        index[lane] = lane / 4 * 4 + d;
      return __builtin_shuffle(v, index);
    }


    /** A field and its derivatives by the positions in the unit cube, at the Gauss points. */
    template <typename Number, int n_cubes>
    struct PointValues
    {
      Lanes<Number, n_cubes> value[27], x[27], y[27], z[27];

      TANKTREAD_INLINE
      PointValues(const Number *u, const unsigned int *nodes)
      {
        constexpr GaussMatrices<Number> matrix = gauss_matrices<Number>();
        Lanes<Number, n_cubes>          v[27], a[27], b[27];
        for (int i = 0; i < 27; ++i)
          v[i] = gather<Number, n_cubes>(u, nodes + i);
        along<Number, 1, false, false>(matrix.derivative, v, a);
        along<Number, 3, false, false>(matrix.value, a, b);
        along<Number, 9, false, false>(matrix.value, b, x);
        along<Number, 1, false, false>(matrix.value, v, a);
        along<Number, 3, false, false>(matrix.derivative, a, b);
        along<Number, 9, false, false>(matrix.value, b, y);
        along<Number, 3, false, false>(matrix.value, a, b);
        along<Number, 9, false, false>(matrix.derivative, b, z);
        along<Number, 9, false, false>(matrix.value, b, value);
      }

      /** v . grad of this field at a point. */
      TANKTREAD_INLINE Lanes<Number, n_cubes>
                       along_flow(const int q, const Lanes<Number, n_cubes> v) const
      {
        return component<Number, n_cubes, 0>(v) * x[q] + component<Number, n_cubes, 1>(v) * y[q] + component<Number, n_cubes, 2>(v) * z[q];
      }
    };


    template <typename Number, int n_cubes, bool derivative>
    struct Inertia
    {
      const double               *lower_z;
      InertiaCoefficients<Number> factor;
      const Number               *u, *du;
      Number                     *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int first_cube) const
      {
        using V                                = Lanes<Number, n_cubes>;
        constexpr GaussMatrices<Number> matrix = gauss_matrices<Number>();
        constexpr GaussRule<Number>     rule   = gauss_rule<Number>();
        const V                         h = sizes<Number, n_cubes>(size, 1), x_axis = by_component<Number, n_cubes>(0, 1, 0);
        Number                          z_0[n_cubes];
        for (int cube = 0; cube < n_cubes; ++cube)
          z_0[cube] = lower_z[first_cube + cube];
        const V lower_wind = factor.shear_rate * x_axis * in_components<Number, n_cubes>(z_0), wind_across = factor.shear_rate * x_axis * h;

        const PointValues<Number, n_cubes> flow(u, nodes);
        V                                  result[27], a[27];
        if constexpr (derivative)
          {
            const PointValues<Number, n_cubes> change(du, nodes);
            for (int q = 0; q < 27; ++q)
              {
                const V wind = flow.value[q] + lower_wind + rule.point[q / 9] * wind_across;
                const V convection =
                  change.along_flow(q, wind) + flow.along_flow(q, change.value[q]) + wind_across * component<Number, n_cubes, 2>(change.value[q]);
                result[q] = h * h * (factor.mass * h * change.value[q] + factor.convection * convection);
              }
          }
        else
          for (int q = 0; q < 27; ++q)
            {
              const V wind       = flow.value[q] + lower_wind + rule.point[q / 9] * wind_across;
              const V convection = flow.along_flow(q, wind) + wind_across * component<Number, n_cubes, 2>(flow.value[q]);
              result[q]          = h * h * (factor.mass * h * flow.value[q] + factor.convection * convection);
            }
        for (int q = 0; q < 27; ++q)
          result[q] *= rule.weight[q % 3] * rule.weight[q / 3 % 3] * rule.weight[q / 9];

        along<Number, 9, true, false>(matrix.value, result, a);
        along<Number, 3, true, false>(matrix.value, a, result);
        along<Number, 1, true, false>(matrix.value, result, a);
        for (int i = 0; i < 27; ++i)
          scatter<Number, n_cubes>(y, nodes + i, a[i]);
      }
    };
    template <typename Number, int n_cubes>
    using InertiaValue = Inertia<Number, n_cubes, false>;
    template <typename Number, int n_cubes>
    using InertiaDerivative = Inertia<Number, n_cubes, true>;


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
  } // namespace


  InstructionSet
  best_instruction_set()
  {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
      return InstructionSet::avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
      return InstructionSet::avx2;
#endif
    return InstructionSet::baseline;
  }


  template <typename Number>
  void
  add_laplace(const InstructionSet set, const Cubes &cubes, const Number *u, Number *y)
  {
    run<Laplace, Number>(set, cubes, u, y);
  }


  template <typename Number>
  void
  add_helmholtz(const InstructionSet set, const Cubes &cubes, const double *mass, const Number *u, Number *y)
  {
    run<Helmholtz, Number>(set, cubes, mass, u, y);
  }


  template <typename Number>
  void
  add_stokes(const InstructionSet set, const Cubes &cubes, const Number *u, const Number *p, Number *y_u, Number *y_p)
  {
    run<Stokes, Number>(set, cubes, u, p, y_u, y_p);
  }


  template <typename Number>
  void
  add_pressure_gradient(const InstructionSet set, const Cubes &cubes, const Number *p, Number *y_u)
  {
    run<PressureGradient, Number>(set, cubes, p, y_u);
  }


  template <typename Number>
  void
  add_viscous(const InstructionSet set, const Cubes &cubes, const Number *viscosity, const Number *u, Number *y)
  {
    run<Viscous, Number>(set, cubes, viscosity, u, y);
  }


  template <typename Number>
  void
  add_viscous_stokes(const InstructionSet set,
                     const Cubes         &cubes,
                     const Number        *viscosity,
                     const Number         least,
                     const Number        *u,
                     const Number        *p,
                     Number              *y_u,
                     Number              *y_p)
  {
    run<ViscousStokes, Number>(set, cubes, viscosity, least, u, p, y_u, y_p);
  }


  template <typename Number>
  void
  add_inertia(const InstructionSet set, const Cubes &cubes, const double *lower_z, const InertiaCoefficients<Number> factor, const Number *u, Number *y)
  {
    run<InertiaValue, Number>(set, cubes, lower_z, factor, u, static_cast<const Number *>(nullptr), y);
  }


  template <typename Number>
  void
  add_weighted_viscous(const InstructionSet set, const Cubes &cubes, const Number *weights, const Number *u, Number *y)
  {
    run<WeightedViscous, Number>(set, cubes, weights, u, y);
  }


  template <typename Number>
  void
  add_inertia_derivative(const InstructionSet              set,
                         const Cubes                      &cubes,
                         const double                     *lower_z,
                         const InertiaCoefficients<Number> factor,
                         const Number                     *u,
                         const Number                     *du,
                         Number                           *y)
  {
    run<InertiaDerivative, Number>(set, cubes, lower_z, factor, u, du, y);
  }


  template <typename Number>
  void
  add_pressure_mass(const Cubes &cubes, const Number *p, Number *y_p)
  {
    // Along each direction the mass matrix of the unit interval is (1 + J)/6, J being all ones.
    for (unsigned int i = 0; i < cubes.n; ++i)
      {
        const unsigned int *nodes = cubes.pressure_nodes + 8 * i;
        const Number        scale = cubes.size[i] * cubes.size[i] * cubes.size[i] / 216.;
        Number              q[8];
        for (int j = 0; j < 8; ++j)
          q[j] = scale * p[nodes[j]];
        for (int step = 1; step < 8; step *= 2)
          for (int j = 0; j < 8; ++j)
            if ((j & step) == 0)
              {
                const Number sum = q[j] + q[j + step];
                q[j] += sum;
                q[j + step] += sum;
              }
        for (int j = 0; j < 8; ++j)
          y_p[nodes[j]] += q[j];
      }
  }


  template <typename Number>
  void
  add_linear_laplace(const Cubes &cubes, const Number *p, Number *y)
  {
    using V = Lanes<Number, 1>;
    // Along each direction M = (1, 1)(1, 1)^T / 4 + (1, -1)(1, -1)^T / 12 and K = (1, -1)(1, -1)^T on the unit interval: sums and differences diagonalise both.
    constexpr Number mass[2] = {Number(1. / 4), Number(1. / 12)}, eigenvalue[2] = {0, 12};
    for (unsigned int i = 0; i < cubes.n; ++i)
      {
        const unsigned int *nodes = cubes.pressure_nodes + 8 * i;
        const Number        size  = cubes.size[i];
        V                   q[8];
        for (int j = 0; j < 8; ++j)
          q[j] = load_node(p + 4 * nodes[j]);
        for (const bool back : {false, true})
          {
            for (int step = 1; step < 8; step *= 2)
              for (int j = 0; j < 8; ++j)
                if ((j & step) == 0)
                  {
                    const V sum = q[j] + q[j + step];
                    q[j + step] = q[j] - q[j + step];
                    q[j]        = sum;
                  }
            if (!back)
              for (int j = 0; j < 8; ++j)
                {
                  const int x = j % 2, y_mode = j / 2 % 2, z = j / 4;
                  q[j] *= size * (mass[x] * mass[y_mode] * mass[z] * (eigenvalue[x] + eigenvalue[y_mode] + eigenvalue[z]));
                }
          }
        for (int j = 0; j < 8; ++j)
          add_to_node<Number>(y + 4 * nodes[j], q[j]);
      }
  }


#define TANKTREAD_INSTANTIATE(Number)                                                                                                                         \
  template void add_laplace(InstructionSet, const Cubes &, const Number *, Number *);                                                                         \
  template void add_helmholtz(InstructionSet, const Cubes &, const double *, const Number *, Number *);                                                       \
  template void add_inertia(InstructionSet, const Cubes &, const double *, InertiaCoefficients<Number>, const Number *, Number *);                            \
  template void add_inertia_derivative(InstructionSet, const Cubes &, const double *, InertiaCoefficients<Number>, const Number *, const Number *, Number *); \
  template void add_linear_laplace(const Cubes &, const Number *, Number *);                                                                                  \
  template void add_stokes(InstructionSet, const Cubes &, const Number *, const Number *, Number *, Number *);                                                \
  template void add_pressure_gradient(InstructionSet, const Cubes &, const Number *, Number *);                                                               \
  template void add_viscous(InstructionSet, const Cubes &, const Number *, const Number *, Number *);                                                         \
  template void add_weighted_viscous(InstructionSet, const Cubes &, const Number *, const Number *, Number *);                                                \
  template void add_viscous_stokes(InstructionSet, const Cubes &, const Number *, Number, const Number *, const Number *, Number *, Number *);                \
  template void add_pressure_mass(const Cubes &, const Number *, Number *);
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
