// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the shells contribute to the Newton system.

#ifndef tanktread_solver_linearised_shell_h
#define tanktread_solver_linearised_shell_h

#include <tanktread/coupling/coupling.h>
#include <tanktread/solver/distributed_shell.h>
#include <tanktread/solver/implicit_shells.h>
#include <tanktread/solver/shell_motion.h>
#include <tanktread/solver/state.h>

#include <optional>
#include <vector>

namespace tanktread
{
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

  /** Whether the Newton system knows how interpolation and spreading change with the position of the points; see LinearisedShell. */
  enum class PointDerivatives
  {
    complete,
    frozen
  };

  /** How a LinearisedShell is to be made. */
  struct Linearisation
  {
    double           tau         = 0.; // effective length of the time step; 0: the shells stay
    double           h           = 1.; // finest fluid cell
    double           accuracy    = 0.; // relative error that the map dw may have, see ShellMotion
    PointDerivatives derivatives = PointDerivatives::complete;
    Tangent          tangent     = Tangent::exact; // positive: without the negative stiffness of a shell under pressure from its sides, and without -pi H_V
    UndisturbedFlow  flow{};
    double           viscosity = 1.; // mean of inside and outside
  };

  /**
   * The rows of one shell in the Newton system about (x, F, u, pi, sigma) for a time step of effective length tau, v = dV/dx, H_V = d2V/dx2 (doc/theory.md,
   * section 6):
   *
   *     (M - tau Gamma - sigma H_V) dx = tau S^T W Phi du + dsigma v - M r_x,   v . dx = -r_V,   Gamma = S^T W grad u S
   *     dG + (K - pi H_V) dx = -r_F,                                            dG = dF + pi H_V dx: change of F + pi v at fixed pi
   *
   * The first line, dsigma eliminated, defines the linear map dx = tau dw(du) + dx0(r_x, r_V), so every iterate keeps the linearised volume.
   *
   * The second row is multiplied by Z_tau (Z_tau + tau (K - pi H_V))^{-1}, Z_tau = Z (1 - tau grad u_inf), where the sparse operator
   *
   *     Z = c0 M_s + c1 L_s,   c0 = 4 mu k1 k2/(k1 + k2),   c1 = 4 mu/(k1 + k2),   k1 = 2/a,   k2 = pi/h,
   *
   * (mass and Laplace-Beltrami matrices on the current surface, mu the mean of the viscosities inside and outside) stands for the inverse of the surface
   * mobility J A^{-1} J^T: c0 + c1 k^2 equals the symbol 4 mu k of
   * that inverse for a plane at both ends of the resolved wave numbers. Eliminating the fluid exactly would leave about
   * (1 + tau K (1 - tau grad u_inf)^{-1} J A^{-1} J^T) dG, so after the multiplication the row is close to dG = ... for any stiffness. ImplicitShells holds
   * this operator, which is that of an earlier linearisation where it has factors that still serve.
   *
   * With PointDerivatives::frozen the derivatives of J(x) and R(x) by x are left out, but for the undisturbed flow's: Gamma is that of grad u_inf and D_R = 0.
   * They are the
   * derivatives of piecewise polynomials at the quadrature points, true only while a point stays in its cell; for longer ways the incomplete system is the
   * better model of what
   * happens, and it is never indefinite because of them.
   *
   * H_V has eigenvalues up to about pi/h against M, so that the first matrix is indefinite for larger |sigma| than h/pi, without the whole system being: dx is
   * eliminated
   * before the stiffness of the shell can damp it. sigma H_V is therefore left out for |sigma| > h/(2 pi). That is long after what the volume needs in common
   * time steps, and costs
   * Newton's method the second order, not the convergence: the shell's stiffness keeps what is neglected small.
   *
   * tau = 0 freezes the shell: then dG = 0 and no derivative of the forces is needed.
   */
  class LinearisedShell
  {
  public:
    /**
     * @param shell at state.x. @param velocity of the control points, J u + u_inf(x). @param stiffness K there. @param gradient S^T W (grad u_inf - G + grad u) S, what
     * Gamma is beside its part G of the undisturbed flow at the middle of the shell (Coupling::gradient_matrices()), or empty: that is all. The latter two are not read
     * if tau = 0.
     *
     * Throws NumericalError when a matrix is singular.
     */
    LinearisedShell(const CapsuleState                              &state,
                    const std::shared_ptr<const ShellConfiguration> &shell,
                    const ControlPoints                             &velocity,
                    SparseMatrix                                     stiffness,
                    SparseMatrix                                     gradient,
                    const Linearisation                             &choice);

    /** dx for r_x = 0, r_V = 0 and given velocity moments S^T W Phi du; zero if tau = 0. */
    ControlPoints
    displacement(const ControlPoints &velocity_moments) const;

    /** dx for du = 0; zero if tau = 0. */
    ControlPoints
    displacement_of_residual(const ControlPoints &r_x, double r_V) const;

    /** Change of the rate of volume v . (J u + u_inf): m . (moments + Gamma dx) + (H_V (J u + u_inf)) . dx with m = M^{-1} v. */
    double
    flux(const ControlPoints &velocity_moments, const ControlPoints &dx) const;

    /** dsigma that belongs to dx: the part of the first row along m. */
    double
    volume_shift(const ControlPoints &velocity_moments, const ControlPoints &r_x, const ControlPoints &dx) const;

    /** (K - pi H_V) dx, zero if tau = 0. */
    ControlPoints
    stiffness_times(const ControlPoints &dx) const;

    /** dF = dG - pi H_V dx. */
    ControlPoints
    force_change(const ControlPoints &dG, const ControlPoints &dx) const;

    /** v = dV/dx. */
    const ControlPoints &
    volume_gradient() const
    {
      return shell_->volume_gradient();
    }
    /** m = M^{-1} v. */
    const ControlPoints &
    normal_field() const
    {
      return shell_->normal_field();
    }
    /** M g. */
    ControlPoints
    force(const ControlPoints &g) const
    {
      return capsule_.mass() * g;
    }
    /** M^{-1} f. */
    ControlPoints
    density(const ControlPoints &f) const
    {
      return capsule_.density(f);
    }
    /** g = M^{-1}(F + pi v), control points of the density whose motion D_R describes; zero with frozen points. */
    const ControlPoints &
    density() const
    {
      return density_;
    }
    /** The implicit operator for this linearisation. */
    ImplicitOperator
    implicit_operator(const Linearisation &choice) const
    {
      return implicit_operator(choice, stiffness_);
    }
    /** The same with another matrix in place of K - pi H_V. */
    ImplicitOperator
    implicit_operator(const Linearisation &choice, SparseMatrix stiffness) const;

  private:
    /** Adds the multiple of A^{-1} v to `dx` that makes v . dx = -r_V. */
    void
    correct_volume(ControlPoints &dx, double r_V) const;

    const Capsule                            &capsule_;
    std::shared_ptr<const ShellConfiguration> shell_;
    double                                    tau_, pressure_jump_;
    ControlPoints                             density_;
    ControlPoints                             flux_gradient_;   // derivative of that rate by x: Gamma^T m + H_V (J u + u_inf)
    ControlPoints                             volume_response_; // A^{-1} v
    SparseMatrix                              stiffness_;       // K - pi H_V
    std::optional<ShellMotion>                motion_;          // A = M - tau Gamma - sigma H_V or without the last; none if tau = 0
  };


  /** The rows of the rank's own shells, with the operators that the force rows are multiplied by. */
  class LinearisedShells
  {
  public:
    /**
     * @param shells at the state's positions. @param velocities of the control points, J u + u_inf(x). @param implicit_shells are renewed unless they serve for
     * tau, with the positive tangent where the exact one makes them indefinite; kept by reference, and not to be changed as long as this object is in use, as `coupling`.
     *
     * Collective. Throws NumericalError on all ranks when one of the matrices is singular.
     */
    LinearisedShells(const DistributedShell    &elasticity,
                     const Coupling            &coupling,
                     const State               &state,
                     const ShellConfigurations &shells,
                     const ShellFields         &velocities,
                     const Linearisation       &choice,
                     ImplicitShells            &implicit_shells);

    const LinearisedShell &
    operator[](const unsigned int c) const
    {
      return shells_[c];
    }
    unsigned int
    size() const
    {
      return shells_.size();
    }

    /** dx of all shells for given velocity moments. */
    ShellFields
    displacements(const ShellFields &velocity_moments) const;

    /** ImplicitShells::damped(), on the leader of the team only; the force itself if tau = 0. Collective in the team. */
    ControlPoints
    damped(unsigned int c, const ControlPoints &force) const;

    /** density() of all shells. */
    ShellFields
    densities() const;

    /** Whether the system knows what the motion of the spreading points does; otherwise densities are zero. */
    bool
    points_move() const
    {
      return points_move_;
    }
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

  private:
    const Coupling              &coupling_;
    const ImplicitShells        &implicit_shells_;
    double                       tau_;
    bool                         points_move_;
    std::vector<LinearisedShell> shells_;
  };
} // namespace tanktread

#endif
