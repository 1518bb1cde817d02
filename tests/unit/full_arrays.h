// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: boxes with meshes in them, and arithmetic on full arrays, for tests of the numbering of nodes and of the multigrid.

#ifndef tanktread_tests_full_arrays_h
#define tanktread_tests_full_arrays_h

#include <deal.II/base/mpi.h>

#include <oracle/node_values.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tanktread
{
  template <typename Number>
  using Array = dealii::AlignedVector<Number>;

  inline bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  inline FluidMeshParameters
  cells(const double coarsest, const double finest)
  {
    FluidMeshParameters parameters;
    parameters.coarsest_cell = coarsest;
    parameters.finest_cell   = finest;
    return parameters;
  }

  /** A box, sizes of cells, and points around which they are fine. */
  struct Scene
  {
    Box                           box;
    double                        coarsest, finest;
    std::vector<dealii::Point<3>> band;
  };

  /** Three different sides, one or no pair of faces periodic, or two that are not x and y. */
  inline Box
  brick(const Faces x, const Faces y, const Faces z)
  {
    return {{{8., 12., 16.}}, {{x, y, z}}};
  }
  inline const Box closed_brick   = brick(Faces::prescribed, Faces::prescribed, Faces::prescribed);
  inline const Box brick_along_z  = brick(Faces::prescribed, Faces::prescribed, Faces::periodic);
  inline const Box brick_along_yz = brick(Faces::prescribed, Faces::periodic, Faces::periodic);

  /** Bands around spheres: in the middle, across both pairs of periodic faces, at a wall; in closed and periodic bricks, at faces of both kinds. */
  inline const std::vector<Scene> &
  scenes()
  {
    using Point                            = dealii::Point<3>;
    static const std::vector<Scene> result = {{10., 2.5, 0.3125, oracle::sphere_points(Point(0.1, 0., -0.2), 1.)},
                                              {10., 2.5, 0.3125, oracle::sphere_points(Point(-5., 5., 0.1), 1.)},
                                              {10., 2.5, 0.3125, oracle::sphere_points(Point(4.5, 1., 3.7), 1.)},
                                              {closed_brick, 4., 0.5, oracle::sphere_points(Point(2.9, -4.9, 6.9), 1.)},
                                              {brick_along_z, 4., 0.5, oracle::sphere_points(Point(2.9, 0.1, 8.), 1.)},
                                              {brick_along_yz, 4., 0.5, oracle::sphere_points(Point(-2.9, -6., 8.), 1.)}};
    return result;
  }

  /** Full array with rough numbers at the owned nodes. */
  template <typename Number>
  Array<Number>
  rough_array(const FluidMesh &mesh, const NodeSpace &space, const unsigned int seed)
  {
    FluidVector vector(space.partitioner());
    oracle::set_rough(mesh, space, seed, vector);
    Array<Number> result(space.full_size());
    space.load(vector, result.data());
    return result;
  }

  /** Of the owned entries, summed over the ranks. */
  template <typename Number>
  double
  product(const NodeSpace &space, const Array<Number> &x, const Array<Number> &y)
  {
    double sum = 0.;
    for (std::size_t i = 0; i < std::size_t(space.stride()) * space.n_owned(); ++i)
      sum += double(x[i]) * y[i];
    return dealii::Utilities::MPI::sum(sum, space.partitioner()->get_mpi_communicator());
  }

  /** Largest magnitude of a x + b y + c z over the owned entries of all ranks. */
  template <typename Number>
  double
  largest_of_sum(const NodeSpace &space, const double a, const Array<Number> &x, const double b, const Array<Number> &y, const double c, const Array<Number> &z)
  {
    double result = 0.;
    for (std::size_t i = 0; i < std::size_t(space.stride()) * space.n_owned(); ++i)
      result = std::max(result, std::abs(a * x[i] + b * y[i] + c * z[i]));
    return dealii::Utilities::MPI::max(result, space.partitioner()->get_mpi_communicator());
  }

  template <typename Number>
  double
  largest(const NodeSpace &space, const Array<Number> &x)
  {
    return largest_of_sum(space, 1., x, 0., x, 0., x);
  }
} // namespace tanktread

#endif
