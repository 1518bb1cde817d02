// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the factorised implicit operators of the shells, kept from one linearisation to the next.

#ifndef tanktread_solver_implicit_shells_h
#define tanktread_solver_implicit_shells_h

#include <tanktread/coupling/shell_layout.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/solver/block_factorisation.h>
#include <tanktread/solver/shell_multigrid.h>
#include <tanktread/solver/solver_memory.h>

#include <functional>
#include <memory>
#include <vector>

namespace tanktread
{
  /** Of a linearisation with Z, K_pi and grad u_inf for a step of length tau. */
  ImplicitOperator
  implicit_operator(SparseMatrix Z, SparseMatrix K_pi, const Eigen::Matrix3d &flow_gradient, double tau);

  /**
   * For each capsule the map Z_tau S^{-1}, S = Z_tau + tau K_pi, Z_tau = Z (1 - tau grad u_inf), by which LinearisedShells multiplies the force row of the Newton
   * system: Z, tau and
   * K_pi = K - pi H_V of some linearisation.
   *
   * Any regular matrix would leave the solution of the system unchanged; this one makes it fast. S^{-1} is one V-cycle of ShellMultigrid where that converges,
   * on the ranks of the capsule's team, and made anew for each linearisation. Where S is indefinite, so that velocity() would measure residuals with an operator
   * that may shorten or stretch them without bound, the positive tangent takes the place of K_pi in it. Where no V-cycle converges even so, and on control meshes
   * that no
   * subdivision has made, it is LU factors, on the rank that owns the capsule: as they are dear, those of an earlier shape serve as long as the solver is
   * fast with them, which linear solves are watched for. All capsules' operators are renewed together.
   */
  class ImplicitShells
  {
  public:
    /** All are kept by reference. */
    ImplicitShells(const ShellLayout &layout, SolverMemory &memory);

    /** To be called when ShellLayout::assign() has given capsules to other teams: forgets the operators. */
    void
    reassign();

    /**
     * Whether there are operators that are worth keeping for a step of length tau: one of them has factors; made for one that differs by a factor of 1.5 at
     * most; and not worn out.
     */
    bool
    serves(double tau) const;

    using Operators = std::vector<ImplicitOperator>;

    /**
     * Replaces the operators, one for each of the rank's own capsules; by those that `definite` makes, if it is given, where a
     * V-cycle shows that one of them is indefinite.
     * Collective; throws NumericalError on all ranks when one is singular.
     */
    void
    renew(Operators operators, double tau, const std::function<Operators()> &definite = {});

    /**
     * To be told about every linear solve with these operators. They are worn out when one takes more than 1.1 times the iterations that a decade took in the
     * best solve so far, and 1 more: an
     * iteration costs several factorisations where the fluid has many unknowns a rank. The first rank decides for all. Collective.
     */
    void
    watch(const LinearReport &report);

    /** Forgets the operators. */
    void
    discard()
    {
      memory_.tau = 0.;
    }

    /** How often they were renewed. */
    unsigned int
    n_renewals() const
    {
      return memory_.n_renewals;
    }

    /** Z_tau S^{-1} force of own capsule i on the team's leader, zero on the others. Collective in the team. */
    ControlPoints
    damped(unsigned int i, const ControlPoints &force) const;

    /** S^{-1} force of own capsule i on the team's leader, zero on the others: about how fast the shell moves to balance a force that is missing. Collective in the team. */
    ControlPoints
    velocity(unsigned int i, const ControlPoints &force) const;

  private:
    void
    judge(const LinearReport &report);

    const ShellLayout                                &layout_;
    SolverMemory                                     &memory_;
    std::vector<std::shared_ptr<const LoopHierarchy>> hierarchies_; // of the kinds of capsules
    // Of the rank's own capsules.
    std::vector<std::unique_ptr<ShellMultigrid>>     multigrids_;              // if there are coarser control meshes
    std::vector<std::unique_ptr<BlockFactorisation>> factors_;                 // on the team's leader
    std::vector<char>                                has_factors_;             // and it uses them, as the team knows
    bool                                             some_has_factors_ = true; // of all capsules
  };
} // namespace tanktread

#endif
