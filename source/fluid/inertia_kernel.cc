// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: mass and convection on cubes, and their derivative.

#include <tanktread/fluid/cube_lanes.h>

namespace tanktread
{
  using namespace cube_lanes;

  namespace
  {
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


  } // namespace


  template <typename Number>
  void
  add_inertia(const InstructionSet set, const Cubes &cubes, const double *lower_z, const InertiaCoefficients<Number> factor, const Number *u, Number *y)
  {
    run<InertiaValue, Number>(set, cubes, lower_z, factor, u, static_cast<const Number *>(nullptr), y);
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


#define TANKTREAD_INSTANTIATE(Number)                                                                                              \
  template void add_inertia(InstructionSet, const Cubes &, const double *, InertiaCoefficients<Number>, const Number *, Number *); \
  template void add_inertia_derivative(InstructionSet, const Cubes &, const double *, InertiaCoefficients<Number>, const Number *, const Number *, Number *);
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
