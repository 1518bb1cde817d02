// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid beyond the box.

#ifndef tanktread_solver_unbounded_liquid_h
#define tanktread_solver_unbounded_liquid_h

#include <tanktread/coupling/shell_layout.h>
#include <tanktread/fluid/prescribed_velocity.h>
#include <tanktread/shell/shell_configuration.h>
#include <tanktread/solver/state.h>

namespace tanktread
{
  /**
   * Velocities on the faces of a box in unbounded liquid: the disturbance that the shells make there (doc/theory.md, section 3.4),
   *
   *     u(x) = 1/(8 pi) sum_I [1/|y| + y y^T/|y|^3] (F + pi v)_I + (1 - lambda)/(8 pi) sum_I 6 y (y . U_I)(y . v_I)/|y|^5,   y = x - x_I,
   *
   * the sums over the control points of all shells, v = dV/dx the area vectors that belong to them, lambda the viscosity inside and U the whole velocity of a shell
   * less its rigid part, which contributes nothing. Total force, moments x F^T of the forces and v U^T of the velocities are those of the surfaces exactly; what is
   * left of second moments on falls faster with the distance and with the square of the control points' distances.
   *
   * With another viscosity inside, a stresslet in the middle of each shell is added that makes their sum the one of the discrete equations, -sym(sum_j x_j l_j)
   * without its trace, l the loads that would make the same flow with viscosity 1 everywhere, over the nodes near and inside the shell. The integral of U n is
   * multiplied by the viscosity, and with it its error. Of several shells each has the nodes that are nearest to its control points; what the sum and the moment of their loads differ from
   * the force and the torque of its points, where two shells are near each other, is a Stokeslet and a rotlet there.
   */
  class UnboundedLiquid
  {
  public:
    /** Shells may not come nearer to a face, in a: the cells there could not follow the flow between. */
    static constexpr double least_distance = 0.5;

    /** Keeps `space` and `layout` by reference. Throws what PrescribedVelocity throws. @param viscosity_ratio inside over outside. Collective. */
    UnboundedLiquid(const TaylorHoodSpace &space, const ShellLayout &layout, double viscosity_ratio);

    /** To be called when the viscosity has changed; kept by reference. Collective. */
    void
    set_viscosity(const Viscosity &viscosity);

    /**
     * Makes the velocities on the faces those of `state`. @param shells at its positions. @param velocities U, read with another viscosity inside only.
     * Collective.
     */
    void
    set(const State &state, const ShellConfigurations &shells, const ShellFields &velocities);

    const PrescribedVelocity &
    faces() const
    {
      return faces_;
    }

  private:
    /** A capsule from far away. */
    struct Multipoles
    {
      Eigen::RowVector3d centre    = Eigen::RowVector3d::Zero();
      Eigen::RowVector3d force     = Eigen::RowVector3d::Zero();
      Eigen::RowVector3d torque    = Eigen::RowVector3d::Zero(); // about the centre
      Eigen::Matrix3d    stresslet = Eigen::Matrix3d::Zero();    // symmetric, without trace
    };

    /** Fields of the capsules of a team, all that the faces have to know: x and force, with another viscosity inside U and v too. Collective. */
    std::vector<std::vector<ControlPoints>>
    fields_of_team(unsigned int team, const State &state, const ShellConfigurations &shells, const ShellFields &velocities) const;

    /** The flow of all capsules, those of one team after the other: each rank has faces of its own. Returns what their points are from far away. Collective. */
    std::vector<Multipoles>
    add_all_points(const State &state, const ShellConfigurations &shells, const ShellFields &velocities, Columns &on_faces);

    Eigen::RowVector3d
    place_of_near(std::size_t i) const;

    /** The shell of each near node, where it can be that of one shell alone; the others become `between_shells_`. Collective. */
    void
    find_candidates(const ShellConfigurations &shells);

    /** Adds what makes `of_points` those of the discrete equations with the flow `fields`. Collective. */
    void
    add_missing(const FluidBlockVector &fields, const std::vector<Multipoles> &of_points, Columns &on_faces);

    const TaylorHoodSpace    &space_;
    const ShellLayout        &layout_;
    const double              viscosity_ratio_;
    PrescribedVelocity        faces_;
    const StokesOperator      uniform_; // viscosity 1 everywhere
    std::vector<unsigned int> near_;    // owned nodes of the cells with another viscosity in them
    Columns                   near_places_;
    std::vector<unsigned int> shells_of_near_; // numbers

    /** A near node and the square of its distance from the nearest control point so far. */
    struct Between
    {
      std::size_t near;
      double      square;
    };
    std::vector<Between> between_shells_;
    FluidBlockVector     loads_;
  };
} // namespace tanktread

#endif
