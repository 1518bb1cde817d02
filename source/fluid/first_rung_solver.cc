// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: solver on the first rung of the multigrid, where the viscosity may vary.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/first_rung_solver.h>

#include <algorithm>

namespace tanktread
{
  template <typename Number>
  FirstRungSolver<Number>::FirstRungSolver(const FluidMesh &mesh, const LaplaceOperator<Number> &A)
    : A_(A)
    , direct_(mesh, A.space())
    , residual_(A.space().full_size())
    , direction_(A.space().full_size())
  {}


  template <typename Number>
  void
  FirstRungSolver<Number>::set_shift(const double shift)
  {
    direct_.set_shift(shift);
  }


  template <typename Number>
  void
  FirstRungSolver<Number>::set_viscosity(const std::vector<double> &viscosities)
  {
    const MPI_Comm communicator = A_.space().partitioner()->get_mpi_communicator();
    double         smallest = 1., largest = 1.; // a rank may have no cell; and the mass matrix of inertia counts like a viscosity of one
    for (const double mu : viscosities)
      {
        smallest = std::min(smallest, mu);
        largest  = std::max(largest, mu);
      }
    smallest_ = dealii::Utilities::MPI::min(smallest, communicator);
    largest_  = dealii::Utilities::MPI::max(largest, communicator);
  }


  template <typename Number>
  void
  FirstRungSolver<Number>::vmult(dealii::AlignedVector<Number> &x, const dealii::AlignedVector<Number> &b) const
  {
    direct_.vmult(x.data(), b.data());
    if (smallest_ == 1. && largest_ == 1.)
      return;
    const double      center = 0.5 * (largest_ + smallest_), half = 0.5 * (largest_ - smallest_), t = center / half;
    const std::size_t n = 4 * std::size_t(A_.space().n_owned());
    for (std::size_t j = 0; j < n; ++j)
      x[j] = direction_[j] = x[j] / Number(center);
    double rho = 1. / t;
    for (double before = 1., polynomial = t; polynomial < 10.;) // the error is one over it: T_k(t)
      {
        A_.apply(x.data(), residual_.data());
        for (std::size_t j = 0; j < n; ++j)
          residual_[j] = b[j] - residual_[j];
        direct_.vmult(residual_.data(), residual_.data());
        const double next = 1. / (2. * t - rho);
        const Number f_d = next * rho, f_r = 2. * next / half;
        for (std::size_t j = 0; j < n; ++j)
          x[j] += direction_[j] = f_d * direction_[j] + f_r * residual_[j];
        rho                           = next;
        const double polynomial_after = 2. * t * polynomial - before;
        before                        = polynomial;
        polynomial                    = polynomial_after;
      }
  }


  template class FirstRungSolver<float>;
  template class FirstRungSolver<double>;
} // namespace tanktread
