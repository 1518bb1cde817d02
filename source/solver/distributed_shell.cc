// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the shell's forces, each rank computing those of its faces.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/solver/distributed_shell.h>
#include <tanktread/surface/face_partition.h>

namespace tanktread
{
  DistributedShell::DistributedShell(const Shell &shell, const TriangleMesh &topology, MPI_Comm communicator)
    : shell_(shell)
    , communicator_(communicator)
  {
    int rank, n_ranks;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_ranks);
    // Divided once and sent to all, so that it does not matter whether METIS is the same everywhere.
    std::vector<int> owner(topology.faces.size());
    on_first_rank(communicator, [&] {
      const auto parts = partition_faces(topology, n_ranks);
      for (std::size_t part = 0; part < parts.size(); ++part)
        for (const unsigned int face : parts[part])
          owner[face] = int(part);
    });
    MPI_Bcast(owner.data(), int(owner.size()), MPI_INT, 0, communicator);
    for (std::size_t face = 0; face < owner.size(); ++face)
      if (owner[face] == rank)
        faces_.push_back(face);
  }


  void
  DistributedShell::sum(double *values, const Eigen::Index n) const
  {
    MPI_Allreduce(MPI_IN_PLACE, values, int(n), MPI_DOUBLE, MPI_SUM, communicator_);
  }


  Shell::Energy
  DistributedShell::energy(const ControlPoints &x) const
  {
    Shell::Energy energy{0., 0.};
    on_all_ranks(communicator_, [&] { energy = shell_.energy(x, faces_); });
    double values[] = {energy.membrane, energy.bending};
    sum(values, 2);
    return {values[0], values[1]};
  }


  ControlPoints
  DistributedShell::force(const ControlPoints &x) const
  {
    ControlPoints f;
    on_all_ranks(communicator_, [&] { f = shell_.force(x, faces_); });
    sum(f.data(), f.size());
    return f;
  }


  void
  DistributedShell::force_and_tangent(const ControlPoints &x, ControlPoints &f, SparseMatrix &K, const Tangent tangent) const
  {
    on_all_ranks(communicator_, [&] { shell_.force_and_tangent(x, faces_, f, K, tangent); });
    sum(f.data(), f.size());
    sum(K.valuePtr(), K.nonZeros());
  }
} // namespace tanktread
