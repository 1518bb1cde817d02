// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the functions with kink and jump in a cell that a shell cuts, and their integrals with the finite elements and with each other.

#ifndef tanktread_coupling_cut_cell_forms_h
#define tanktread_coupling_cut_cell_forms_h

#include <deal.II/base/tensor.h>

#include <tanktread/base/vector4.h>
#include <tanktread/coupling/vertex_averages.h>
#include <tanktread/fluid/cut_cell.h>

#include <array>

namespace tanktread
{
  /** Distances of a cell's 27 nodes from a shell, in a, positive outside. */
  struct NodeDistances
  {
    std::array<double, 27> phi;
    std::array<bool, 27>   inside;
  };

  /** Amplitudes q_a of psi at the nodes for unit f_t at each vertex: [a][v]. */
  using NodeAmplitudes = std::array<std::array<double, 8>, 27>;

  /** q_a = 2/(1 + ratio) phi(x_a) M_v(x_a). */
  NodeAmplitudes
  node_amplitudes(const NodeDistances &nodes, double viscosity_ratio);

  /** Node of the vertex j of a cell. */
  constexpr unsigned int
  node_of_vertex(const unsigned int j)
  {
    return 2 * (j % 2) + 6 * (j / 2 % 2) + 18 * (j / 4);
  }

  /**
   * What a cell that the shell cuts contributes to the maps of JumpEnrichment: everything linear in the forces at its vertices, for a cell of edge one with the
   * amplitudes put in. With psi_v for f_t = 1 at the vertex v (the same for
   * all components) and eta_j = M_j (chi - i_j) for f_n = -1 at the vertex j. Vectors have four places, the last one zero.
   */
  struct CutCellForms
  {
    std::array<std::array<float, 8>, 27>                laplace;    // [b][v]: a(N_b, psi_v)
    std::array<std::array<std::array<float, 4>, 8>, 27> pressure;   // [b][j]: (eta_j, grad N_b)
    std::array<std::array<std::array<float, 4>, 8>, 8>  divergence; // [j][v]: (M_j, grad psi_v)
    std::array<std::array<float, 8>, 8>                 self;       // [v][w]: a(psi_v, psi_w)
    std::array<std::array<std::array<float, 4>, 8>, 8>  self_mixed; // [v][j]: (eta_j, grad psi_v)

    /** @param in integrals over the part of the cell inside the shell. */
    CutCellForms(const NodeDistances &nodes, const PartialCellMatrices &in, const NodeAmplitudes &q, double viscosity_ratio);

    /** loads = -a(psi, N_b) + (eta, div N_b) of forces at the vertices in a cell of size h. */
    void
    node_loads(double h, const VertexForces &f, std::array<Vector4, 27> &loads) const;

    /** The same of (q, div psi) with the pressure functions M_j: [j]. */
    std::array<double, 8>
    pressure_loads(double h, const VertexForces &f) const;

    /** The transpose of both: r += what is dual to forces at the vertices. @param u velocities at the nodes. @param p pressures at the vertices. */
    void
    add_response(double h, const std::array<Vector4, 27> &u, const std::array<double, 8> &p, VertexForces &r) const;

    /** r += -a(psi, psi_v) + (eta, div psi_v) + (eta_v, div psi) */
    void
    add_self_response(double h, const VertexForces &f, VertexForces &r) const;
  };

  /** psi_v on a shell, where it is minus the sum over the nodes inside of q_a N_a; so it is anywhere outside. */
  std::array<double, 8>
  psi_outside(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit);

  /** Mean of grad psi_v on both sides of the shell, in a cell of size h. */
  std::array<Vector4, 8>
  mean_slopes(const NodeDistances &nodes, const NodeAmplitudes &q, const dealii::Point<3> &unit, double h);

  /** 2 ((ratio - 1) eps(u_inf), eps(psi_v)) inside the shell for an undisturbed flow with this velocity gradient, for a cell of edge one. */
  std::array<std::array<float, 4>, 8>
  undisturbed_stress(const NodeDistances        &nodes,
                     const PartialCellMatrices  &in,
                     const NodeAmplitudes       &q,
                     const dealii::Tensor<2, 3> &flow_gradient,
                     double                      viscosity_ratio);

  /** A vector of single precision as one of four numbers. */
  inline Vector4
  vector4(const std::array<float, 4> &v)
  {
    return {v[0], v[1], v[2]};
  }

  /** f with zero in the fourth place. */
  inline Vector4
  tangential(const Vector4 &f)
  {
    return {f[0], f[1], f[2]};
  }

  inline double
  sum3(const Vector4 &v)
  {
    return v[0] + v[1] + v[2];
  }
} // namespace tanktread

#endif
