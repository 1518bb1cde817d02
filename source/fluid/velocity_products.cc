// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: products of velocities over the box, which carry momentum.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/velocity_products.h>

#include <cmath>

namespace tanktread
{
  namespace
  {
    /** Mass matrix of the quadratic functions on the unit interval, nodes 0, 1/2, 1. */
    constexpr double mass[3][3] = {{4. / 30., 2. / 30., -1. / 30.}, {2. / 30., 16. / 30., 2. / 30.}, {-1. / 30., 2. / 30., 4. / 30.}};

    double
    mass_of(const unsigned int a, const unsigned int b)
    {
      return mass[a % 3][b % 3] * mass[a / 3 % 3][b / 3 % 3] * mass[a / 9][b / 9];
    }
  } // namespace


  dealii::SymmetricTensor<2, 3>
  integral_of_products(const TaylorHoodSpace &space, const FluidVector &u)
  {
    const NodeSpace              &node = *space.velocity;
    dealii::AlignedVector<double> values(node.full_size());
    node.load(u, values.data());
    node.update(values.data());
    dealii::SymmetricTensor<2, 3> sum;
    for (unsigned int cell = 0; cell < node.n_cells(); ++cell)
      {
        const unsigned int           *nodes  = node.cell_nodes(cell);
        const double                  volume = std::pow(node.cell_sizes()[cell], 3);
        dealii::SymmetricTensor<2, 3> of_cell;
        for (unsigned int a = 0; a < 27; ++a)
          for (unsigned int b = 0; b < 27; ++b)
            {
              const double  m = mass_of(a, b);
              const double *v = values.data() + std::size_t(node.stride()) * nodes[a], *w = values.data() + std::size_t(node.stride()) * nodes[b];
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = i; j < 3; ++j)
                  of_cell[i][j] += m * v[i] * w[j]; // over all a and b it is symmetric
            }
        sum += volume * of_cell;
      }
    return dealii::Utilities::MPI::sum(sum, u.get_mpi_communicator());
  }
} // namespace tanktread
