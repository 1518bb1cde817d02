// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kink of the velocity and the jump of the pressure at shells that are far from each other, in the cells that they cut.

#ifndef tanktread_coupling_jump_enrichment_h
#define tanktread_coupling_jump_enrichment_h

#include <tanktread/coupling/cut_cell_forms.h>
#include <tanktread/coupling/mean_gradient.h>
#include <tanktread/coupling/surface_distance.h>
#include <tanktread/coupling/transposed_part.h>
#include <tanktread/coupling/vertex_averages.h>
#include <tanktread/coupling/vertex_sides.h>
#include <tanktread/fluid/undisturbed_flow.h>

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace tanktread
{
  /** Another viscosity inside, and the undisturbed flow that it disturbs. */
  struct ViscosityContrast
  {
    double          ratio = 1.; // inside over outside
    UndisturbedFlow flow{};
  };

  /**
   * Forces f per area on the shell bend the velocity, mu [du/dn] = -f_t, and break the pressure, [p] = f_n (outside minus inside), inside cells that finite
   * elements cannot follow. So velocity and
   * pressure are sought as u_h + psi, p_h + eta with
   *
   *     psi = sum_a q_a N_a (chi - i_a),   q_a = phi(x_a) f_t(x_a)/mu,      eta = sum_j eta_j M_j (chi - i_j),   eta_j = -f_n(x_j)
   *
   * on the cells that the shell cuts, zero elsewhere: chi is one inside, i_a = chi(x_a), phi the signed distance. These are functions with those jumps minus
   * their nodal interpolants, so they
   * vanish on all faces that the shell does not cut. f at a node is the average of VertexAverages. With the linear maps
   * f -> psi, eta the stationary value of 1/2 a(u, u) - (p, div u) - <f, u> gives both directions at once:
   *
   *     load        R f = (<f, v> - a(psi, v) + (eta, div v),  (q, div psi))
   *     velocity    U   = R^T (u_h, p_h) + Q f,      <g, Q f> = <g, psi_f> + <f, psi_g> - a(psi_f, psi_g) + (eta_f, div psi_g) + (eta_g, div psi_f)
   *
   * This class adds what is more than <f, v> and its transpose, for one shell and its own forces, or for several at once that are so far from each other that
   * they share no vertex of a cell near them, nor a master of one (ShellJumps says which); what the forces of one shell do in cells that another one cuts is in
   * ShellPairs.
   *
   * Viscosity mu = 1 outside and lambda inside: the conditions at the shell are then
   *
   *     [du/dn] = -2/(1 + lambda) (f_t + g_t),   [p] = f_n + g_n,   g = (1 - lambda) (G + G^T) n
   *
   * with G the mean of the velocity gradients on both sides, the undisturbed flow's included. So f + g takes the place of f in psi (with mu the mean of the
   * viscosities) and eta, g being that of the flow before: a
   * fixed point. It is no force and no unknown: what it contributes is constant in the directions R f and Q f, like the load -2 ((mu - 1) eps(u_inf), eps(v))
   * of the undisturbed flow.
   */
  class JumpEnrichment
  {
  public:
    /**
     * Keeps `space` by reference. @param vertices linear nodes with four components on its mesh, numbered as the pressure's. @param locator of the mesh's
     * cells.
     */
    JumpEnrichment(const TaylorHoodSpace             &space,
                   std::shared_ptr<const NodeSpace>   vertices,
                   std::shared_ptr<const CellLocator> locator,
                   const ViscosityContrast           &contrast);

    /**
     * Computes everything that depends on where the shells are, but for the viscous forces.
     *
     * @param shells those near this rank's cells, in the order of their points. @param points of all shells, kept by reference. Collective. Throws
     * NumericalError if a shell is so near to a periodic image of itself that a node of the mesh is near to both, std::logic_error if a vertex is near to two
     * shells.
     */
    void
    move(std::vector<LocatedShell> shells, const PointInterpolation &points);

    /** Adds g to forces at the vertices; with one viscosity nothing. */
    void
    complete(VertexArray &forces) const;

    /**
     * Makes g that of the flow with these gradients.
     *
     * @param gradients of u_inf + u_h at the points of all shells on this rank, 9 numbers each, entry 3 c + d being du_c/dx_d. @param laplacians of the same, 3
     * numbers each. @param forces whole ones at the
     * vertices. @param tractions memory, 3 numbers a point of all shells. Collective.
     */
    void
    update_viscous_forces(const std::vector<double> &gradients,
                          const std::vector<double> &laplacians,
                          const VertexArray         &forces,
                          std::vector<double>       &tractions);

    /** That map, which is linear, without what the jump of the second derivatives adds. */
    void
    viscous_forces(const std::vector<double> &gradients, const VertexArray &forces, std::vector<double> &tractions, VertexArray &g) const;

    /** g at a free vertex of this rank, which belongs to the shell of that number. */
    struct ViscousForce
    {
      unsigned int          node, shell;
      std::array<double, 4> value;
    };

    /** Appends g where it is not zero; to be called after update_viscous_forces(), before the shells move. */
    void
    append_viscous_forces(std::vector<ViscousForce> &forces) const;

    /** Makes them g, all the rest zero. Collective. */
    void
    set_viscous_forces(const std::vector<ViscousForce> &forces);

    /** 2 ((mu - 1) eps(u_inf), eps(psi)) in the cells of this rank. */
    double
    undisturbed_work(const VertexArray &forces) const;

    /** Adds factor (R f without <f, v>). @param load_u velocity block with its ghosts. @param load_p full array. */
    void
    add_load(const VertexArray &forces, double factor, double *load_u, double *load_p) const;

    /** dual += what R^T without the values of u_h makes of a flow at the vertices. @param u velocity block with its ghosts. @param p full array. */
    void
    add_field_response(const double *u, const double *p, VertexArray &dual) const;

    /**
     * dual, values += Q of the shells' own forces.
     *
     * @param at_points force times area at the points of all shells, as `values`. @param whole with what does not depend on the forces, see complete().
     */
    void
    add_self_response(const std::vector<double> &at_points, const VertexArray &forces, bool whole, VertexArray &dual, std::vector<double> &values) const;

    const VertexAverages &
    averages() const
    {
      return averages_;
    }
    /** The pressure's vertices near the shells. */
    const std::vector<NearVertex> &
    near_vertices() const
    {
      return near_vertices_;
    }

    /** See tanktread::carry_pressure(). Collective. */
    void
    carry_pressure(const VertexArray &forces, const VertexSides &before, FluidBlockVector &fields) const;

    /** A cell that one of the shells cuts. */
    struct CutCell
    {
      unsigned int                        cell, group; // the latter: its points, or VertexAverages::no_points
      NodeDistances                       nodes;
      CutCellForms                        forms;
      std::array<std::array<float, 4>, 8> stress; // undisturbed_stress(), zero with one viscosity
    };
    const std::vector<CutCell> &
    cut_cells() const
    {
      return cut_cells_;
    }
    /** How often the shells cut cells of this rank that are not finest ones, in which kink and jump are missing. */
    unsigned int
    n_coarse_cut_cells() const
    {
      return n_coarse_cut_cells_;
    }

  private:
    /** What is known of a node near a shell. */
    struct NearNode
    {
      double       phi;
      Lattice      image; // its place on the lattice of the finest cells' nodes, by which phi is known
      unsigned int shell; // number
    };
    using NearNodes = std::unordered_map<unsigned int, NearNode>;

    /** Nodes for which what one cell says does not agree with another one. */
    struct Conflicts
    {
      unsigned int images = 0, shells = 0;
    };

    void
    find_cut_cells(const SurfaceDistance &distance, unsigned int shell, NearNodes &known, Conflicts &conflicts);
    NodeDistances
    node_distances(const SurfaceDistance &distance, unsigned int shell, const Lattice &position, unsigned int cell, NearNodes &known, Conflicts &conflicts)
      const;
    /** Collective. */
    void
    refuse(const Conflicts &conflicts) const;
    void
    add_cut_cell(unsigned int cell, const dealii::Point<3> &centre, const NodeDistances &nodes);
    /** psi at the points of a cut cell. */
    void
    set_point_values(const CutCell &cut, const NodeAmplitudes &q);
    /** At all points, with two viscosities. */
    void
    set_mean_gradients(const PointInterpolation &points);

    /** g from the mean gradients, mean(G, i, r, F) being that at the place i, of the point r. */
    template <typename Mean>
    void
    extend_viscous_forces(const std::vector<double> &gradients, const VertexArray &forces, const Mean &mean, std::vector<double> &tractions, VertexArray &g)
      const;

    const TaylorHoodSpace             &space_;
    const ViscosityContrast            contrast_;
    std::shared_ptr<const CellLocator> locator_;
    VertexAverages                     averages_;
    std::vector<CutCell>               cut_cells_;
    std::vector<TransposedPart>        transposed_;   // of each cut cell; none with one viscosity
    std::vector<NearCell>              nearby_cells_; // whose nodes' distances are known
    unsigned int                       n_coarse_cut_cells_ = 0;
    std::vector<NearVertex>            near_vertices_;
    std::vector<std::array<double, 8>> psi_;            // psi_v at the points, in the order of the averages
    std::vector<MeanGradient>          mean_gradients_; // in that order; none with one viscosity
    VertexArray                        viscous_forces_; // g_t and g_n; empty with one viscosity
  };
} // namespace tanktread

#endif
