// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the factorised implicit operators of the shells, kept from one linearisation to the next.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/solver/implicit_shells.h>
#include <tanktread/surface/assembly_pattern.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tanktread
{
  ImplicitShells::ImplicitShells(const ShellLayout &layout, SolverMemory &memory)
    : layout_(layout)
    , memory_(memory)
    , factors_(layout.n_capsules())
  {
    for (unsigned int c = 0; c < layout.n_capsules(); ++c)
      if (layout.owns(c))
        factors_[c] = std::make_unique<BlockFactorisation>();
  }


  bool
  ImplicitShells::serves(const double tau) const
  {
    return memory_.tau > 0. && !memory_.worn_out && tau <= 1.5 * memory_.tau && memory_.tau <= 1.5 * tau;
  }


  Eigen::Matrix3d
  ImplicitShells::drift(const unsigned int c) const
  {
    return Eigen::Matrix3d::Identity() - memory_.tau * memory_.operators[c].flow_gradient;
  }


  void
  ImplicitShells::factorise(const unsigned int c)
  {
    SparseMatrix sum = memory_.operators[c].K_pi;
    sum.coeffs() *= memory_.tau;
    add_for_three_components(memory_.operators[c].Z, sum, drift(c));
    factors_[c]->factorise(sum, "The shell's implicit operator, for this time step,");
  }


  void
  ImplicitShells::renew(std::vector<ImplicitOperator> operators, const double tau)
  {
    memory_.operators = std::move(operators);
    memory_.tau       = tau;
    try
      {
        on_all_ranks(layout_.communicator(), [&] {
          for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
            if (layout_.owns(c))
              factorise(c);
            else
              memory_.operators[c] = {};
        });
      }
    catch (...)
      {
        discard();
        throw;
      }
    memory_.worn_out              = false;
    memory_.iterations_per_decade = 0.;
    ++memory_.n_renewals;
  }


  void
  ImplicitShells::judge(const LinearReport &report)
  {
    if (!(report.final_residual < report.initial_residual) || !(report.final_residual > 0.))
      {
        memory_.worn_out = report.iterations > 0;
        return;
      }
    double      &best       = memory_.iterations_per_decade;
    const double per_decade = report.iterations / std::log10(report.initial_residual / report.final_residual);
    if (best > 0. && report.iterations * (1. - 1.1 * best / per_decade) > 1.)
      memory_.worn_out = true;
    // The least of all: a last solve that has little left to do may look dear.
    best = best > 0. ? std::min(best, per_decade) : per_decade;
  }


  void
  ImplicitShells::watch(const LinearReport &report)
  {
    judge(report);
    // Processors of different kinds may round differently, and a renewal needs all ranks.
    std::array<double, 2> decision = {{double(memory_.worn_out), memory_.iterations_per_decade}};
    MPI_Bcast(decision.data(), 2, MPI_DOUBLE, 0, layout_.communicator());
    memory_.worn_out              = decision[0] != 0.;
    memory_.iterations_per_decade = decision[1];
  }


  ControlPoints
  ImplicitShells::velocity(const unsigned int c, const ControlPoints &force) const
  {
    if (!factors_[c])
      return ControlPoints::Zero(force.rows(), 3);
    const Eigen::VectorXd solution = factors_[c]->solve(Eigen::Map<const Eigen::VectorXd>(force.data(), force.size()));
    return Eigen::Map<const ControlPoints>(solution.data(), force.rows(), 3);
  }


  ControlPoints
  ImplicitShells::damped(const unsigned int c, const ControlPoints &force) const
  {
    if (!factors_[c])
      return ControlPoints::Zero(force.rows(), 3);
    return memory_.operators[c].Z * velocity(c, force) * drift(c).transpose();
  }
} // namespace tanktread
