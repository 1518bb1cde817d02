// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the factorised implicit operator of the shell, kept from one linearisation to the next.

#ifndef tanktread_solver_implicit_shell_h
#define tanktread_solver_implicit_shell_h

#include <tanktread/fluid/linear_solver.h>
#include <tanktread/solver/block_factorisation.h>
#include <tanktread/surface/assembly_pattern.h>

#include <mpi.h>

namespace tanktread
{
  /**
   * The map Z_tau (Z_tau + tau K_pi)^{-1}, Z_tau = Z (1 - tau grad u_inf), by which LinearisedShell multiplies the force row of the Newton system: Z, tau and
   * K_pi = K - pi H_V of some linearisation.
   *
   * Any regular matrix would leave the solution of the system unchanged; this one makes it fast. So one made for an earlier shape serves as long as it makes it fast
   * enough, which linear solves are watched for.
   *
   * Factors are on the first rank, the owner of the force row, only.
   */
  class ImplicitShell
  {
  public:
    explicit ImplicitShell(MPI_Comm communicator);

    /** Whether there is an operator that is expected to do well with a step of length tau: made for one that differs by a factor of 1.5 at most, and not worn out. */
    bool
    serves(double tau) const;

    /** Replaces the operator. `Z` is NP x NP, `flow_gradient` that of u_inf, `K_pi` 3 NP x 3 NP. Collective; throws NumericalError on all ranks when Z_tau + tau K_pi is singular. */
    void
    renew(const SparseMatrix &Z, const Eigen::Matrix3d &flow_gradient, const SparseMatrix &K_pi, double tau);

    /**
     * To be told about every linear solve with this operator. It is worn out when one takes more than 1.1 times the iterations that a decade took in the best solve so far, and 1 more: an
     * iteration costs several factorisations where the fluid has many unknowns a rank.
     */
    void
    watch(const LinearReport &report);

    /** Forgets the operator. */
    void
    discard()
    {
      tau_ = 0.;
    }

    /** How often the operator was renewed. */
    unsigned int
    n_renewals() const
    {
      return n_renewals_;
    }

    /** Z_tau (Z_tau + tau K_pi)^{-1} force on the first rank, zero on the others. */
    ControlPoints
    damped(const ControlPoints &force) const;

    /** (Z_tau + tau K_pi)^{-1} force on the first rank, zero on the others: about how fast the shell moves to balance a force that is missing. */
    ControlPoints
    velocity(const ControlPoints &force) const;

  private:
    MPI_Comm           communicator_;
    bool               first_rank_;
    double             tau_                   = 0.; // 0: there is no operator
    bool               worn_out_              = false;
    double             iterations_per_decade_ = 0.; // of the best linear solve; 0: there was none
    unsigned int       n_renewals_            = 0;
    SparseMatrix       Z_;
    Eigen::Matrix3d    drift_; // 1 - tau grad u_inf
    BlockFactorisation factors_;
  };
} // namespace tanktread

#endif
