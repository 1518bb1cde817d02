// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kink of the velocity and the jump of the pressure at the shell, in the cells that it cuts.

#ifndef tanktread_coupling_jump_enrichment_h
#define tanktread_coupling_jump_enrichment_h

#include <tanktread/base/vector4.h>
#include <tanktread/coupling/surface_distance.h>
#include <tanktread/coupling/transposed_part.h>
#include <tanktread/fluid/cut_cell.h>
#include <tanktread/fluid/point_interpolation.h>

namespace tanktread
{
  /** On which side of the shell the pressure's owned unknowns lie: -1 inside, 1 outside, 0 where that is not known, farther from the shell than a cell. Empty: nowhere. */
  using VertexSides = std::vector<signed char>;

  /** Forces of the shell as the enrichment needs them. */
  struct ExtendedForces
  {
    std::vector<double>           at_points;     // force times area at the local points, 3 numbers each
    dealii::AlignedVector<double> at_vertices;   // f_t and f_n at the vertices of this rank's cells
    bool                          whole = false; // with all that does not depend on the forces, see JumpEnrichment::complete()
  };

  /** Another viscosity inside, and the undisturbed flow that it disturbs. */
  struct ViscosityContrast
  {
    double          ratio         = 1.; // inside over outside
    Eigen::Matrix3d flow_gradient = Eigen::Matrix3d::Zero();
  };

  /**
   * Forces f per area on the shell bend the velocity, mu [du/dn] = -f_t, and break the pressure, [p] = f_n (outside minus inside), inside cells that finite elements cannot follow. So velocity and
   * pressure are sought as u_h + psi, p_h + eta with
   *
   *     psi = sum_a q_a N_a (chi - i_a),   q_a = phi(x_a) f_t(x_a)/mu,      eta = sum_j eta_j M_j (chi - i_j),   eta_j = -f_n(x_j)
   *
   * on the cells that the shell cuts, zero elsewhere: chi is one inside, i_a = chi(x_a), phi the signed distance. These are functions with those jumps minus their nodal interpolants, so they
   * vanish on all faces that the shell does not cut. f at a node is the average, weighted by the mesh's linear hat functions, of the forces at the surface's points. With the linear maps
   * f -> psi, eta the stationary value of 1/2 a(u, u) - (p, div u) - <f, u> gives both directions at once:
   *
   *     load        R f = (<f, v> - a(psi, v) + (eta, div v),  (q, div psi))
   *     velocity    U   = R^T (u_h, p_h) + Q f,      <g, Q f> = <g, psi_f> + <f, psi_g> - a(psi_f, psi_g) + (eta_f, div psi_g) + (eta_g, div psi_f)
   *
   * so the power f . U is what the flow u_h + psi dissipates, exactly. This class adds what is more than <f, v> and its transpose. A constant pressure is removed from p_h and from the load, of which it would know
   * by errors of the quadrature only.
   *
   * Viscosity mu = 1 outside and lambda inside: the conditions at the shell are then
   *
     *     [du/dn] = -2/(1 + lambda) (f_t + g_t),   [p] = f_n + g_n,   g = (1 - lambda) (G + G^T) n
   *
   * with G the mean of the velocity gradients on both sides, the undisturbed flow's included. So f + g takes the place of f in psi (with mu the mean of the viscosities) and eta, g being that of the flow before: a
   * fixed point. It is no force and no unknown: what it contributes is constant in the directions R f and Q f, like the load -2 ((mu - 1) eps(u_inf), eps(v)) of the undisturbed flow.
   */
  class JumpEnrichment
  {
  public:
    /** Keeps `space` by reference. Collective. */
    explicit JumpEnrichment(const TaylorHoodSpace &space, const ViscosityContrast &contrast = {});

    /**
     * Computes everything that depends on where the shell is.
     *
     * @param patches about the points that `points` has been given, which is kept by reference. @param area_weights area that each stands for. Collective.
     */
    void
    move(std::vector<QuadraticPatch> patches, const Eigen::VectorXd &area_weights, const PointInterpolation &points);

    /** Makes forces.at_vertices from forces.at_points, in the order of `points`. Collective. */
    void
    extend(ExtendedForces &forces) const;

    /** Adds g and marks the forces as whole, the undisturbed flow included; with one viscosity nothing. */
    void
    complete(ExtendedForces &forces) const;

    /**
     * Makes g that of the flow with these gradients.
     *
     * @param gradients of u_inf + u_h at the local points, 9 numbers each, entry 3 c + d being du_c/dx_d. @param forces whole ones. Collective.
     */
    void
    update_viscous_forces(const double *gradients, const ExtendedForces &forces);

    /** 2 ((mu - 1) eps(u_inf), eps(psi)). Collective. */
    double
    undisturbed_work(const ExtendedForces &forces) const;

    /** load += factor R f without <f, v>. Collective. */
    void
    add_load(const ExtendedForces &forces, double factor, FluidBlockVector &load) const;

    /** values += (R^T fields without the values of u_h) + Q forces at the local points, the latter unless null. Collective. */
    void
    add_velocities(const FluidBlockVector &fields, const ExtendedForces *forces, std::vector<double> &values) const;

    /** Sides since move(). */
    const VertexSides &
    sides() const
    {
      return sides_;
    }

    /**
     * Adds to p_h at the vertices that have changed sides since `sides` what the pressure jumps there, (i_new - i_old) eta_j: the nodal values of p_h are those of the pressure, which a vertex that
     * the shell has passed finds on the other side. Afterwards `sides` is sides(). Collective.
     */
    void
    carry_pressure(const ExtendedForces &forces, VertexSides &sides, FluidBlockVector &fields) const;

    unsigned int
    n_cut_cells() const
    {
      return cut_cells_.size();
    }

  private:
    /** f_t and, in the fourth place, f_n at the vertices of a cell; or what is dual to them. */
    using VertexForces = std::array<Vector4, 8>;

    /** Everything linear in the forces at the vertices, for a cell of any size: q_a = phi(x_a) sum_v M_v(x_a) f_t,v has been put in. Vectors have four places, the last one zero. */
    struct CutCell
    {
      unsigned int                                        cell, group; // the latter: its points, or no_points
      std::array<std::array<float, 8>, 27>                laplace;     // [b][v]: a(N_b, psi_v), the same for all components
      std::array<std::array<std::array<float, 4>, 8>, 27> pressure;    // [b][j]: (eta_j, grad N_b)
      std::array<std::array<std::array<float, 4>, 8>, 8>  divergence;  // [j][v]: (M_j, grad psi_v)
      std::array<std::array<float, 8>, 8>                 self;        // [v][w]: a(psi_v, psi_w)
      std::array<std::array<std::array<float, 4>, 8>, 8>  self_mixed;  // [v][j]: (eta_j, grad psi_v)
      std::array<std::array<float, 4>, 8>                 stress;      // [v]: 2 ((mu - 1) eps(u_inf), eps(psi_v))
    };
    static constexpr unsigned int no_points = static_cast<unsigned int>(-1);

    /** Local points of one cell: point_order_[begin], ..., point_order_[end - 1]. */
    struct PointGroup
    {
      unsigned int cell, begin, end;
    };

    /** Signs and distances of a cut cell's nodes, in a. */
    struct NodeDistances
    {
      std::array<double, 27> phi;
      std::array<bool, 27>   inside;
    };

    void
    group_points();
    void
    find_cut_cells(const SurfaceDistance &distance);
    void
    set_sides(const std::vector<double> &phi);
    void
    add_cut_cell(unsigned int cell, const NodeDistances &nodes);
    /** What another viscosity inside needs in addition. @param q amplitudes at the nodes for unit values at the vertices. */
    void
    add_viscous_part(CutCell                                     &cut,
                     const NodeDistances                         &nodes,
                     const PartialCellMatrices                   &in,
                     const GradientProducts                      &products,
                     const std::array<std::array<double, 8>, 27> &q);
    void
    set_weights(const Eigen::VectorXd &area_weights);

    /** Of `values`, an array of extension_. */
    VertexForces
    vertex_values(const dealii::AlignedVector<double> &values, unsigned int cell) const;
    void
    add_vertex_values(unsigned int cell, const VertexForces &values) const;
    /** Sums over cells and ranks become averages with the weights, known at all vertices of this rank's cells. */
    void
    average() const;
    void
    add_self_response(const CutCell &cut, const VertexForces &f, const ExtendedForces &forces, VertexForces &r, std::vector<double> &values) const;
    void
    add_field_response(const CutCell &cut, const double *u, const double *p, VertexForces &r) const;
    /** Pressure of `fields` without its mean. */
    void
    load_pressure(const FluidBlockVector &fields) const;

    const TaylorHoodSpace                &space_;
    const ViscosityContrast               contrast_;
    CellLocator                           locator_;
    NodeSpace                             extension_;          // linear functions with four numbers a vertex
    std::vector<double>                   pressure_integrals_; // of the pressure functions, owned ones
    const PointInterpolation             *points_ = nullptr;
    std::vector<CutCell>                  cut_cells_;
    std::vector<TransposedPart>           transposed_;   // of each cut cell; none with one viscosity
    std::vector<unsigned int>             nearby_cells_; // whose nodes' distances are known
    VertexSides                           sides_;
    std::vector<PointGroup>               groups_; // by cell, ascending
    std::vector<unsigned int>             group_of_cell_;
    std::vector<unsigned int>             point_order_;
    std::vector<std::array<double, 8>>    hats_, psi_;     // of points, in that order: M_v, and psi_v on the shell (in cut cells)
    std::vector<Vector4>                  normals_;        // in that order
    std::vector<std::array<Vector4, 8>>   slopes_;         // of points, in that order: mean of grad psi_v on both sides, in cut cells; none with one viscosity
    std::vector<double>                   areas_;          // of points, in that order; none with one viscosity
    dealii::AlignedVector<double>         viscous_values_; // g_t and g_n at the vertices
    std::vector<double>                   inverse_weights_;
    mutable dealii::AlignedVector<double> extension_values_, pressure_values_;
  };
} // namespace tanktread

#endif
