// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shell contributes to the Newton system.

#ifndef tanktread_solver_linearised_shell_h
#define tanktread_solver_linearised_shell_h

#include <Eigen/SparseLU>
#include <tanktread/coupling/coupling.h>
#include <tanktread/shell/shell.h>

namespace tanktread
{
  using Factorisation = Eigen::SparseLU<Eigen::SparseMatrix<double, Eigen::ColMajor, int>, Eigen::COLAMDOrdering<int>>;

  /** Flattened view of nodal fields, index 3 I + c. */
  inline Eigen::Map<const Eigen::VectorXd>
  flat(const ControlPoints &field)
  {
    return {field.data(), field.size()};
  }

  /** Inverse of flat(). */
  inline ControlPoints
  nodal(const Eigen::VectorXd &vector)
  {
    return Eigen::Map<const ControlPoints>(vector.data(), vector.size() / 3, 3);
  }

  /** Matrix (x) 3 x 3 identity, entries at 3 I + c, 3 J + c. */
  SparseMatrix
  for_three_components(const SparseMatrix &matrix);

  /** Nodal forces, volume and (if asked for) their derivatives at one position of the shell. */
  struct ShellForces
  {
    ControlPoints force;           // f = -dE/dx
    ControlPoints volume_gradient; // v = dV/dx
    double        volume = 0.;     // V

    ShellForces(const Shell &shell, const SubdivisionSurface &surface, const ControlPoints &x);
  };

  /**
   * The shell's rows of the Newton system about (x, u, pi) for a time step of effective length tau:
   *
   *     dx = tau dw - (M - tau Gamma)^{-1} M r_x,   dw = (M - tau Gamma)^{-1} S^T W Phi du,   Gamma = S^T W grad u S
   *     dF = -(K - pi H_V) dx,                       H_V = d2V/dx2
   *
   * tau = 0 freezes the shell: then dw = J du and no derivative of the forces is needed.
   */
  class LinearisedShell
  {
  public:
    LinearisedShell(const Shell              &shell,
                    const SubdivisionSurface &surface,
                    const Coupling           &coupling,
                    const ControlPoints      &x,
                    const ShellForces        &forces,
                    const PointVelocity      &velocity,
                    double                    pressure_jump,
                    double                    tau);

    /** (M - tau Gamma)^{-1} moments. */
    ControlPoints
    velocity_response(const ControlPoints &moments) const;

    /** dx for du = 0: -(M - tau Gamma)^{-1} M r_x. */
    ControlPoints
    displacement_of_residual(const ControlPoints &r_x) const;

    /** (K - pi H_V) dx, zero if tau = 0. */
    ControlPoints
    stiffness_times(const ControlPoints &dx) const;

    double
    tau() const
    {
      return tau_;
    }
    const Coupling &
    coupling() const
    {
      return coupling_;
    }
    /** K - pi H_V, empty if tau = 0. */
    const SparseMatrix &
    stiffness() const
    {
      return stiffness_;
    }
    /** v = dV/dx. */
    const ControlPoints &
    volume_gradient() const
    {
      return volume_gradient_;
    }
    /** g = M^{-1}(f + pi v), control points of the density that is being spread. */
    const ControlPoints &
    density() const
    {
      return density_;
    }

  private:
    const Coupling &coupling_;
    double          tau_;
    ControlPoints   volume_gradient_, density_;
    SparseMatrix    stiffness_;
    Factorisation   response_;
  };
} // namespace tanktread

#endif
