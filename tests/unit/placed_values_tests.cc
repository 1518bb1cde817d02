// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of values that are found by the places of nodes, whatever rank has these.

#include <gtest/gtest.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/placed_values.h>

#include <algorithm>

#include "full_arrays.h"

using namespace tanktread;

namespace
{
  /** The mesh of a scene with cells divided by their number, or by work. */
  struct Divided
  {
    Divided(const Scene &scene, const double work)
      : mesh(MPI_COMM_WORLD, scene.box, cells(scene.coarsest, scene.finest))
    {
      mesh.set_work_of_cells_with_points(work);
      mesh.adapt(scene.band);
      space = std::make_unique<TaylorHoodSpace>(mesh);
    }

    FluidMesh                        mesh;
    std::unique_ptr<TaylorHoodSpace> space;
  };


  std::vector<double>
  rough(const Divided &on, const NodeSpace &nodes)
  {
    FluidVector vector(nodes.partitioner());
    oracle::set_rough(on.mesh, nodes, 3, vector);
    return {vector.begin(), vector.begin() + vector.locally_owned_size()};
  }


  std::size_t
  n_different(std::vector<std::uint64_t> places)
  {
    std::sort(places.begin(), places.end());
    return std::unique(places.begin(), places.end()) - places.begin();
  }
} // namespace


TEST(PlacedValues, AreTheSameOnAnotherDivision)
{
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  bool               moved   = false;
  for (const Scene &scene : scenes())
    {
      const Divided by_number(scene, 0.), by_work(scene, 20.);
      for (const auto member : {&TaylorHoodSpace::velocity, &TaylorHoodSpace::pressure})
        {
          const NodeSpace                 &from = *((*by_number.space).*member), &to = *((*by_work.space).*member);
          const std::vector<std::uint64_t> places = places_of_nodes(*by_number.space, from), wanted = places_of_nodes(*by_work.space, to);
          EXPECT_EQ(n_different(places), from.n_owned());
          moved = moved || places != wanted;
          EXPECT_EQ(values_at(wanted, {places, rough(by_number, from)}, from.n_components(), MPI_COMM_WORLD), rough(by_work, to));
        }
    }
  EXPECT_EQ(dealii::Utilities::MPI::max(int(moved), MPI_COMM_WORLD), int(n_ranks > 1));
}


TEST(PlacedValues, OfAnotherMeshAreMissed)
{
  const Divided coarse({10., 2.5, 1.25, oracle::sphere_points({0.1, 0.2, 0.3}, 1.)}, 0.),
    fine({10., 2.5, 0.625, oracle::sphere_points({0.1, 0.2, 0.3}, 1.)}, 0.);
  const std::vector<std::uint64_t> known = places_of_nodes(*coarse.space, *coarse.space->pressure);
  EXPECT_THROW(values_at(places_of_nodes(*fine.space, *fine.space->pressure), {known, std::vector<double>(known.size(), 1.)}, 1, MPI_COMM_WORLD),
               NumericalError);
}
