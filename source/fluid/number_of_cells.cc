// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many cells the fluid's mesh may have.

#include <deal.II/base/types.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/number_of_cells.h>

#include <limits>
#include <string>

namespace tanktread
{
  void
  check_number_of_cells(const std::uint64_t n_cells)
  {
    constexpr std::uint64_t most = std::numeric_limits<dealii::types::global_dof_index>::max() / 27;
    if (n_cells > most)
      throw InputError("The fluid mesh has " + std::to_string(n_cells) + " cells; allowed: at most " + std::to_string(most) +
                       ", whose nodes deal.II's integers can count (Fluid mesh/Finest cell, Fluid mesh/Band width, a smaller box).");
  }
} // namespace tanktread
