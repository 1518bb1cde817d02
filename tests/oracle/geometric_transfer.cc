// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation between two meshes by deal.II, what the own one is compared with.

#include <deal.II/multigrid/mg_transfer_global_coarsening.h>

#include "geometric_transfer.h"

namespace tanktread::oracle
{
  FluidVector
  prolongated(const ScalarSpace &coarse, const ScalarSpace &fine, const FluidVector &u)
  {
    dealii::MGTwoLevelTransfer<3, FluidVector> transfer;
    transfer.reinit_geometric_transfer(fine.dofs(), coarse.dofs(), fine.constraints(), coarse.constraints());
    FluidVector source(coarse.partitioner()), result(fine.partitioner());
    source.copy_locally_owned_data_from(u);
    transfer.prolongate_and_add(result, source);
    fine.constraints().distribute(result);
    return result;
  }
} // namespace tanktread::oracle
