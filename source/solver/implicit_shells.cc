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


  ImplicitShells::ImplicitShells(const ShellLayout &layout, SolverMemory &memory)
    : layout_(layout)
    , memory_(memory)
  {
    int n_ranks, rank;
    MPI_Comm_size(layout.team(), &n_ranks);
    MPI_Comm_rank(layout.team(), &rank);
    for (unsigned int k = 0; k < layout.capsules().n_kinds(); ++k)
      {
        const Capsule &kind = layout.capsules().kind(k);
        hierarchies_.push_back(std::make_shared<LoopHierarchy>(kind.topology(), kind.surface().pattern(), n_ranks, rank));
      }
    reassign();
  }


  void
  ImplicitShells::reassign()
  {
    multigrids_.clear();
    factors_.clear();
    for (const unsigned int c : layout_.own())
      {
        const auto &hierarchy = hierarchies_[layout_.capsules().kind_of(c)];
        multigrids_.push_back(hierarchy->ends_coarse() ? std::make_unique<ShellMultigrid>(hierarchy, layout_.team()) : nullptr);
        factors_.push_back(layout_.leads() ? std::make_unique<BlockFactorisation>() : nullptr);
      }
    has_factors_.assign(layout_.n_own(), 1);
    some_has_factors_ = true;
    discard();
  }


  bool
  ImplicitShells::serves(const double tau) const
  {
    return some_has_factors_ && memory_.tau > 0. && !memory_.worn_out && tau <= 1.5 * memory_.tau && memory_.tau <= 1.5 * tau;
  }


  void
  ImplicitShells::renew(Operators operators, const double tau, const std::function<Operators()> &definite)
  {
    memory_.operators  = std::move(operators);
    memory_.tau        = tau;
    char is_indefinite = 0, has_some = 0;
    std::fill(has_factors_.begin(), has_factors_.end(), 0);
    try
      {
        for (unsigned int i = 0; i < layout_.n_own(); ++i)
          {
            if (multigrids_[i])
              multigrids_[i]->set_up(memory_.operators[i].S);
            const bool is_good = multigrids_[i] && multigrids_[i]->convergence_factor() < largest_convergence_factor;
            has_factors_[i]    = !is_good;
            if (multigrids_[i] && !is_good)
              is_indefinite = 1;
          }
        MPI_Allreduce(MPI_IN_PLACE, &is_indefinite, 1, MPI_CHAR, MPI_MAX, layout_.communicator());
        if (is_indefinite && definite)
          return renew(definite(), tau);
        if (!layout_.is_team_of_one())
          MPI_Bcast(has_factors_.data(), int(has_factors_.size()), MPI_CHAR, 0, layout_.team());
        for (const char has : has_factors_)
          has_some = std::max(has_some, has);
        MPI_Allreduce(MPI_IN_PLACE, &has_some, 1, MPI_CHAR, MPI_MAX, layout_.communicator());
        some_has_factors_ = has_some != 0;
        on_all_ranks(layout_.communicator(), [&] {
          for (unsigned int i = 0; i < layout_.n_own(); ++i)
            if (has_factors_[i] && layout_.leads())
              factors_[i]->factorise(memory_.operators[i].S, "The shell's implicit operator, for this time step,");
            else
              memory_.operators[i].S = {};
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
  ImplicitShells::velocity(const unsigned int i, const ControlPoints &force) const
  {
    ControlPoints result;
    if (!has_factors_[i])
      result = multigrids_[i]->solve(force);
    if (!layout_.leads())
      return ControlPoints::Zero(force.rows(), 3);
    if (has_factors_[i])
      {
        const Eigen::VectorXd solution = factors_[i]->solve(Eigen::Map<const Eigen::VectorXd>(force.data(), force.size()));
        result                         = Eigen::Map<const ControlPoints>(solution.data(), force.rows(), 3);
      }
    return result;
  }


  ControlPoints
  ImplicitShells::damped(const unsigned int i, const ControlPoints &force) const
  {
    const ControlPoints undamped = velocity(i, force);
    return layout_.leads() ? ControlPoints(memory_.operators[i].Z * undamped * memory_.operators[i].drift.transpose()) : undamped;
  }
} // namespace tanktread
