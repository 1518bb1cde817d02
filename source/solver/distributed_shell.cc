// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the shells' forces, each rank computing those of its faces.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/solver/distributed_shell.h>
#include <tanktread/surface/face_partition.h>

namespace tanktread
{
  namespace
  {
    /** Faces of a control mesh that a rank of the team works on. */
    std::vector<unsigned int>
    part_of_team(const TriangleMesh &topology, const MPI_Comm team)
    {
      int rank, n_ranks;
      MPI_Comm_rank(team, &rank);
      MPI_Comm_size(team, &n_ranks);
      // Divided once and sent to all, so that it does not matter whether METIS is the same everywhere.
      std::vector<int> owner(topology.faces.size());
      on_first_rank(team, [&] {
        const auto parts = partition_faces(topology, n_ranks);
        for (std::size_t part = 0; part < parts.size(); ++part)
          for (const unsigned int face : parts[part])
            owner[face] = int(part);
      });
      MPI_Bcast(owner.data(), int(owner.size()), MPI_INT, 0, team);
      std::vector<unsigned int> result;
      for (std::size_t face = 0; face < owner.size(); ++face)
        if (owner[face] == rank)
          result.push_back(face);
      return result;
    }
  } // namespace


  DistributedShell::DistributedShell(const ShellLayout &layout)
    : layout_(layout)
  {
    for (unsigned int k = 0; k < layout.capsules().n_kinds(); ++k)
      faces_.push_back(part_of_team(layout.capsules().kind(k).topology(), layout.team()));
  }


  void
  DistributedShell::sum(double *values, const Eigen::Index n) const
  {
    if (!layout_.is_team_of_one())
      MPI_Allreduce(MPI_IN_PLACE, values, int(n), MPI_DOUBLE, MPI_SUM, layout_.team());
  }


  std::vector<Shell::Energy>
  DistributedShell::energies(const ShellFields &x) const
  {
    std::vector<Shell::Energy> result;
    on_all_ranks(layout_.communicator(), [&] {
      for (unsigned int i = 0; i < x.size(); ++i)
        result.push_back(layout_.capsule(i).shell().energy(x[i], faces_of(i)));
    });
    for (Shell::Energy &energy : result)
      {
        double values[] = {energy.membrane, energy.bending};
        sum(values, 2);
        energy = {values[0], values[1]};
      }
    return result;
  }


  ShellFields
  DistributedShell::forces(const ShellFields &x) const
  {
    ShellFields result;
    on_all_ranks(layout_.communicator(), [&] {
      for (unsigned int i = 0; i < x.size(); ++i)
        result.push_back(layout_.capsule(i).shell().force(x[i], faces_of(i)));
    });
    for (ControlPoints &f : result)
      sum(f.data(), f.size());
    return result;
  }


  void
  DistributedShell::forces_and_tangents(const ShellFields &x, ShellFields &f, std::vector<SparseMatrix> &K, const Tangent tangent) const
  {
    f.resize(x.size());
    K.resize(x.size());
    on_all_ranks(layout_.communicator(), [&] {
      for (unsigned int i = 0; i < x.size(); ++i)
        layout_.capsule(i).shell().force_and_tangent(x[i], faces_of(i), f[i], K[i], tangent);
    });
    for (unsigned int i = 0; i < x.size(); ++i)
      {
        sum(f[i].data(), f[i].size());
        sum(K[i].valuePtr(), K[i].nonZeros());
      }
  }


  std::vector<SparseMatrix>
  DistributedShell::tangents(const ShellFields &x, const Tangent tangent) const
  {
    ShellFields               f;
    std::vector<SparseMatrix> result;
    forces_and_tangents(x, f, result, tangent);
    return result;
  }
} // namespace tanktread
