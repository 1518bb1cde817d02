// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where the nodes of the own numbering are, rough values there, and matrices in their order.

#ifndef tanktread_oracle_node_values_h
#define tanktread_oracle_node_values_h

#include <deal.II/lac/full_matrix.h>

#include <tanktread/fluid/taylor_hood_space.h>

namespace tanktread::oracle
{
  /** A matrix between functions of the degrees given, row by row with nodes in lexicographic order, as NodeSpace has them. */
  std::vector<double>
  lexicographic(const dealii::FullMatrix<double> &matrix, unsigned int row_degree, unsigned int column_degree);

  /** Positions of the owned nodes, along periodic axes in [-side/2, side/2). */
  std::vector<dealii::Point<3>>
  node_positions(const FluidMesh &mesh, const NodeSpace &nodes);

  /** Number in [-1, 1] as random as can be, but the same for the same node on any number of ranks, and for a copy of it one period away. */
  double
  rough_value(const FluidMesh &mesh, const dealii::Point<3> &position, unsigned int component, unsigned int seed);

  /** Rough values for all components of all nodes. */
  void
  set_rough(const FluidMesh &mesh, const NodeSpace &nodes, unsigned int seed, FluidVector &vector);

  /** Points on a sphere; with a centre at an edge of the box it crosses both pairs of periodic faces. */
  std::vector<dealii::Point<3>>
  sphere_points(const dealii::Point<3> &centre, double radius);
} // namespace tanktread::oracle

#endif
