// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the strain form adds to the Laplace form in the cells that the shell cuts.

#ifndef tanktread_coupling_transposed_part_h
#define tanktread_coupling_transposed_part_h

#include <tanktread/base/vector4.h>
#include <tanktread/fluid/cut_cell.h>

namespace tanktread
{
  /**
   * ((mu - m) grad u^T, grad v) in a cut cell with the functions psi_v of JumpEnrichment, m the smaller of the viscosities 1 outside and `ratio` inside: an
   * integral over one side only. In units of the cell's edge but for
   * the amplitudes.
   */
  struct TransposedPart
  {
    /**
     * @param inside products over the part of the cell inside the shell. @param node_inside sides of the nodes. @param amplitudes q_a for unit values at the
     * vertices.
     */
    TransposedPart(const GradientProducts                      &inside,
                   const std::array<bool, 27>                  &node_inside,
                   const std::array<std::array<double, 8>, 27> &amplitudes,
                   double                                       ratio);

    /** loads -= h times the form of psi with the functions N_b. @param f f_t at the vertices. */
    void
    add_loads(double h, const std::array<Vector4, 8> &f, std::array<Vector4, 27> &loads) const;

    /** The transpose. @param u velocities of the nodes. */
    void
    add_response(double h, const std::array<Vector4, 27> &u, std::array<Vector4, 8> &r) const;

    /** r -= h times the form of psi with the functions psi_v. */
    void
    add_self_response(double h, const std::array<Vector4, 8> &f, std::array<Vector4, 8> &r) const;

    // For unit values along d at a vertex the form with functions along c: [b or v][d][c][vertex].
    using Rows = std::array<std::array<std::array<float, 8>, 3>, 3>;
    std::array<Rows, 27> nodes;
    std::array<Rows, 8>  self;
  };
} // namespace tanktread

#endif
