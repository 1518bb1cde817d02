// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the strain form on cubes with a viscosity that varies within them.

#include <tanktread/fluid/cube_lanes.h>

namespace tanktread
{
  using namespace cube_lanes;

  namespace
  {
    /**
     * v = matrix of the strain form without `least` (grad u^T, grad v), times v. @param viscosity 27 numbers for the first of the cubes, those of the others
     * follow.
     */
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
        scatter_divergence<Number, n_cubes>(v, -area, p_nodes, y_p);
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


  } // namespace


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
  add_weighted_viscous(const InstructionSet set, const Cubes &cubes, const Number *weights, const Number *u, Number *y)
  {
    run<WeightedViscous, Number>(set, cubes, weights, u, y);
  }


#define TANKTREAD_INSTANTIATE(Number)                                                                          \
  template void add_viscous(InstructionSet, const Cubes &, const Number *, const Number *, Number *);          \
  template void add_weighted_viscous(InstructionSet, const Cubes &, const Number *, const Number *, Number *); \
  template void add_viscous_stokes(InstructionSet, const Cubes &, const Number *, Number, const Number *, const Number *, Number *, Number *);
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
