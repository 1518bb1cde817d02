// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: direct solver of the Laplace equation on the first rung.

#ifndef tanktread_fluid_coarse_solver_h
#define tanktread_fluid_coarse_solver_h

#include <Eigen/Core>

#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/fluid/node_space.h>

namespace tanktread
{
  /**
   * Inverts the velocities' Laplace matrix on a uniform mesh, periodic in x and y, zero at the walls. There it is K x M x M + M x K x M + M x M x K with one-dimensional matrices K
   * and M of the whole box, which the eigenvectors of K v = lambda M v diagonalise together. Every rank solves the whole (small) problem.
   *
   * For linear functions there is no condition at the walls, and the constant, which is in the kernel then, is left out of the solution.
   */
  template <typename Number>
  class CoarseSolver
  {
  public:
    /** `mesh` has to be on its first rung, `space` its quadratic or linear nodes. Collective. */
    CoarseSolver(const FluidMesh &mesh, const NodeSpace &space);

    /** From now on A + shift times the mass matrix is inverted. */
    void
    set_shift(double shift);

    /** u = A^{-1} f, owned entries of full arrays. Collective. */
    void
    solve(const Number *f, Number *u) const;

  private:
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    MPI_Comm                  communicator_;
    std::vector<unsigned int> place_; // of the owned nodes in the lattice, x fastest
    Matrix                    periodic_modes_, wall_modes_;
    Eigen::VectorXd           periodic_eigenvalue_, wall_eigenvalue_;
    Vector                    inverse_eigenvalue_; // of the lattice of modes
    mutable Vector            values_;
  };
} // namespace tanktread

#endif
