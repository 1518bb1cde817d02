// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the factorised implicit operator of the shell, kept from one linearisation to the next.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/solver/implicit_shell.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  ImplicitShell::ImplicitShell(MPI_Comm communicator)
  {
    int rank;
    MPI_Comm_rank(communicator, &rank);
    communicator_ = communicator;
    first_rank_   = rank == 0;
  }


  bool
  ImplicitShell::serves(const double tau) const
  {
    return tau_ > 0. && !worn_out_ && tau <= 1.5 * tau_ && tau_ <= 1.5 * tau;
  }


  void
  ImplicitShell::renew(const SparseMatrix &Z, const Eigen::Matrix3d &flow_gradient, const SparseMatrix &K_pi, const double tau)
  {
    discard();
    on_first_rank(communicator_, [&] {
      SparseMatrix sum = K_pi;
      sum.coeffs() *= tau;
      drift_ = Eigen::Matrix3d::Identity() - tau * flow_gradient;
      add_for_three_components(Z, sum, drift_);
      factors_.factorise(sum, "The shell's implicit operator, for this time step,");
      Z_ = Z;
    });
    tau_                   = tau;
    worn_out_              = false;
    iterations_per_decade_ = 0.;
    ++n_renewals_;
  }


  void
  ImplicitShell::watch(const LinearReport &report)
  {
    if (!(report.final_residual < report.initial_residual) || !(report.final_residual > 0.))
      {
        worn_out_ = report.iterations > 0;
        return;
      }
    const double per_decade = report.iterations / std::log10(report.initial_residual / report.final_residual);
    if (iterations_per_decade_ > 0. && report.iterations * (1. - 1.1 * iterations_per_decade_ / per_decade) > 1.)
      worn_out_ = true;
    // The least of all: a last solve that has little left to do may look dear.
    iterations_per_decade_ = iterations_per_decade_ > 0. ? std::min(iterations_per_decade_, per_decade) : per_decade;
  }


  ControlPoints
  ImplicitShell::velocity(const ControlPoints &force) const
  {
    if (!first_rank_)
      return ControlPoints::Zero(force.rows(), 3);
    const Eigen::VectorXd solution = factors_.solve(Eigen::Map<const Eigen::VectorXd>(force.data(), force.size()));
    return Eigen::Map<const ControlPoints>(solution.data(), force.rows(), 3);
  }


  ControlPoints
  ImplicitShell::damped(const ControlPoints &force) const
  {
    if (!first_rank_)
      return ControlPoints::Zero(force.rows(), 3);
    return Z_ * velocity(force) * drift_.transpose();
  }
} // namespace tanktread
