// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the strain form on cubes, each of one viscosity.

#include <tanktread/fluid/cube_modes.h>

namespace tanktread
{
  using namespace cube_lanes;

  namespace
  {
    /**
     * u = factor Laplace matrix u + excess ((d_c u_d, d_d v_c)) u of a cube of size one.
     *
     * The modes r_m of to_modes() are multiples of Legendre polynomials: if a function has the modes (r_0, r_1, r_2), its derivative has (-6 r_1, -4 r_2, 0).
     */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    multiply_by_uniform_viscous(Lanes<Number, n_cubes> *u, const Lanes<Number, n_cubes> factor, const Lanes<Number, n_cubes> excess)
    {
      using V                  = Lanes<Number, n_cubes>;
      constexpr Number mass[3] = {Number(1. / 36), Number(1. / 12), Number(1. / 45)}, eigenvalue[3] = {0, 12, 60};
      constexpr Number derivative[2] = {-6, -4};
      V                result[27];
      to_all_modes(u);
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i)
            {
              const int a = i + 3 * j + 9 * k;
              result[a]   = factor * (mass[i] * mass[j] * mass[k] * (eigenvalue[i] + eigenvalue[j] + eigenvalue[k])) * u[a];
            }
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i)
            {
              const int a   = i + 3 * j + 9 * k;
              const V   g_x = i < 2 ? derivative[i < 2 ? i : 0] * u[a + (i < 2 ? 1 : 0)] : V{};
              const V   g_y = j < 2 ? derivative[j < 2 ? j : 0] * u[a + (j < 2 ? 3 : 0)] : V{};
              const V   g_z = k < 2 ? derivative[k < 2 ? k : 0] * u[a + (k < 2 ? 9 : 0)] : V{};
              // What is transposed into the fourth lane becomes harmless by `weight`.
              const V weight = excess * (mass[i] * mass[j] * mass[k]);
              if (i < 2)
                result[a + 1] += weight * derivative[i < 2 ? i : 0] * transposed<Number, n_cubes, 0>(g_x, g_y, g_z);
              if (j < 2)
                result[a + 3] += weight * derivative[j < 2 ? j : 0] * transposed<Number, n_cubes, 1>(g_x, g_y, g_z);
              if (k < 2)
                result[a + 9] += weight * derivative[k < 2 ? k : 0] * transposed<Number, n_cubes, 2>(g_x, g_y, g_z);
            }
      for (int a = 0; a < 27; ++a)
        u[a] = result[a];
      from_all_modes(u);
    }


    /** What each lane is multiplied by. */
    template <typename Number, int n_cubes>
    struct Factors
    {
      TANKTREAD_INLINE
      Factors(const double *size, const double *viscosity, const double least)
      {
        Number mu[n_cubes], more[n_cubes];
        for (int cube = 0; cube < n_cubes; ++cube)
          {
            mu[cube]   = size[cube] * viscosity[cube];
            more[cube] = size[cube] * (viscosity[cube] - least);
          }
        factor = in_components<Number, n_cubes>(mu);
        excess = in_components<Number, n_cubes>(more);
      }

      Lanes<Number, n_cubes> factor, excess;
    };


    template <typename Number, int n_cubes>
    struct UniformViscous
    {
      const double *viscosity;
      double        least;
      const Number *u;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int first_cube) const
      {
        const Factors<Number, n_cubes> of(size, viscosity + first_cube, least);
        Lanes<Number, n_cubes>         v[27];
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        multiply_by_uniform_viscous<Number, n_cubes>(v, of.factor, of.excess);
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y, nodes + a, v[a]);
      }
    };


    template <typename Number, int n_cubes>
    struct UniformViscousStokes
    {
      const double *viscosity;
      double        least;
      const Number *u, *p;
      Number       *y_u, *y_p;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *p_nodes, const unsigned int first_cube) const
      {
        using V = Lanes<Number, n_cubes>;
        const Factors<Number, n_cubes> of(size, viscosity + first_cube, least);
        V                              v[27], w[27], q[8];
        const V                        area = sizes<Number, n_cubes>(size, 2) * Number(1. / 216);
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        scatter_divergence<Number, n_cubes>(v, -area, p_nodes, y_p);
        gather_pressures<Number, n_cubes>(p, p_nodes, area, q);
        expand<Number, n_cubes>(q, w);
        multiply_by_uniform_viscous<Number, n_cubes>(v, of.factor, of.excess);
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y_u, nodes + a, v[a] - w[a]);
      }
    };
  } // namespace


  template <typename Number>
  void
  add_uniform_viscous(const InstructionSet set, const Cubes &cubes, const double *viscosity, const double least, const Number *u, Number *y)
  {
    run<UniformViscous, Number>(set, cubes, viscosity, least, u, y);
  }


  template <typename Number>
  void
  add_uniform_viscous_stokes(const InstructionSet set,
                             const Cubes         &cubes,
                             const double        *viscosity,
                             const double         least,
                             const Number        *u,
                             const Number        *p,
                             Number              *y_u,
                             Number              *y_p)
  {
    run<UniformViscousStokes, Number>(set, cubes, viscosity, least, u, p, y_u, y_p);
  }


#define TANKTREAD_INSTANTIATE(Number)                                                                                 \
  template void add_uniform_viscous(InstructionSet, const Cubes &, const double *, double, const Number *, Number *); \
  template void add_uniform_viscous_stokes(InstructionSet, const Cubes &, const double *, double, const Number *, const Number *, Number *, Number *);
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
