// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: exact statements about the numbering of nodes and the interpolation from rung to rung.

#include <gtest/gtest.h>
#include <oracle/geometric_transfer.h>
#include <tanktread/fluid/assembled_stokes.h>
#include <tanktread/fluid/laplace_operator.h>
#include <tanktread/fluid/level_transfer.h>

#include <iostream>
#include <random>
#include <stdexcept>

#include "full_arrays.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  void
  expect_collect_is_transpose_of_update(const NodeSpace &space)
  {
    std::mt19937                           random(11 + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Array<double>                          u(space.full_size()), w(space.full_size()), owned_w;
    for (auto *array : {&u, &w})
      for (double &x : *array)
        x = uniform(random);
    space.update(u.data());
    std::vector<double> sums(2, 0.);
    for (std::size_t i = 0; i < u.size(); ++i)
      {
        sums[0] += u[i] * w[i];
        sums[1] += std::abs(u[i] * w[i]);
      }
    space.collect(w.data());
    dealii::Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
    EXPECT_NEAR(product(space, u, w), sums[0], 1e-14 * sums[1]);
  }

  /** Sets f at owned nodes, updates and returns the largest error at all nodes of all cells. */
  template <typename Function>
  double
  largest_error_of_interpolant(const FluidMesh &mesh, const NodeSpace &space, const Function &f)
  {
    const auto         positions = oracle::node_positions(mesh, space);
    const unsigned int n = space.nodes_per_cell() == 27 ? 3 : 2, stride = space.stride();
    Array<double>      u(space.full_size());
    for (unsigned int i = 0; i < space.n_owned(); ++i)
      u[stride * i + stride / 2] = f(positions[i]);
    space.update(u.data());
    double       result      = 0.;
    unsigned int cell_number = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int *const nodes = space.cell_nodes(cell_number);
          EXPECT_DOUBLE_EQ(space.cell_sizes()[cell_number++], mesh.cell_size(cell->level()));
          for (unsigned int a = 0; a < space.nodes_per_cell(); ++a)
            {
              const Point x = cell->vertex(0) + mesh.cell_size(cell->level()) / (n - 1) * Point(a % n, a / n % n, a / (n * n));
              result        = std::max(result, std::abs(u[stride * nodes[a] + stride / 2] - f(x)));
            }
        }
    EXPECT_EQ(cell_number, space.n_cells());
    return dealii::Utilities::MPI::max(result, MPI_COMM_WORLD);
  }
} // namespace


TEST(NodeSpace, CollectIsTheTransposeOfUpdate)
{
  for (const Scene &scene : scenes())
    {
      FluidMesh mesh(MPI_COMM_WORLD, scene.box, cells(scene.coarsest, scene.finest));
      mesh.adapt(scene.band);
      const TaylorHoodSpace space(mesh);
      expect_collect_is_transpose_of_update(*space.velocity);
      expect_collect_is_transpose_of_update(*space.pressure);
      expect_collect_is_transpose_of_update(NodeSpace(ScalarSpace(mesh, 1, false), 4));
    }
}


TEST(NodeSpace, FieldsAreContinuousAndZeroOnPrescribedFaces)
{
  for (const Scene &scene : scenes())
    {
      FluidMesh mesh(MPI_COMM_WORLD, scene.box, cells(scene.coarsest, scene.finest));
      mesh.adapt(scene.band);
      const TaylorHoodSpace space(mesh);
      // Functions of the spaces, quadratic or linear along the axes that are not periodic.
      const auto quadratic = [&](const Point &x) {
        double result = 1.;
        for (unsigned int d = 0; d < 3; ++d)
          if (!scene.box.is_periodic(d))
            result *= 1. - std::pow(2. * x[d] / scene.box.side[d], 2);
        return result;
      };
      const auto linear = [&](const Point &x) {
        double result = 1.;
        for (unsigned int d = 0; d < 3; ++d)
          if (!scene.box.is_periodic(d))
            result += (d + 1.) * x[d];
        return result;
      };
      EXPECT_LT(largest_error_of_interpolant(mesh, *space.velocity, quadratic), 1e-14);
      EXPECT_LT(largest_error_of_interpolant(mesh, *space.pressure, linear), 1e-13);
      EXPECT_EQ(largest_error_of_interpolant(mesh, *space.pressure, [](const Point &) { return 1.; }), 0.);
    }
}


TEST(NodeSpace, LoadAndStoreAreInverseToEachOther)
{
  FluidMesh mesh(MPI_COMM_WORLD, 10., cells(2.5, 1.25));
  mesh.adapt(scenes()[1].band);
  const ScalarSpace linear(mesh, 1, false);
  for (const unsigned int n_components : {1, 3, 4})
    {
      const NodeSpace nodes(linear, n_components);
      FluidVector     vector(nodes.partitioner()), back(vector);
      for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
        vector.local_element(i) = 1. + i;
      Array<double> values(nodes.full_size());
      values.fill(std::nan(""));
      nodes.load(vector, values.data());
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        for (unsigned int c = 0; c < nodes.stride(); ++c)
          ASSERT_EQ(values[nodes.stride() * i + c], c < n_components ? 1. + n_components * i + c : 0.);
      nodes.store(values.data(), back, false);
      back -= vector;
      EXPECT_EQ(back.linfty_norm(), 0.);
      nodes.store(values.data(), back, true);
      nodes.store(values.data(), back, true);
      back.add(-2., vector);
      EXPECT_EQ(back.linfty_norm(), 0.);
    }
  for (const unsigned int n_components : {0, 2, 5})
    EXPECT_THROW(NodeSpace(linear, n_components), std::logic_error);
}


TEST(NodeSpace, DiagonalIsThatOfTheAssembledMatrix)
{
  const ReferenceMatrices   reference;
  const std::vector<double> laplace = oracle::lexicographic(reference.laplace, 2, 2), mass = oracle::lexicographic(reference.pressure_mass, 1, 1);
  const auto                expect_equal = [](const std::vector<double> &found, const ScalarSpace &space, const NodeSpace &nodes, const auto &matrix) {
    const auto dofs = dofs_of_nodes(space, nodes);
    ASSERT_EQ(found.size(), dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i)
      {
        const double expected = matrix.diag_element(space.partitioner()->local_to_global(dofs[i]));
        EXPECT_NEAR(found[i], expected, 1e-13 * expected);
      }
  };
  for (const Scene &scene : scenes())
    {
      FluidMesh mesh(MPI_COMM_WORLD, scene.box, cells(scene.coarsest, scene.finest));
      mesh.adapt(scene.band);
      const TaylorHoodSpace space(mesh);
      const AssembledStokes assembled(space);
      expect_equal(space.velocity->diagonal(laplace, 1), assembled.velocity(), *space.velocity, assembled.laplace());
      expect_equal(LaplaceOperator<double>(*space.velocity).diagonal(), assembled.velocity(), *space.velocity, assembled.laplace());
      expect_equal(space.pressure->diagonal(mass, 3), assembled.pressure(), *space.pressure, assembled.pressure_mass());
    }
}


namespace
{
  /** Differences between what two rungs say, relative to the numbers themselves. */
  struct TransferErrors
  {
    double energy = 0., transpose = 0., oracle = 0.;
  };

  /** Largest difference between P u and what deal.II makes of it, for each component. `coarse_mesh` is `mesh` one rung before. */
  double
  difference_to_oracle(const FluidMesh     &coarse_mesh,
                       const FluidMesh     &mesh,
                       const NodeSpace     &coarse,
                       const NodeSpace     &fine,
                       const Array<double> &u,
                       const Array<double> &Pu)
  {
    const ScalarSpace from(coarse_mesh, 2, true), to(mesh, 2, true);
    const auto        from_dofs = dofs_of_nodes(from, coarse), to_dofs = dofs_of_nodes(to, fine);
    double            result = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      {
        FluidVector vector(from.partitioner());
        for (unsigned int i = 0; i < from_dofs.size(); ++i)
          vector.local_element(from_dofs[i]) = u[4 * i + c];
        const FluidVector expected = oracle::prolongated(from, to, vector);
        for (unsigned int i = 0; i < to_dofs.size(); ++i)
          result = std::max(result, std::abs(expected.local_element(to_dofs[i]) - Pu[4 * i + c]));
      }
    return dealii::Utilities::MPI::max(result, MPI_COMM_WORLD);
  }

  TransferErrors
  transfer_errors(const Scene &scene)
  {
    TransferErrors            errors;
    const FluidMeshParameters parameters = cells(scene.coarsest, scene.finest);
    FluidMesh                 mesh(MPI_COMM_WORLD, scene.box, parameters), coarse_mesh(MPI_COMM_WORLD, scene.box, parameters);
    mesh.aim_at(scene.band);
    coarse_mesh.aim_at(scene.band);
    auto coarse = std::make_unique<NodeSpace>(ScalarSpace(mesh, 2, true), 3);
    for (bool first = true; !mesh.on_last_rung(); first = false)
      {
        if (!first)
          coarse_mesh.climb();
        std::unique_ptr<NodeSpace>    fine;
        const auto                    rows = climb_with_interpolation(mesh, *coarse, [&]() -> const NodeSpace                    &{
          fine = std::make_unique<NodeSpace>(ScalarSpace(mesh, 2, true), 3);
          return *fine;
        });
        const LevelTransfer<double>   transfer(rows, *coarse, *fine);
        const LaplaceOperator<double> A(*coarse), A_fine(*fine);

        Array<double> u = rough_array<double>(mesh, *coarse, 1), Au(u.size()), Pu(fine->full_size()), APu(Pu.size()), RAPu(u.size());
        transfer.prolongate(u.data(), Pu.data());
        A.apply(u.data(), Au.data());
        A_fine.apply(Pu.data(), APu.data());
        const double energy = product(*coarse, u, Au);
        errors.energy       = std::max(errors.energy, std::abs(product(*fine, Pu, APu) / energy - 1.));

        const Array<double> w = rough_array<double>(mesh, *fine, 2);
        transfer.restrict(w.data(), RAPu.data());
        const double scale = std::sqrt(product(*fine, w, w) * product(*fine, Pu, Pu));
        errors.transpose   = std::max(errors.transpose, std::abs(product(*fine, w, Pu) - product(*coarse, RAPu, u)) / scale);
        // Nested spaces: P^T A P is the coarse operator itself.
        transfer.restrict(APu.data(), RAPu.data());
        errors.energy = std::max(errors.energy, largest_of_sum(*coarse, 1., RAPu, -1., Au, 0., Au) / largest(*coarse, Au));

        errors.oracle = std::max(errors.oracle, difference_to_oracle(coarse_mesh, mesh, *coarse, *fine, u, Pu));
        coarse        = std::move(fine);
      }
    return errors;
  }
} // namespace


TEST(LevelTransfer, NestedSpacesAndDealiiAgree)
{
  std::vector<Scene> all = scenes();
  all.push_back({20., 2.5, 0.625, oracle::sphere_points(Point(10., -10., 0.), 1.)});
  all.push_back({10., 2., 1., scenes()[1].band});
  TransferErrors largest;
  for (const Scene &scene : all)
    {
      const TransferErrors errors = transfer_errors(scene);
      EXPECT_LT(errors.energy, 1e-13) << "box " << scene.box.side[0];
      EXPECT_LT(errors.transpose, 1e-14) << "box " << scene.box.side[0];
      EXPECT_LT(errors.oracle, 1e-14) << "box " << scene.box.side[0];
      largest = {std::max(largest.energy, errors.energy), std::max(largest.transpose, errors.transpose), std::max(largest.oracle, errors.oracle)};
    }
  if (is_root())
    std::cout << "relative differences: energy " << largest.energy << ", transpose " << largest.transpose << ", deal.II's transfer " << largest.oracle
              << std::endl;
}
