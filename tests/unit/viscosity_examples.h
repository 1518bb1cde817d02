// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: viscosities given by formulas, for tests.

#ifndef tanktread_tests_viscosity_examples_h
#define tanktread_tests_viscosity_examples_h

#include <tanktread/fluid/viscosity.h>

#include <cmath>
#include <functional>
#include <vector>

#include "full_arrays.h"

namespace tanktread
{
  using Field = std::function<double(const dealii::Point<3> &)>;

  /** Calls f(number of the cell on this rank, cell). */
  template <typename Function>
  void
  for_cells(const FluidMesh &mesh, const Function &f)
  {
    unsigned int number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        f(number++, cell);
  }


  inline Viscosity
  viscosity_from(const FluidMesh &mesh, const Field &mu, const double least)
  {
    std::vector<double> values;
    for_cells(mesh, [&](const unsigned int, const auto &cell) {
      for (unsigned int q = 0; q < 27; ++q)
        values.push_back(
          mu(cell->vertex(0) +
             mesh.cell_size(cell->level()) * dealii::Point<3>(gauss_abscissae()[q % 3], gauss_abscissae()[q / 3 % 3], gauss_abscissae()[q / 9])));
    });
    return {std::move(values), least};
  }


  inline Field
  sphere(const double ratio, const dealii::Point<3> &centre, const double radius = 1., const double side = 10.)
  {
    return [=](const dealii::Point<3> &x) {
      dealii::Tensor<1, 3> d = x - centre;
      for (unsigned int c = 0; c < 2; ++c)
        d[c] = std::remainder(d[c], side);
      return d.norm() < radius ? ratio : 1.;
    };
  }
} // namespace tanktread

#endif
