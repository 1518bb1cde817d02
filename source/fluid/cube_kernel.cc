// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Taylor-Hood element matrices of cubes, applied without being stored.

#include <tanktread/fluid/cube_modes.h>

#include <initializer_list>

namespace tanktread
{
  using namespace cube_lanes;

  namespace
  {
    // ---- Laplace ----

    /** By the Laplace matrix of a cube and, if `with_mass`, `mass_factor` / size^3 times its mass matrix. */
    template <typename Number, bool with_mass = false, typename V>
    TANKTREAD_INLINE void
    multiply_by_laplace(V *u, const V size, const V mass_factor = V{})
    {
      to_all_modes(u);
      // On the unit interval M = sum_m mass_m r_m r_m^T and K = sum_m mass_m eigenvalue_m r_m r_m^T with the rows r_m of to_modes().
      constexpr Number mass[3] = {Number(1. / 36), Number(1. / 12), Number(1. / 45)}, eigenvalue[3] = {0, 12, 60};
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i)
            if constexpr (with_mass)
              u[i + 3 * j + 9 * k] *= (size * (eigenvalue[i] + eigenvalue[j] + eigenvalue[k]) + mass_factor) * (mass[i] * mass[j] * mass[k]);
            else
              u[i + 3 * j + 9 * k] *= size * (mass[i] * mass[j] * mass[k] * (eigenvalue[i] + eigenvalue[j] + eigenvalue[k]));
      from_all_modes(u);
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
    struct Divergence
    {
      const Number *u;
      Number       *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *p_nodes, const unsigned int) const
      {
        Lanes<Number, n_cubes> v[27];
        for (int a = 0; a < 27; ++a)
          v[a] = gather<Number, n_cubes>(u, nodes + a);
        scatter_divergence<Number, n_cubes>(v, sizes<Number, n_cubes>(size, 2) * Number(1. / 216), p_nodes, y);
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
        scatter_divergence<Number, n_cubes>(v, -area, p_nodes, y_p);
        gather_pressures<Number, n_cubes>(p, p_nodes, area, q);
        expand<Number, n_cubes>(q, w);
        multiply_by_laplace<Number>(v, sizes<Number, n_cubes>(size, 1));
        for (int a = 0; a < 27; ++a)
          scatter<Number, n_cubes>(y_u, nodes + a, v[a] - w[a]);
      }
    };


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
  add_divergence(const InstructionSet set, const Cubes &cubes, const Number *u, Number *y_p)
  {
    run<Divergence, Number>(set, cubes, u, y_p);
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

#define TANKTREAD_INSTANTIATE(Number)                                                                          \
  template void add_laplace(InstructionSet, const Cubes &, const Number *, Number *);                          \
  template void add_helmholtz(InstructionSet, const Cubes &, const double *, const Number *, Number *);        \
  template void add_linear_laplace(const Cubes &, const Number *, Number *);                                   \
  template void add_stokes(InstructionSet, const Cubes &, const Number *, const Number *, Number *, Number *); \
  template void add_pressure_gradient(InstructionSet, const Cubes &, const Number *, Number *);                \
  template void add_divergence(InstructionSet, const Cubes &, const Number *, Number *);                       \
  template void add_pressure_mass(const Cubes &, const Number *, Number *);
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
