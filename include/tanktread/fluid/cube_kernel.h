// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Taylor-Hood element matrices of cubes, applied without being stored.

#ifndef tanktread_fluid_cube_kernel_h
#define tanktread_fluid_cube_kernel_h

namespace tanktread
{
  /** Which vector instructions a kernel uses; the results agree to rounding. */
  enum class InstructionSet
  {
    baseline, // whatever the compiler was told to assume
    avx2,
    avx512
  };

  /** The best one that this processor has. */
  InstructionSet
  best_instruction_set();

  /**
   * Cubes with quadratic velocities and linear pressures. A velocity node has four numbers in the arrays, its three components and one that the kernels read and write but never
   * change, so that a node is one aligned load. The arrays of sizes, velocity nodes (27 a cube) and pressure nodes (8 a cube) follow one another cube by cube,
   * nodes in lexicographic order, x fastest.
   */
  struct Cubes
  {
    unsigned int        n;
    const double       *size; // length of an edge
    const unsigned int *velocity_nodes;
    const unsigned int *pressure_nodes; // may be null for kernels without a pressure
  };

  /**
   * All kernels add to y; Number is float or double. With the shape functions' one-dimensional mass and stiffness matrices M, K diagonalised together by D the Laplace
   * matrix K x M x M + M x K x M + M x M x K is (D x D x D)^T diagonal (D x D x D), and D has small integers as entries: some ten operations for three nodes.
   */
  template <typename Number>
  void
  add_laplace(InstructionSet set, const Cubes &cubes, const Number *u, Number *y);

  /** (y_u, y_p) += [A, -B^T; -B, 0] (u, p), with A as in add_laplace and B_j,cb = integral of psi_j d phi_b/dx_c. */
  template <typename Number>
  void
  add_stokes(InstructionSet set, const Cubes &cubes, const Number *u, const Number *p, Number *y_u, Number *y_p);

  /** y_u += B^T p. */
  template <typename Number>
  void
  add_pressure_gradient(InstructionSet set, const Cubes &cubes, const Number *p, Number *y_u);

  /** y_p += mass matrix of the pressures times p. */
  template <typename Number>
  void
  add_pressure_mass(const Cubes &cubes, const Number *p, Number *y_p);

  /**
   * y += 2 (viscosity eps(u), eps(v)), the strain form, with its own viscosity at each point of the 3 x 3 x 3 Gauss rule.
   *
   * @param viscosity 27 numbers a cube, x fastest.
   */
  template <typename Number>
  void
  add_viscous(InstructionSet set, const Cubes &cubes, const Number *viscosity, const Number *u, Number *y);

  /**
   * y += 2 sum over 5 x 5 x 5 Gauss points of weight eps(u) : eps(v).
   *
   * @param weights 125 numbers a cube, x fastest, for an edge of length one.
   */
  template <typename Number>
  void
  add_weighted_viscous(InstructionSet set, const Cubes &cubes, const Number *weights, const Number *u, Number *y);

  /** As add_stokes with (viscosity grad u, grad v) + ((viscosity - least) grad u^T, grad v) in place of the Laplace matrix. */
  template <typename Number>
  void
  add_viscous_stokes(InstructionSet set, const Cubes &cubes, const Number *viscosity, Number least, const Number *u, const Number *p, Number *y_u, Number *y_p);
} // namespace tanktread

#endif
