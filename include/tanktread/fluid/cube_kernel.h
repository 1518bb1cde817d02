// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Taylor-Hood element matrices of cubes, applied without being stored.

#ifndef tanktread_fluid_cube_kernel_h
#define tanktread_fluid_cube_kernel_h

namespace tanktread
{
  struct UndisturbedFlow;

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
   * Cubes with quadratic velocities and linear pressures. A velocity node has four numbers in the arrays, its three components and one that the kernels read
   * and write but never
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
   * All kernels add to y; Number is float or double. With the shape functions' one-dimensional mass and stiffness matrices M, K diagonalised together by D the
   * Laplace
   * matrix K x M x M + M x K x M + M x M x K is (D x D x D)^T diagonal (D x D x D), and D has small integers as entries: some ten operations for three nodes.
   */
  template <typename Number>
  void
  add_laplace(InstructionSet set, const Cubes &cubes, const Number *u, Number *y);

  /**
   * y += (Laplace matrix + mass times that of the unit cube's shape functions) u. @param mass one number a cube: the volume times what the mass matrix is to be
   * multiplied by.
   */
  template <typename Number>
  void
  add_helmholtz(InstructionSet set, const Cubes &cubes, const double *mass, const Number *u, Number *y);

  /** y += Laplace matrix of the linear functions times p, at the pressure nodes, for each of four numbers a node. */
  template <typename Number>
  void
  add_linear_laplace(const Cubes &cubes, const Number *p, Number *y);

  /** (y_u, y_p) += [A, -B^T; -B, 0] (u, p), with A as in add_laplace and B_j,cb = integral of psi_j d phi_b/dx_c. */
  template <typename Number>
  void
  add_stokes(InstructionSet set, const Cubes &cubes, const Number *u, const Number *p, Number *y_u, Number *y_p);

  /** y_u += B^T p. */
  template <typename Number>
  void
  add_pressure_gradient(InstructionSet set, const Cubes &cubes, const Number *p, Number *y_u);

  /** y_p += B u. */
  template <typename Number>
  void
  add_divergence(InstructionSet set, const Cubes &cubes, const Number *u, Number *y_p);

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

  /**
   * The same with one viscosity a cube: y += (viscosity grad u, grad v) + ((viscosity - least) grad u^T, grad v). Both terms are sparse in the basis that
   * diagonalises the Laplace matrix: it costs little more than add_laplace.
   */
  template <typename Number>
  void
  add_uniform_viscous(InstructionSet set, const Cubes &cubes, const double *viscosity, double least, const Number *u, Number *y);

  /** As add_stokes with that in place of the Laplace matrix. */
  template <typename Number>
  void
  add_uniform_viscous_stokes(InstructionSet set,
                             const Cubes   &cubes,
                             const double  *viscosity,
                             double         least,
                             const Number  *u,
                             const Number  *p,
                             Number        *y_u,
                             Number        *y_p);

  /** Factors of the terms of inertia. */
  template <typename Number>
  struct InertiaCoefficients
  {
    Number mass, convection;
  };

  /**
   * y += mass (u, v) + convection ((u_inf + u) . grad u + u . grad u_inf, v), by the 3 x 3 x 3 Gauss rule: the first term exactly. The undisturbed flow u_inf
   * comes as the polynomial that it is: an array of nodes, where periodic copies are one, could not hold it.
   *
   * @param corners three numbers a cube, the coordinates of its lower corner.
   */
  template <typename Number>
  void
  add_inertia(InstructionSet              set,
              const Cubes                &cubes,
              const double               *corners,
              const UndisturbedFlow      &undisturbed,
              InertiaCoefficients<Number> factor,
              const Number               *u,
              Number                     *y);

  /** The derivative at u: y += mass (du, v) + convection ((u_inf + u) . grad du + du . grad (u_inf + u), v). */
  template <typename Number>
  void
  add_inertia_derivative(InstructionSet              set,
                         const Cubes                &cubes,
                         const double               *corners,
                         const UndisturbedFlow      &undisturbed,
                         InertiaCoefficients<Number> factor,
                         const Number               *u,
                         const Number               *du,
                         Number                     *y);
} // namespace tanktread

#endif
