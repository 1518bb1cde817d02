// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Solver" of the parameter file.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/solver/solver_parameters.h>

namespace tanktread
{
  void
  SolverParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Solver");
    add_enum_parameter(
      prm,
      "Coupling",
      coupling,
      {{"implicit", TimeCoupling::implicit_newton}, {"explicit", TimeCoupling::explicit_euler}},
      "implicit: all unknowns together by Newton's method; explicit: the shell moves with the old velocity, for comparison only, small steps.");
    add_enum_parameter(
      prm,
      "Interface",
      interface,
      {{"plain", Interface::plain}, {"enriched", Interface::enriched}},
      "plain: finite-element consistent spreading and interpolation, first order in the cell size; enriched: with the kink of the velocity and the jump of the pressure "
      "at the shell in the cells that it cuts, second order.");
    add_enum_parameter(
      prm,
      "Method",
      method,
      {{"matrix-free", StokesMethod::matrix_free}, {"assembled", StokesMethod::assembled}},
      "How the linear solver treats the liquid. matrix-free: operators computed cell by cell, geometric multigrid. assembled: sparse matrices and algebraic multigrid "
      "(Trilinos ML), the common way, for comparison: the same flow in more time and memory; only with 'Viscosity ratio' 1 and 'Reynolds number' 0.");
    prm.add_parameter("Newton tolerance",
                      newton_tolerance,
                      "Norm of the residual at which a time step is solved, as a velocity of the shell in a per unit of time.",
                      Double(1e-13, 1e-2));
    prm.add_parameter("Volume tolerance", volume_tolerance, "Relative volume error at which a time step is solved.", Double(1e-14, 1e-3));
    prm.add_parameter("Linear tolerance",
                      linear_tolerance,
                      "Largest relative residual at which the linear solver of a Newton iteration stops; it stops later where Newton's method gains by it.",
                      Double(1e-13, 0.5));
    prm.add_parameter("Maximal Newton iterations",
                      max_newton_iterations,
                      "A time step that needs more is rejected and tried with half its length.",
                      Integer(1, 1000));
    prm.add_parameter("Maximal linear iterations",
                      max_linear_iterations,
                      "A linear solve that needs more, times the root of the viscosity ratio or of its inverse, has failed.",
                      Integer(1, 100000));
    prm.leave_subsection();
  }
} // namespace tanktread
