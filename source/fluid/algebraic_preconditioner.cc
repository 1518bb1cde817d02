// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: block preconditioner of the assembled Stokes equations with algebraic multigrid.

#include <tanktread/fluid/algebraic_preconditioner.h>

namespace tanktread
{
  AlgebraicPreconditioner::AlgebraicPreconditioner(const AssembledStokes &stokes)
    : stokes_(stokes)
    , velocity_scratch_(stokes.velocity().partitioner())
  {
    dealii::TrilinosWrappers::PreconditionAMG::AdditionalData amg;
    amg.elliptic              = true;
    amg.higher_order_elements = true;
    amg.n_cycles              = 1;
    amg.smoother_sweeps       = 1;
    amg.aggregation_threshold = 0.02;
    multigrid_.initialize(stokes.laplace(), amg);

    // On cubes the diagonally scaled trilinear mass matrix has its eigenvalues in [1/8, 27/8]; hanging nodes change little.
    Chebyshev::AdditionalData data;
    data.preconditioner = std::make_shared<Diagonal>();
    auto &inverse       = data.preconditioner->get_vector();
    inverse.reinit(stokes.pressure().partitioner());
    for (const auto i : inverse.locally_owned_elements())
      inverse(i) = 1. / stokes.pressure_mass().diag_element(i);
    data.degree              = 5;
    data.smoothing_range     = 20.;
    data.eig_cg_n_iterations = 10;
    pressure_mass_inverse_.initialize(stokes.pressure_mass(), data);
  }


  void
  AlgebraicPreconditioner::apply_inverse_laplace(FluidVector &dst, const FluidVector &src) const
  {
    multigrid_.vmult(dst, src);
  }


  void
  AlgebraicPreconditioner::vmult(ComponentVector &dst, const ComponentVector &src) const
  {
    pressure_mass_inverse_.vmult(dst.block(3), src.block(3));
    dst.block(3) *= -1.;
    for (unsigned int c = 0; c < 3; ++c)
      dst.block(c) = src.block(c);
    stokes_.add_pressure_gradient(dst, dst.block(3));
    for (unsigned int c = 0; c < 3; ++c)
      {
        velocity_scratch_ = dst.block(c);
        apply_inverse_laplace(dst.block(c), velocity_scratch_);
      }
  }
} // namespace tanktread
