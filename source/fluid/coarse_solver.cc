// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: direct solver of the Laplace equation on the first rung.

#include <deal.II/base/mpi.h>

#include <Eigen/Eigenvalues>
#include <tanktread/fluid/coarse_solver.h>

namespace tanktread
{
  namespace
  {
    struct Modes
    {
      Eigen::VectorXd values;
      Eigen::MatrixXd vectors; // V^T M V = 1
    };

    /** One-dimensional elements of degree 2 or 1, n of size h, periodic or, of degree 2, zero at both ends (which then have no rows). */
    Modes
    modes(const int n, const double h, const bool periodic, const int degree)
    {
      Eigen::Matrix3d mass, stiffness;
      if (degree == 2)
        {
          mass << 4, 2, -1, 2, 16, 2, -1, 2, 4;
          stiffness << 7, -8, 1, -8, 16, -8, 1, -8, 7;
        }
      else
        {
          mass << 10, 5, 0, 5, 10, 0, 0, 0, 0;
          stiffness << 3, -3, 0, -3, 3, 0, 0, 0, 0;
        }
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(degree * n + 1, degree * n + 1), K = M;
      const auto      place = [&](const int i) { return periodic ? i % (degree * n) : i; };
      for (int cell = 0; cell < n; ++cell)
        for (int a = 0; a <= degree; ++a)
          for (int b = 0; b <= degree; ++b)
            {
              M(place(degree * cell + a), place(degree * cell + b)) += h / 30. * mass(a, b);
              K(place(degree * cell + a), place(degree * cell + b)) += stiffness(a, b) / (3. * h);
            }
      const bool                                                      zero_at_ends = !periodic && degree == 2;
      const int                                                       first = zero_at_ends ? 1 : 0, size = periodic ? degree * n : degree * n + 1 - 2 * first;
      const Eigen::MatrixXd                                           M_free = M.block(first, first, size, size), K_free = K.block(first, first, size, size);
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K_free, M_free);
      return {solver.eigenvalues(), solver.eigenvectors()};
    }
  } // namespace


  template <typename Number>
  CoarseSolver<Number>::CoarseSolver(const FluidMesh &mesh, const NodeSpace &space)
    : communicator_(mesh.communicator())
    , place_(space.n_owned())
  {
    const int   degree = space.nodes_per_cell() == 8 ? 1 : 2, n = mesh.n_rung_0(), n_x = degree * n, n_z = degree == 1 ? n + 1 : 2 * n - 1;
    const Modes periodic = modes(n, mesh.cell_size(0), true, degree), wall = modes(n, mesh.cell_size(0), false, degree);
    periodic_modes_      = periodic.vectors.cast<Number>();
    wall_modes_          = wall.vectors.cast<Number>();
    periodic_eigenvalue_ = periodic.values;
    wall_eigenvalue_     = wall.values;
    inverse_eigenvalue_.resize(n_x * n_x * n_z);
    set_shift(0.);
    values_.resize(3 * inverse_eigenvalue_.size());

    unsigned int cell_number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto          position = mesh.key(cell).position;
          const unsigned int *nodes    = space.cell_nodes(cell_number++);
          const int           line = degree + 1, below = degree == 2 ? 1 : 0; // nodes at the lower wall, which have no place
          for (int a = 0; a < line * line * line; ++a)
            if (nodes[a] < space.n_owned())
              place_[nodes[a]] = (degree * position[0] + a % line) % n_x +
                n_x * ((degree * position[1] + a / line % line) % n_x + n_x * (degree * position[2] + a / (line * line) - below));
        }
  }


  template <typename Number>
  void
  CoarseSolver<Number>::set_shift(const double shift)
  {
    const Eigen::Index n_x = periodic_eigenvalue_.size(), n_z = wall_eigenvalue_.size();
    for (Eigen::Index k = 0; k < n_z; ++k)
      for (Eigen::Index j = 0; j < n_x; ++j)
        for (Eigen::Index i = 0; i < n_x; ++i)
          {
            const double eigenvalue                      = periodic_eigenvalue_[i] + periodic_eigenvalue_[j] + wall_eigenvalue_[k] + shift;
            inverse_eigenvalue_[i + n_x * (j + n_x * k)] = eigenvalue > 1e-10 * wall_eigenvalue_[n_z - 1] ? 1. / eigenvalue : 0.;
          }
  }


  template <typename Number>
  void
  CoarseSolver<Number>::solve(const Number *const f, Number *const u) const
  {
    const Eigen::Index n_x = periodic_modes_.rows(), n_z = wall_modes_.rows(), size = inverse_eigenvalue_.size();
    values_.setZero();
    for (std::size_t i = 0; i < place_.size(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c)
        values_[place_[i] + size * c] = f[4 * i + c];
    MPI_Allreduce(MPI_IN_PLACE, values_.data(), values_.size(), sizeof(Number) == 4 ? MPI_FLOAT : MPI_DOUBLE, MPI_SUM, communicator_);

    // Each product transforms the index that runs fastest and, transposed, makes it the slowest: (x, y, z, c) -> (y, z, c, x) -> (z, c, x, y) -> (c, x, y, z).
    using Map   = Eigen::Map<const Matrix>;
    Matrix work = Map(values_.data(), n_x, n_x * n_z * 3).transpose() * periodic_modes_;
    work        = (Map(work.data(), n_x, n_x * n_z * 3).transpose() * periodic_modes_).eval();
    work        = (Map(work.data(), n_z, n_x * n_x * 3).transpose() * wall_modes_).eval();
    Eigen::Map<Matrix> modes(work.data(), 3, size);
    modes.array().rowwise() *= inverse_eigenvalue_.transpose().array();
    // And back: the slowest index is transformed and becomes the fastest.
    work = (wall_modes_ * Map(work.data(), 3 * n_x * n_x, n_z).transpose()).eval();
    work = (periodic_modes_ * Map(work.data(), n_z * 3 * n_x, n_x).transpose()).eval();
    work = (periodic_modes_ * Map(work.data(), n_x * n_z * 3, n_x).transpose()).eval();

    for (std::size_t i = 0; i < place_.size(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c)
        u[4 * i + c] = work.data()[place_[i] + size * c];
  }


  template class CoarseSolver<float>;
  template class CoarseSolver<double>;
} // namespace tanktread
