// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Solver" of the parameter file.

#ifndef tanktread_solver_solver_parameters_h
#define tanktread_solver_solver_parameters_h

#include <tanktread/coupling/interface.h>
#include <tanktread/fluid/stokes_method.h>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** How the shell follows the fluid. */
  enum class TimeCoupling
  {
    implicit_newton, // all unknowns together at the new time level
    explicit_euler   // the shell moves with the velocity of the old time level; for comparison only
  };

  struct SolverParameters
  {
    TimeCoupling coupling              = TimeCoupling::implicit_newton;
    Interface    interface             = Interface::enriched;
    StokesMethod method                = StokesMethod::matrix_free;
    double       newton_tolerance      = 1e-4;
    double       volume_tolerance      = 1e-7;
    double       linear_tolerance      = 0.1;
    unsigned int max_newton_iterations = 12;
    unsigned int max_linear_iterations = 200;

    /** Declares section "Solver" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace tanktread

#endif
