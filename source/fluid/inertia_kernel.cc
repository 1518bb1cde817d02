// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: mass and convection on cubes, and their derivative.

#include <tanktread/fluid/cube_lanes.h>
#include <tanktread/fluid/undisturbed_flow.h>

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


    // ---- The undisturbed flow ----

    /** The numbers of an UndisturbedFlow, four for each vector, of which the last is zero. */
    template <typename Number>
    struct FlowNumbers
    {
      Number constant[4], linear[3][4], quadratic[3][3][4]; // [direction] ... [component]

      explicit FlowNumbers(const UndisturbedFlow &flow)
        : constant{}
        , linear{}
        , quadratic{}
      {
        for (unsigned int c = 0; c < 3; ++c)
          {
            constant[c] = flow.constant[c];
            for (unsigned int d = 0; d < 3; ++d)
              {
                linear[d][c] = flow.linear[c][d];
                for (unsigned int e = 0; e < 3; ++e)
                  quadratic[d][e][c] = flow.quadratic[c][d][e];
              }
          }
      }
    };


    /** The same four numbers for each cube. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     in_all_cubes(const Number *four)
    {
      const Lanes<Number, 1> v = load_node(four);
      if constexpr (n_cubes == 1)
        return v;
      else if constexpr (n_cubes == 2)
        return __builtin_shufflevector(v, v, 0, 1, 2, 3, 0, 1, 2, 3);
      else
        return __builtin_shufflevector(v, v, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
    }


    /** A coordinate of the corner of each cube, in all its lanes. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE Lanes<Number, n_cubes>
                     coordinates(const double *corners)
    {
      if constexpr (n_cubes == 1)
        return Lanes<Number, 1>{} + Number(*corners);
      else if constexpr (n_cubes == 2)
        return __builtin_shufflevector(coordinates<Number, 1>(corners), coordinates<Number, 1>(corners + 3), 0, 1, 2, 3, 4, 5, 6, 7);
      else
        return __builtin_shufflevector(coordinates<Number, 2>(corners),
                                       coordinates<Number, 2>(corners + 6),
                                       0,
                                       1,
                                       2,
                                       3,
                                       4,
                                       5,
                                       6,
                                       7,
                                       8,
                                       9,
                                       10,
                                       11,
                                       12,
                                       13,
                                       14,
                                       15);
    }


    /** The undisturbed flow in the coordinates of the unit cube, and its derivatives by them. */
    template <typename Number, int n_cubes, bool is_linear>
    struct FlowInCubes
    {
      using V = Lanes<Number, n_cubes>;
      V constant, x, y, z, xx, yy, zz, xy, xz, yz; // value and derivatives at the lower corner

      TANKTREAD_INLINE
      FlowInCubes(const FlowNumbers<Number> &flow, const double *corners, const V h)
      {
        constant = in_all_cubes<Number, n_cubes>(flow.constant);
        V slope[3];
        for (int d = 0; d < 3; ++d)
          {
            const V linear = in_all_cubes<Number, n_cubes>(flow.linear[d]);
            slope[d]       = linear;
            if constexpr (!is_linear)
              for (int e = 0; e < 3; ++e)
                slope[d] += coordinates<Number, n_cubes>(corners + e) * in_all_cubes<Number, n_cubes>(flow.quadratic[d][e]);
            constant += coordinates<Number, n_cubes>(corners + d) * (Number(0.5) * (linear + slope[d]));
          }
        x = h * slope[0], y = h * slope[1], z = h * slope[2];
        if constexpr (!is_linear)
          {
            xx = h * h * in_all_cubes<Number, n_cubes>(flow.quadratic[0][0]);
            yy = h * h * in_all_cubes<Number, n_cubes>(flow.quadratic[1][1]);
            zz = h * h * in_all_cubes<Number, n_cubes>(flow.quadratic[2][2]);
            xy = h * h * in_all_cubes<Number, n_cubes>(flow.quadratic[0][1]);
            xz = h * h * in_all_cubes<Number, n_cubes>(flow.quadratic[0][2]);
            yz = h * h * in_all_cubes<Number, n_cubes>(flow.quadratic[1][2]);
          }
      }

      /** On the line of points (r, s, t) in the unit cube: what is the same for all r. */
      struct Line
      {
        V start, x, y, z, xx, xy, xz;

        TANKTREAD_INLINE V
        value(const Number r) const
        {
          if constexpr (is_linear)
            return start + r * x;
          else
            return start + r * (x + Number(0.5) * r * xx);
        }

        /** v . grad of this flow. */
        TANKTREAD_INLINE V
        along_flow(const Number r, const V v) const
        {
          const V v_x = component<Number, n_cubes, 0>(v), v_y = component<Number, n_cubes, 1>(v), v_z = component<Number, n_cubes, 2>(v);
          if constexpr (is_linear)
            return v_x * x + v_y * y + v_z * z;
          else
            return v_x * (x + r * xx) + v_y * (y + r * xy) + v_z * (z + r * xz);
        }
      };

      TANKTREAD_INLINE Line
      line(const Number s, const Number t) const
      {
        if constexpr (is_linear)
          return {constant + s * y + t * z, x, y, z, V{}, V{}, V{}};
        else
          return {constant + s * (y + Number(0.5) * s * yy + t * yz) + t * (z + Number(0.5) * t * zz),
                  x + s * xy + t * xz,
                  y + s * yy + t * yz,
                  z + s * yz + t * zz,
                  xx,
                  xy,
                  xz};
      }
    };


    // ---- Values at points ----

    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    gather_nodes(const Number *u, const unsigned int *nodes, Lanes<Number, n_cubes> *v)
    {
      for (int i = 0; i < 27; ++i)
        v[i] = gather<Number, n_cubes>(u, nodes + i);
    }


    /** A field and its derivatives by the positions in the unit cube, at the Gauss points. */
    template <typename Number, int n_cubes>
    struct PointValues
    {
      Lanes<Number, n_cubes> value[27], x[27], y[27], z[27];

      TANKTREAD_INLINE explicit PointValues(const Lanes<Number, n_cubes> *nodal)
      {
        constexpr GaussMatrices<Number> matrix = gauss_matrices<Number>();
        Lanes<Number, n_cubes>          a[27], b[27];
        along<Number, 1, false, false>(matrix.derivative, nodal, a);
        along<Number, 3, false, false>(matrix.value, a, b);
        along<Number, 9, false, false>(matrix.value, b, x);
        along<Number, 1, false, false>(matrix.value, nodal, a);
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


    /** Adds the integrals of the functions times `density`, values at the Gauss points, to the nodes. */
    template <typename Number, int n_cubes>
    TANKTREAD_INLINE void
    add_integrals(Lanes<Number, n_cubes> *density, const unsigned int *nodes, Number *y)
    {
      constexpr GaussMatrices<Number> matrix = gauss_matrices<Number>();
      constexpr GaussRule<Number>     rule   = gauss_rule<Number>();
      Lanes<Number, n_cubes>          a[27];
      for (int q = 0; q < 27; ++q)
        density[q] *= rule.weight[q % 3] * rule.weight[q / 3 % 3] * rule.weight[q / 9];
      along<Number, 9, true, false>(matrix.value, density, a);
      along<Number, 3, true, false>(matrix.value, a, density);
      along<Number, 1, true, false>(matrix.value, density, a);
      for (int i = 0; i < 27; ++i)
        scatter<Number, n_cubes>(y, nodes + i, a[i]);
    }


    // ---- The terms ----

    /** @tparam is_linear of the undisturbed flow: a quadratic one takes a tenth of the time, or a fifth, more. */
    template <typename Number, int n_cubes, bool is_linear>
    struct Inertia
    {
      const double               *corners;
      FlowNumbers<Number>         undisturbed;
      InertiaCoefficients<Number> factor;
      const Number               *u;
      Number                     *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int first_cube) const
      {
        using V                                            = Lanes<Number, n_cubes>;
        constexpr GaussRule<Number>                   rule = gauss_rule<Number>();
        const V                                       h    = sizes<Number, n_cubes>(size, 1);
        const FlowInCubes<Number, n_cubes, is_linear> u_inf(undisturbed, corners + 3 * std::size_t(first_cube), h);
        V                                             v[27];
        gather_nodes<Number, n_cubes>(u, nodes, v);
        const PointValues<Number, n_cubes> flow(v);
        for (int k = 0; k < 9; ++k)
          {
            const auto line = u_inf.line(rule.point[k % 3], rule.point[k / 3]);
            for (int i = 0; i < 3; ++i)
              {
                const int q          = 3 * k + i;
                const V   convection = flow.along_flow(q, flow.value[q] + line.value(rule.point[i])) + line.along_flow(rule.point[i], flow.value[q]);
                v[q]                 = h * h * (factor.mass * h * flow.value[q] + factor.convection * convection);
              }
          }
        add_integrals<Number, n_cubes>(v, nodes, y);
      }
    };
    template <typename Number, int n_cubes>
    using InertiaInLinearFlow = Inertia<Number, n_cubes, true>;
    template <typename Number, int n_cubes>
    using InertiaInQuadraticFlow = Inertia<Number, n_cubes, false>;


    /** The undisturbed flow is added to u at the nodes of the cubes, which hold it exactly: so its degree costs next to nothing. */
    template <typename Number, int n_cubes>
    struct InertiaDerivative
    {
      const double               *corners;
      FlowNumbers<Number>         undisturbed;
      InertiaCoefficients<Number> factor;
      const Number               *u, *du;
      Number                     *y;

      TANKTREAD_INLINE void
      operator()(const double *size, const unsigned int *nodes, const unsigned int *, const unsigned int first_cube) const
      {
        using V   = Lanes<Number, n_cubes>;
        const V h = sizes<Number, n_cubes>(size, 1);
        V       v[27];
        gather_nodes<Number, n_cubes>(u, nodes, v);
        const FlowInCubes<Number, n_cubes, false> u_inf(undisturbed, corners + 3 * std::size_t(first_cube), h);
        constexpr Number                          node[3] = {Number(0), Number(0.5), Number(1)};
        for (int k = 0; k < 9; ++k)
          {
            const auto line = u_inf.line(node[k % 3], node[k / 3]);
            for (int i = 0; i < 3; ++i)
              v[3 * k + i] += line.value(node[i]);
          }
        const PointValues<Number, n_cubes> flow(v);
        gather_nodes<Number, n_cubes>(du, nodes, v);
        const PointValues<Number, n_cubes> change(v);
        for (int q = 0; q < 27; ++q)
          {
            const V convection = change.along_flow(q, flow.value[q]) + flow.along_flow(q, change.value[q]);
            v[q]               = h * h * (factor.mass * h * change.value[q] + factor.convection * convection);
          }
        add_integrals<Number, n_cubes>(v, nodes, y);
      }
    };
  } // namespace


  template <typename Number>
  void
  add_inertia(const InstructionSet              set,
              const Cubes                      &cubes,
              const double                     *corners,
              const UndisturbedFlow            &undisturbed,
              const InertiaCoefficients<Number> factor,
              const Number                     *u,
              Number                           *y)
  {
    const FlowNumbers<Number> numbers(undisturbed);
    if (undisturbed.is_linear())
      run<InertiaInLinearFlow, Number>(set, cubes, corners, numbers, factor, u, y);
    else
      run<InertiaInQuadraticFlow, Number>(set, cubes, corners, numbers, factor, u, y);
  }


  template <typename Number>
  void
  add_inertia_derivative(const InstructionSet              set,
                         const Cubes                      &cubes,
                         const double                     *corners,
                         const UndisturbedFlow            &undisturbed,
                         const InertiaCoefficients<Number> factor,
                         const Number                     *u,
                         const Number                     *du,
                         Number                           *y)
  {
    run<InertiaDerivative, Number>(set, cubes, corners, FlowNumbers<Number>(undisturbed), factor, u, du, y);
  }


#define TANKTREAD_INSTANTIATE(Number)                                                                                                                       \
  template void add_inertia(InstructionSet, const Cubes &, const double *, const UndisturbedFlow &, InertiaCoefficients<Number>, const Number *, Number *); \
  template void add_inertia_derivative(InstructionSet,                                                                                                      \
                                       const Cubes &,                                                                                                       \
                                       const double *,                                                                                                      \
                                       const UndisturbedFlow &,                                                                                             \
                                       InertiaCoefficients<Number>,                                                                                         \
                                       const Number *,                                                                                                      \
                                       const Number *,                                                                                                      \
                                       Number *);
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
