// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vector Laplace operator on one rung.

#include <tanktread/fluid/laplace_operator.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace tanktread
{
  namespace
  {
    std::vector<double>
    unit_cube_matrix()
    {
      const double                 size = 1.;
      std::array<unsigned int, 27> nodes;
      std::iota(nodes.begin(), nodes.end(), 0);
      const Cubes         cube{1, &size, nodes.data(), nullptr};
      std::vector<double> result(27 * 27);
      for (unsigned int b = 0; b < 27; ++b)
        {
          std::array<double, 108> u = {}, y = {};
          u[4 * b] = 1.;
          add_laplace(InstructionSet::baseline, cube, u.data(), y.data());
          for (unsigned int a = 0; a < 27; ++a)
            result[27 * a + b] = y[4 * a];
        }
      return result;
    }
  } // namespace


  template <typename Number>
  LaplaceOperator<Number>::LaplaceOperator(const NodeSpace &space)
    : space_(space)
    , instructions_(best_instruction_set())
  {}


  template <typename Number>
  void
  LaplaceOperator<Number>::set_viscosity(const std::vector<double> &viscosities)
  {
    own_factors_ = viscosities;
    for (std::size_t i = 0; i < own_factors_.size(); ++i)
      own_factors_[i] *= space_.cell_sizes()[i];
  }


  template <typename Number>
  void
  LaplaceOperator<Number>::apply(Number *const u, Number *const y) const
  {
    space_.update(u);
    std::fill(y, y + space_.full_size(), Number(0));
    add_laplace(instructions_, {space_.n_cells(), factors().data(), space_.cell_nodes(0), nullptr}, u, y);
    space_.collect(y);
  }


  template <typename Number>
  std::vector<Number>
  LaplaceOperator<Number>::diagonal() const
  {
    const std::vector<double> result = space_.diagonal(unit_cube_matrix(), factors());
    return {result.begin(), result.end()};
  }


  template class LaplaceOperator<float>;
  template class LaplaceOperator<double>;
} // namespace tanktread
