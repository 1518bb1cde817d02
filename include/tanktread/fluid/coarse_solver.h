// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: direct solver of the Laplace equation on the first rung.

#ifndef tanktread_fluid_coarse_solver_h
#define tanktread_fluid_coarse_solver_h

#include <Eigen/Core>

#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/fluid/node_space.h>

#include <array>

namespace tanktread
{
  /**
   * Inverts the velocities' Laplace matrix on a uniform mesh, with zero on the faces with prescribed velocity. There it is K_x x M_y x M_z + M_x x K_y x M_z +
   * M_x x M_y x K_z with one-dimensional matrices K and M of the whole box, which the eigenvectors of K v = lambda M v of each axis diagonalise together. Every
   * rank solves the whole (small) problem.
   *
   * For linear functions there is no condition on those faces, and the constant, which is in the kernel then, is left out of the solution.
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

    /** dst = A^{-1} src, owned entries of full arrays, which may be the same. Collective. */
    void
    vmult(Number *dst, const Number *src) const;

  private:
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    /** What K v = lambda M v has along an axis; the columns of `modes` have the norm one with respect to M. */
    struct Axis
    {
      Matrix          modes;
      Eigen::VectorXd eigenvalues;
    };

    void
    find_places(const FluidMesh &mesh, const NodeSpace &space);

    MPI_Comm                  communicator_;
    std::vector<unsigned int> place_; // of the owned nodes in the lattice, x fastest
    std::array<Axis, 3>       axes_;
    Vector                    inverse_eigenvalue_; // of the lattice of modes
    mutable Vector            values_;
  };
} // namespace tanktread

#endif
