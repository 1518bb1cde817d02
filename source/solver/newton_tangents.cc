// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: which tangent of the shells Newton's method takes, and what it does after a failure.

#include <tanktread/base/exceptions.h>
#include <tanktread/solver/newton_solver.h>

namespace tanktread
{
  void
  NewtonSolver::use(const Tangent tangent)
  {
    memory_.tangent = tangent;
    implicit_shells_.discard();
  }


  void
  NewtonSolver::react(const std::string &failure, const bool renewed, const double residual, Progress &progress)
  {
    if (!renewed)
      implicit_shells_.discard(); // perhaps they were too old: the same iteration again, with new ones
    else if (memory_.tangent == Tangent::exact)
      {
        use(Tangent::positive);
        progress.failed_at = residual;
      }
    else if (residual < 0.9 * progress.failed_at)
      use(Tangent::exact); // it failed farther from the solution
    else
      throw NumericalError(failure);
    progress.cautious = memory_.tangent == Tangent::positive;
  }


  bool
  NewtonSolver::exact_may_serve(const Progress &progress, const NewtonReport &report) const
  {
    if (progress.length >= 0.25 * level_.finest_cell())
      return false;
    if (!progress.cautious)
      return true;
    // After a failure not before the solution is much nearer, or is nearer and the positive tangent brings it hardly any nearer.
    const std::vector<double> &r    = report.residuals;
    const bool                 slow = r.size() > 2 && r.back() > 0.5 * r[r.size() - 2];
    return r.back() < (slow ? 0.5 : 0.1) * progress.failed_at;
  }
} // namespace tanktread
