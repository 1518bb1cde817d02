// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the forces of one shell do to another one inside the cells that both are in.

#ifndef tanktread_coupling_shell_pairs_h
#define tanktread_coupling_shell_pairs_h

#include <tanktread/coupling/jump_enrichment.h>

#include <vector>

namespace tanktread
{
  /**
   * The flow is u_h + sum_c psi_c, p_h + sum_c eta_c with the jumps of all shells c. Where cells that one shell cuts hold points of another one, or are cut by
   * it too, the velocity that the forces of d make at c has the further part
   *
   *     <g, Q_cd f> = <g, psi_d f> + <f, psi_c g> - a(psi_c g, psi_d f) + (eta_d f, div psi_c g) + (eta_c g, div psi_d f),   Q_dc = Q_cd^T.
   *
   * Shells do not overlap, chi_c chi_d = 0, so products of their jumps are (chi_c - i_c,a)(chi_d - i_d,b) = i_c,a i_d,b - i_d,b chi_c - i_c,a chi_d: integrals
   * over the insides are enough. With another viscosity inside, 1 + (lambda - 1)(chi_c + chi_d), what the inside of d changes in the shared cells in psi_c's own forms and load, and grad psi_d in
   * the mean gradient at c, are left out: errors there are of first order.
   */
  class ShellPairs
  {
  public:
    /**
     * Finds the cells; to be called when all shells have moved. `space` and `colours` are kept by reference. Shells of one colour do not meet: what are shells
     * c, d above are colours here.
     */
    void
    reinit(const TaylorHoodSpace &space, const std::vector<JumpEnrichment> &colours, double viscosity_ratio);

    /**
     * duals, values += Q_cd f_d for all pairs, in the arrays of JumpEnrichment::add_self_response(), one for each colour but `values` and `at_points`, which
     * hold the points of all shells.
     */
    void
    add_response(const std::vector<double>      &at_points,
                 const std::vector<VertexArray> &forces,
                 std::vector<VertexArray>       &duals,
                 std::vector<double>            &values) const;

    /** Cells of this rank in which two shells or more meet, each counted once. */
    unsigned int
    n_cells() const;

  private:
    /** Points of the colour `other` in a cell that a shell of the colour `own` cuts, and psi_v of the latter there. */
    struct SharedPoints
    {
      unsigned int                       own, other, cell, group; // the latter in the averages of `other`
      std::vector<std::array<double, 8>> psi;
    };

    /** A cell that both cut. Forms for an edge of one, as in CutCellForms. */
    struct SharedCell
    {
      unsigned int                                       first, second, cell;
      std::array<std::array<double, 8>, 8>               laplace;            // [v][w]: a(psi_first,v, psi_second,w)
      std::array<std::array<std::array<float, 4>, 8>, 8> mixed_first_second; // [v][j]: (eta_second,j, grad psi_first,v)
      std::array<std::array<std::array<float, 4>, 8>, 8> mixed_second_first; // [v][j]: (eta_first,j, grad psi_second,v)
    };

    void
    add_points(unsigned int own, unsigned int other, unsigned int group, const JumpEnrichment::CutCell &cut);
    void
    add_cell(unsigned int first, unsigned int second, const JumpEnrichment::CutCell &cut_first, const JumpEnrichment::CutCell &cut_second);

    const TaylorHoodSpace             *space_           = nullptr;
    const std::vector<JumpEnrichment> *colours_         = nullptr;
    double                             viscosity_ratio_ = 1.;
    std::vector<SharedPoints>          points_;
    std::vector<SharedCell>            cells_;
  };
} // namespace tanktread

#endif
