// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: direct solver of the Laplace equation on the first rung.

#include <deal.II/base/mpi.h>

#include <Eigen/Eigenvalues>
#include <tanktread/base/counts.h>
#include <tanktread/fluid/coarse_solver.h>
#include <tanktread/fluid/quadratic_element.h>

namespace tanktread
{
  namespace
  {
    struct LineMatrices
    {
      Eigen::MatrixXd mass, stiffness;
    };

    /** Of a one-dimensional element of degree 1 or 2 and size h. */
    LineMatrices
    element_matrices(const unsigned int degree, const double h)
    {
      LineMatrices       result{Eigen::MatrixXd::Zero(degree + 1, degree + 1), Eigen::MatrixXd::Zero(degree + 1, degree + 1)};
      const UnitGauss<3> rule;
      for (unsigned int q = 0; q < 3; ++q)
        {
          const double                x      = rule.abscissa[q];
          const std::array<double, 3> values = degree == 2 ? quadratic_values(x) : std::array<double, 3>{{1. - x, x, 0.}},
                                      slopes = degree == 2 ? quadratic_slopes(x) : std::array<double, 3>{{-1., 1., 0.}};
          for (unsigned int a = 0; a <= degree; ++a)
            for (unsigned int b = 0; b <= degree; ++b)
              {
                result.mass(a, b) += h * rule.weight[q] * values[a] * values[b];
                result.stiffness(a, b) += rule.weight[q] / h * slopes[a] * slopes[b];
              }
        }
      return result;
    }


    /** Of n elements of size h, periodic or, of degree 2, zero at both ends (which then have no rows). */
    LineMatrices
    line_matrices(const int n, const double h, const bool periodic, const int degree)
    {
      const LineMatrices element = element_matrices(degree, h);
      const int          size    = degree * n + 1;
      LineMatrices       all{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)};
      const auto         place = [&](const int i) { return periodic ? i % (degree * n) : i; };
      for (int cell = 0; cell < n; ++cell)
        for (int a = 0; a <= degree; ++a)
          for (int b = 0; b <= degree; ++b)
            {
              const int row = place(degree * cell + a), column = place(degree * cell + b);
              all.mass(row, column) += element.mass(a, b);
              all.stiffness(row, column) += element.stiffness(a, b);
            }
      const int first = !periodic && degree == 2 ? 1 : 0, n_free = periodic ? size - 1 : size - 2 * first;
      return {all.mass.block(first, first, n_free, n_free), all.stiffness.block(first, first, n_free, n_free)};
    }
  } // namespace


  template <typename Number>
  CoarseSolver<Number>::CoarseSolver(const FluidMesh &mesh, const NodeSpace &space)
    : communicator_(mesh.communicator())
    , place_(space.n_owned())
  {
    const int    degree = space.nodes_per_cell() == 8 ? 1 : 2;
    Eigen::Index size   = 1;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const LineMatrices line = line_matrices(mesh.n_rung_0()[d], mesh.cell_size(0), mesh.box().is_periodic(d), degree);
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(line.stiffness, line.mass);
        axes_[d] = {solver.eigenvectors().template cast<Number>(), solver.eigenvalues()};
        size *= solver.eigenvalues().size();
      }
    inverse_eigenvalue_.resize(size);
    values_.resize(3 * size);
    set_shift(0.);
    find_places(mesh, space);
  }


  template <typename Number>
  void
  CoarseSolver<Number>::find_places(const FluidMesh &mesh, const NodeSpace &space)
  {
    const int    degree = space.nodes_per_cell() == 8 ? 1 : 2, line = degree + 1;
    unsigned int cell_number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto          position = mesh.key(cell).position;
          const unsigned int *nodes    = space.cell_nodes(cell_number++);
          for (int a = 0; a < line * line * line; ++a)
            {
              if (nodes[a] >= space.n_owned())
                continue;
              const std::array<int, 3> in_cell = {{a % line, a / line % line, a / (line * line)}};
              Eigen::Index             place   = 0;
              for (unsigned int d = 3; d-- > 0;)
                {
                  const Eigen::Index n       = axes_[d].eigenvalues.size();
                  const Eigen::Index in_line = degree * position[d] + in_cell[d];
                  const bool         no_ends = degree == 2 && !mesh.box().is_periodic(d); // the first row is that of the first node inside
                  place                      = n * place + (no_ends ? in_line - 1 : in_line % n);
                }
              place_[nodes[a]] = place;
            }
        }
  }


  template <typename Number>
  void
  CoarseSolver<Number>::set_shift(const double shift)
  {
    const Eigen::VectorXd &x = axes_[0].eigenvalues, &y = axes_[1].eigenvalues, &z = axes_[2].eigenvalues;
    const double           least = 1e-10 * (x.maxCoeff() + y.maxCoeff() + z.maxCoeff()); // below it there is the constant alone
    Eigen::Index           mode  = 0;
    for (Eigen::Index k = 0; k < z.size(); ++k)
      for (Eigen::Index j = 0; j < y.size(); ++j)
        for (Eigen::Index i = 0; i < x.size(); ++i)
          {
            const double eigenvalue     = x[i] + y[j] + z[k] + shift;
            inverse_eigenvalue_[mode++] = eigenvalue > least ? 1. / eigenvalue : 0.;
          }
  }


  template <typename Number>
  void
  CoarseSolver<Number>::vmult(Number *const dst, const Number *const src) const
  {
    const Matrix      &X = axes_[0].modes, &Y = axes_[1].modes, &Z = axes_[2].modes;
    const Eigen::Index n_x = X.rows(), n_y = Y.rows(), n_z = Z.rows(), size = inverse_eigenvalue_.size();
    values_.setZero();
    for (std::size_t i = 0; i < place_.size(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c)
        values_[place_[i] + size * c] = src[4 * i + c];
    MPI_Allreduce(MPI_IN_PLACE,
                  values_.data(),
                  mpi_count(values_.size(), "numbers on the first rung"),
                  sizeof(Number) == 4 ? MPI_FLOAT : MPI_DOUBLE,
                  MPI_SUM,
                  communicator_);

    // Each product transforms the index that runs fastest and, transposed, makes it the slowest: (x, y, z, c) -> (y, z, c, x) -> (z, c, x, y) -> (c, x, y, z).
    using Map   = Eigen::Map<const Matrix>;
    Matrix work = Map(values_.data(), n_x, n_y * n_z * 3).transpose() * X;
    work        = (Map(work.data(), n_y, n_z * 3 * n_x).transpose() * Y).eval();
    work        = (Map(work.data(), n_z, 3 * n_x * n_y).transpose() * Z).eval();
    Eigen::Map<Matrix> modes(work.data(), 3, size);
    modes.array().rowwise() *= inverse_eigenvalue_.transpose().array();
    // And back: the slowest index is transformed and becomes the fastest.
    work = (Z * Map(work.data(), 3 * n_x * n_y, n_z).transpose()).eval();
    work = (Y * Map(work.data(), n_z * 3 * n_x, n_y).transpose()).eval();
    work = (X * Map(work.data(), n_y * n_z * 3, n_x).transpose()).eval();

    for (std::size_t i = 0; i < place_.size(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c)
        dst[4 * i + c] = work.data()[place_[i] + size * c];
  }


  template class CoarseSolver<float>;
  template class CoarseSolver<double>;
} // namespace tanktread
