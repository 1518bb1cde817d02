// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the functions with kink and jump in a cell that a shell cuts, and their integrals with the finite elements and with each other.

#include <tanktread/base/target_clones.h>
#include <tanktread/coupling/cut_cell_forms.h>

namespace tanktread
{
  namespace
  {
    /** The quadratic functions of an axis and their derivatives at x. */
    struct AxisFunctions
    {
      explicit AxisFunctions(const double x)
        : value{(1. - x) * (1. - 2. * x), 4. * x * (1. - x), x * (2. * x - 1.)}
        , slope{4. * x - 3., 4. - 8. * x, 4. * x - 1.}
      {}

      double value[3], slope[3];
    };


    /** The trilinear functions at the 27 nodes. */
    const std::array<std::array<double, 8>, 27> &
    hats_at_nodes()
    {
      static const auto result = [] {
        std::array<std::array<double, 8>, 27> values;
        for (unsigned int a = 0; a < 27; ++a)
          values[a] = hat_functions(dealii::Point<3>(0.5 * (a % 3), 0.5 * (a / 3 % 3), 0.5 * (a / 9)));
        return values;
      }();
      return result;
    }


    TANKTREAD_CLONES void
    set_node_loads(const std::array<std::array<float, 8>, 27>                &laplace,
                   const std::array<std::array<std::array<float, 4>, 8>, 27> &pressure,
                   const double                                               h,
                   const std::array<Vector4, 8>                              &f,
                   std::array<Vector4, 27>                                   &loads)
    {
      Vector4 f_t[8];
      double  eta[8];
      for (unsigned int v = 0; v < 8; ++v)
        {
          f_t[v] = -h * tangential(f[v]);
          eta[v] = -h * h * f[v][3];
        }
      for (unsigned int b = 0; b < 27; ++b)
        {
          Vector4 sum;
          for (unsigned int v = 0; v < 8; ++v)
            {
              sum += double(laplace[b][v]) * f_t[v];
              sum += eta[v] * vector4(pressure[b][v]);
            }
          loads[b] = sum;
        }
    }


    /** The transpose: adds to what is dual to forces at the vertices. */
    TANKTREAD_CLONES void
    add_node_response(const std::array<std::array<float, 8>, 27>                &laplace,
                      const std::array<std::array<std::array<float, 4>, 8>, 27> &pressure,
                      const double                                               h,
                      const std::array<Vector4, 27>                             &u,
                      std::array<Vector4, 8>                                    &r)
    {
      Vector4 sums[8], products[8];
      for (unsigned int b = 0; b < 27; ++b)
        for (unsigned int v = 0; v < 8; ++v)
          {
            sums[v] += double(laplace[b][v]) * u[b];
            products[v] += vector4(pressure[b][v]).times(u[b]);
          }
      for (unsigned int v = 0; v < 8; ++v)
        r[v] += -h * sums[v] + Vector4(0., 0., 0., -h * h * sum3(products[v]));
    }


    /** laplace and self. */
    TANKTREAD_CLONES void
    set_velocity_forms(const NodeDistances &nodes, const PartialCellMatrices &in, const NodeAmplitudes &q, const double viscosity_ratio, CutCellForms &forms)
    {
      const PartialCellMatrices &whole     = whole_cell_matrices();
      NodeAmplitudes             same_side = {};
      // chi - i_a is chi for a node outside and minus the indicator of the outside for one inside.
      for (unsigned int b = 0; b < 27; ++b)
        {
          std::array<double, 8> row = {}, row_same = {};
          for (unsigned int a = 0; a < 27; ++a)
            {
              const double entry = nodes.inside[a] ? double(in.laplace[b][a]) - whole.laplace[b][a] : viscosity_ratio * in.laplace[b][a];
              for (unsigned int v = 0; v < 8; ++v)
                row[v] += entry * q[a][v];
              if (nodes.inside[a] == nodes.inside[b])
                for (unsigned int v = 0; v < 8; ++v)
                  row_same[v] += (nodes.inside[a] ? -entry : entry) * q[a][v];
            }
          for (unsigned int v = 0; v < 8; ++v)
            forms.laplace[b][v] = row[v];
          same_side[b] = row_same;
        }
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int w = 0; w < 8; ++w)
          {
            double sum = 0.;
            for (unsigned int b = 0; b < 27; ++b)
              sum += q[b][v] * same_side[b][w];
            forms.self[v][w] = sum;
          }
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int w = 0; w < v; ++w)
          forms.self[v][w] = forms.self[w][v];
    }


    /** pressure, divergence and self_mixed. */
    TANKTREAD_CLONES void
    set_pressure_forms(const NodeDistances &nodes, const PartialCellMatrices &in, const NodeAmplitudes &q, CutCellForms &forms)
    {
      const PartialCellMatrices &whole = whole_cell_matrices();
      for (unsigned int j = 0; j < 8; ++j)
        {
          const bool vertex_inside = nodes.inside[node_of_vertex(j)];
          for (unsigned int c = 0; c < 3; ++c)
            {
              std::array<double, 8> row = {}, row_same = {};
              for (unsigned int a = 0; a < 27; ++a)
                {
                  const double inside = in.divergence[j][27 * c + a], all = whole.divergence[j][27 * c + a];
                  const double entry      = nodes.inside[a] ? inside - all : inside;
                  forms.pressure[a][j][c] = vertex_inside ? inside - all : inside;
                  for (unsigned int v = 0; v < 8; ++v)
                    row[v] += entry * q[a][v];
                  if (nodes.inside[a] == vertex_inside)
                    for (unsigned int v = 0; v < 8; ++v)
                      row_same[v] += (vertex_inside ? -entry : entry) * q[a][v];
                }
              for (unsigned int v = 0; v < 8; ++v)
                {
                  forms.divergence[j][v][c] = row[v];
                  forms.self_mixed[v][j][c] = row_same[v];
                }
            }
        }
    }
  } // namespace


  NodeAmplitudes
  node_amplitudes(const NodeDistances &nodes, const double viscosity_ratio)
  {
    NodeAmplitudes q;
    for (unsigned int a = 0; a < 27; ++a)
      for (unsigned int v = 0; v < 8; ++v)
        q[a][v] = 2. / (1. + viscosity_ratio) * nodes.phi[a] * hats_at_nodes()[a][v];
    return q;
  }


  CutCellForms::CutCellForms(const NodeDistances &nodes, const PartialCellMatrices &in, const NodeAmplitudes &q, const double viscosity_ratio)
    : laplace{}
    , pressure{}
    , divergence{}
    , self{}
    , self_mixed{}
  {
    set_velocity_forms(nodes, in, q, viscosity_ratio, *this);
    set_pressure_forms(nodes, in, q, *this);
  }


  void
  CutCellForms::node_loads(const double h, const VertexForces &f, std::array<Vector4, 27> &loads) const
  {
    set_node_loads(laplace, pressure, h, f, loads);
  }


  TANKTREAD_CLONES std::array<double, 8>
                   CutCellForms::pressure_loads(const double h, const VertexForces &f) const
  {
    std::array<double, 8> result;
    for (unsigned int j = 0; j < 8; ++j)
      {
        Vector4 sum;
        for (unsigned int v = 0; v < 8; ++v)
          sum += vector4(divergence[j][v]).times(f[v]);
        result[j] = h * h * sum3(sum);
      }
    return result;
  }


  TANKTREAD_CLONES void
  CutCellForms::add_response(const double h, const std::array<Vector4, 27> &u, const std::array<double, 8> &p, VertexForces &r) const
  {
    add_node_response(laplace, pressure, h, u, r);
    for (unsigned int j = 0; j < 8; ++j)
      for (unsigned int v = 0; v < 8; ++v)
        r[v] += (h * h * p[j]) * vector4(divergence[j][v]);
  }


  TANKTREAD_CLONES void
  CutCellForms::add_self_response(const double h, const VertexForces &f, VertexForces &r) const
  {
    for (unsigned int v = 0; v < 8; ++v)
      {
        Vector4 sum;
        for (unsigned int w = 0; w < 8; ++w)
          sum += -h * self[v][w] * tangential(f[w]) + -h * h * f[w][3] * vector4(self_mixed[v][w]);
        r[v] += sum;
        for (unsigned int j = 0; j < 8; ++j)
          r[j] += Vector4(0., 0., 0., -h * h * sum3(vector4(self_mixed[v][j]).times(f[v])));
      }
  }


  std::array<double, 8>
  psi_outside(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit)
  {
    const AxisFunctions   x(unit[0]), y(unit[1]), z(unit[2]);
    std::array<double, 8> psi = {};
    for (unsigned int a = 0; a < 27; ++a)
      if (nodes.inside[a])
        {
          const double N = x.value[a % 3] * y.value[a / 3 % 3] * z.value[a / 9];
          for (unsigned int v = 0; v < 8; ++v)
            psi[v] -= N * q[a][v];
        }
    return psi;
  }


  std::array<Vector4, 8>
  mean_slopes(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit, const double h)
  {
    const AxisFunctions    x(unit[0]), y(unit[1]), z(unit[2]);
    std::array<Vector4, 8> result;
    for (unsigned int a = 0; a < 27; ++a)
      {
        const unsigned int i = a % 3, j = a / 3 % 3, k = a / 9;
        const Vector4      gradient(x.slope[i] * y.value[j] * z.value[k], x.value[i] * y.slope[j] * z.value[k], x.value[i] * y.value[j] * z.slope[k]);
        for (unsigned int v = 0; v < 8; ++v)
          result[v] += ((nodes.inside[a] ? -0.5 : 0.5) * q[a][v] / h) * gradient;
      }
    return result;
  }


  std::array<std::array<float, 4>, 8>
  undisturbed_stress(const NodeDistances        &nodes,
                     const PartialCellMatrices  &in,
                     const NodeAmplitudes       &q,
                     const dealii::Tensor<2, 3> &flow_gradient,
                     const double                viscosity_ratio)
  {
    // Twice the strain rate of the undisturbed flow against that of psi, whose inner part has the amplitudes of the nodes outside.
    const dealii::Tensor<2, 3>          S      = (viscosity_ratio - 1.) * (flow_gradient + transpose(flow_gradient));
    std::array<std::array<float, 4>, 8> result = {};
    for (unsigned int v = 0; v < 8; ++v)
      {
        dealii::Tensor<1, 3> slope;
        for (unsigned int a = 0; a < 27; ++a)
          if (!nodes.inside[a])
            for (unsigned int d = 0; d < 3; ++d)
              for (unsigned int j = 0; j < 8; ++j)
                slope[d] += q[a][v] * in.divergence[j][27 * d + a];
        const dealii::Tensor<1, 3> stress = S * slope;
        for (unsigned int c = 0; c < 3; ++c)
          result[v][c] = stress[c];
      }
    return result;
  }
} // namespace tanktread
