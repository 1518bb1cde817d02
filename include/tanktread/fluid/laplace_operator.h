// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vector Laplace operator on one rung.

#ifndef tanktread_fluid_laplace_operator_h
#define tanktread_fluid_laplace_operator_h

#include <tanktread/fluid/cube_kernel.h>
#include <tanktread/fluid/node_space.h>

namespace tanktread
{
  /**
   * (grad u, grad v) + shift (u, v), shift = 0 at first, for each velocity component on the free nodes, on full arrays (see NodeSpace). `space` is kept by reference. Its nodes may be
   * those of linear functions too, then the shift has to stay zero.
   */
  template <typename Number>
  class LaplaceOperator
  {
  public:
    explicit LaplaceOperator(const NodeSpace &space);

    /** y = A u for owned nodes; updates the rest of u, and what y has beyond its owned nodes is void. Collective. */
    void
    apply(Number *u, Number *y) const;

    /** Inertia puts `shift` times the mass matrix to the operator. */
    void
    set_shift(const double shift)
    {
      shift_ = shift;
    }

    /** Diagonal of A, one number an owned node, hanging nodes included exactly. */
    std::vector<Number>
    diagonal() const;

    const NodeSpace &
    space() const
    {
      return space_;
    }

  private:
    const NodeSpace     &space_;
    const InstructionSet instructions_;
    double               shift_ = 0.;
  };
} // namespace tanktread

#endif
