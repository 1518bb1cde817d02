// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the solver carries from one step to the next beside the State.

#ifndef tanktread_solver_solver_memory_h
#define tanktread_solver_solver_memory_h

#include <tanktread/shell/shell_configuration.h>

#include <vector>

namespace tanktread
{
  /** One capsule's implicit operator S = Z_tau + tau K_pi, Z_tau = Z D, and the drift D = 1 - tau grad u_inf. */
  struct ImplicitOperator
  {
    SparseMatrix    Z; // NP x NP
    SparseMatrix    S; // 3 NP x 3 NP; empty where a V-cycle has taken what it needs of it
    Eigen::Matrix3d drift = Eigen::Matrix3d::Identity();
  };

  /**
   * What the result of a step depends on, within the solver's tolerances, beside the State, the positions and flows of earlier time levels, and the fluid's
   * mesh: with these a step is determined. Where the coupling's points are and
   * the viscous part g of the jumps belong to it too; Coupling holds them.
   */
  struct SolverMemory
  {
    Tangent     tangent = Tangent::exact; // to start a step with
    ShellFields viscosity_x;              // where the shells were when the viscosity was set; empty: nowhere on this mesh

    // The implicit operators of the shells.
    double                        tau                   = 0.;    // length of the step that they were made for; 0: there are none
    bool                          worn_out              = false; // to be renewed
    double                        iterations_per_decade = 0.;    // of the best linear solve with them; 0: there was none
    unsigned int                  n_renewals            = 0;
    std::vector<ImplicitOperator> operators; // of each capsule, on the ranks that work on it
  };
} // namespace tanktread

#endif
