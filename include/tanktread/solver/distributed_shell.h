// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the shell's forces, each rank computing those of its faces.

#ifndef tanktread_solver_distributed_shell_h
#define tanktread_solver_distributed_shell_h

#include <tanktread/shell/shell.h>
#include <tanktread/surface/triangle_mesh.h>

#include <mpi.h>

#include <vector>

namespace tanktread
{
  /**
   * Divides the faces of a Shell among the ranks. Every rank knows all control points and gets the sums over all faces. All member functions
   * but faces() and communicator() are collective, and throw what Shell's throw, on all ranks alike.
   */
  class DistributedShell
  {
  public:
    /** `topology`: the faces of the shell's surface. Keeps `shell` by reference. */
    DistributedShell(const Shell &shell, const TriangleMesh &topology, MPI_Comm communicator);

    Shell::Energy
    energy(const ControlPoints &x) const;

    ControlPoints
    force(const ControlPoints &x) const;

    void
    force_and_tangent(const ControlPoints &x, ControlPoints &f, SparseMatrix &K, Tangent tangent = Tangent::exact) const;

    /** Those of this rank. */
    const std::vector<unsigned int> &
    faces() const
    {
      return faces_;
    }
    MPI_Comm
    communicator() const
    {
      return communicator_;
    }

  private:
    void
    sum(double *values, Eigen::Index n) const;

    const Shell              &shell_;
    MPI_Comm                  communicator_;
    std::vector<unsigned int> faces_;
  };
} // namespace tanktread

#endif
