// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the shells' forces, each rank computing those of its faces.

#ifndef tanktread_solver_distributed_shell_h
#define tanktread_solver_distributed_shell_h

#include <tanktread/coupling/shell_layout.h>

#include <vector>

namespace tanktread
{
  /**
   * Energy, force and tangent of the rank's own capsules, control points and results NP x 3 for each. Where a team has several ranks, these divide the faces of its shells by METIS and
   * all get the sums. All member functions but faces() are collective on all ranks, and throw what Shell's throw, on all ranks alike.
   */
  class DistributedShell
  {
  public:
    /** Keeps `layout` by reference. */
    explicit DistributedShell(const ShellLayout &layout);

    std::vector<Shell::Energy>
    energies(const ShellFields &x) const;

    ShellFields
    forces(const ShellFields &x) const;

    /** K = -df/dx of each, and the forces too. */
    std::vector<SparseMatrix>
    tangents(const ShellFields &x, Tangent tangent = Tangent::exact) const;
    void
    forces_and_tangents(const ShellFields &x, ShellFields &f, std::vector<SparseMatrix> &K, Tangent tangent = Tangent::exact) const;

    /** Of a kind of capsule, those that this rank works on. */
    const std::vector<unsigned int> &
    faces(const unsigned int kind) const
    {
      return faces_[kind];
    }
    const ShellLayout &
    layout() const
    {
      return layout_;
    }

  private:
    void
    sum(double *values, Eigen::Index n) const;
    /** Those of the kind of own capsule i. */
    const std::vector<unsigned int> &
    faces_of(const unsigned int i) const
    {
      return faces_[layout_.capsules().kind_of(layout_.own()[i])];
    }

    const ShellLayout                     &layout_;
    std::vector<std::vector<unsigned int>> faces_;
  };
} // namespace tanktread

#endif
