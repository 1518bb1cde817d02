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
  namespace
  {
    /** A V-cycle that leaves more than this of an error is no match for factors. */
    constexpr double largest_convergence_factor = 0.7;
  } // namespace


  ImplicitOperator
  implicit_operator(SparseMatrix Z, SparseMatrix K_pi, const Eigen::Matrix3d &flow_gradient, const double tau)
  {
    ImplicitOperator result{std::move(Z), std::move(K_pi), Eigen::Matrix3d::Identity() - tau * flow_gradient};
    result.S.coeffs() *= tau;
    add_for_three_components(result.Z, result.S, result.drift);
    return result;
  }


  ImplicitShells::ImplicitShells(const Capsule &capsule, const ShellLayout &layout, SolverMemory &memory)
    : layout_(layout)
    , memory_(memory)
    , multigrids_(layout.n_capsules())
    , factors_(layout.n_capsules())
    , has_factors_(layout.n_capsules(), true)
  {
    int n_ranks, rank;
    MPI_Comm_size(layout.team(), &n_ranks);
    MPI_Comm_rank(layout.team(), &rank);
    const auto hierarchy = std::make_shared<LoopHierarchy>(capsule.topology(), capsule.surface().pattern(), n_ranks, rank);
    for (unsigned int c = 0; c < layout.n_capsules(); ++c)
      {
        if (layout.works_on(c) && hierarchy->ends_coarse())
          multigrids_[c] = std::make_unique<ShellMultigrid>(hierarchy, layout.team());
        if (layout.owns(c))
          factors_[c] = std::make_unique<BlockFactorisation>();
      }
  }


  bool
  ImplicitShells::serves(const double tau) const
  {
    const bool is_dear = std::any_of(has_factors_.begin(), has_factors_.end(), [](const bool has) { return has; });
    return is_dear && memory_.tau > 0. && !memory_.worn_out && tau <= 1.5 * memory_.tau && memory_.tau <= 1.5 * tau;
  }


  void
  ImplicitShells::renew(Operators operators, const double tau, const std::function<Operators()> &definite)
  {
    memory_.operators  = std::move(operators);
    memory_.tau        = tau;
    char is_indefinite = 0;
    std::fill(has_factors_.begin(), has_factors_.end(), 0);
    try
      {
        for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
          if (layout_.works_on(c))
            {
              if (multigrids_[c])
                multigrids_[c]->set_up(memory_.operators[c].S);
              const bool is_good = multigrids_[c] && multigrids_[c]->convergence_factor() < largest_convergence_factor;
              has_factors_[c]    = layout_.owns(c) && !is_good;
              if (multigrids_[c] && !is_good)
                is_indefinite = 1;
            }
        MPI_Allreduce(MPI_IN_PLACE, &is_indefinite, 1, MPI_CHAR, MPI_MAX, layout_.communicator());
        if (is_indefinite && definite)
          return renew(definite(), tau);
        MPI_Allreduce(MPI_IN_PLACE, has_factors_.data(), int(has_factors_.size()), MPI_CHAR, MPI_MAX, layout_.communicator());
        on_all_ranks(layout_.communicator(), [&] {
          for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
            if (has_factors_[c] && layout_.owns(c))
              factors_[c]->factorise(memory_.operators[c].S, "The shell's implicit operator, for this time step,");
            else
              memory_.operators[c].S = {};
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
    ControlPoints result;
    if (!has_factors_[c] && layout_.works_on(c))
      result = multigrids_[c]->solve(force);
    if (!layout_.owns(c))
      return ControlPoints::Zero(force.rows(), 3);
    if (has_factors_[c])
      {
        const Eigen::VectorXd solution = factors_[c]->solve(Eigen::Map<const Eigen::VectorXd>(force.data(), force.size()));
        result                         = Eigen::Map<const ControlPoints>(solution.data(), force.rows(), 3);
      }
    return result;
  }


  ControlPoints
  ImplicitShells::damped(const unsigned int c, const ControlPoints &force) const
  {
    const ControlPoints undamped = velocity(c, force);
    return layout_.owns(c) ? ControlPoints(memory_.operators[c].Z * undamped * memory_.operators[c].drift.transpose()) : undamped;
  }
} // namespace tanktread
