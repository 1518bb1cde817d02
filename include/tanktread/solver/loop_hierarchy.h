// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the control meshes from which Loop's subdivision has made that of a capsule.

#ifndef tanktread_solver_loop_hierarchy_h
#define tanktread_solver_loop_hierarchy_h

#include <tanktread/solver/galerkin_product.h>
#include <tanktread/solver/patch_inverses.h>
#include <tanktread/surface/assembly_pattern.h>
#include <tanktread/surface/triangle_mesh.h>

#include <optional>
#include <vector>

namespace tanktread
{
  /** What ShellMultigrid needs of one control mesh. Points come in the order of the first face that they belong to, so that successive ones are neighbours. */
  struct LoopLevel
  {
    int          n = 0, begin = 0, end = 0; // points, and those of this part
    bool         is_divided = false;        // otherwise all parts have all points
    BlockPattern pattern;                   // of the shell's matrix

    /** Of a part, where the level is divided into n_parts. */
    int
    first_point(const int part, const int n_parts) const
    {
      return int(long(n) * part / n_parts);
    }

    // Not on the coarsest level:
    std::optional<PatchInverses>   patches;
    SparseMatrix                   prolongation; // from the next coarser mesh, for one component
    std::optional<GalerkinProduct> product;      // the contribution of this part
  };

  /** Control meshes that Loop's subdivision leads from one to the next of, finest first, each divided into parts. */
  class LoopHierarchy
  {
  public:
    /** @param pattern of the shell's matrix. @param part among n_parts. */
    LoopHierarchy(const TriangleMesh &topology, const AssemblyPattern &pattern, int n_parts, int part);

    const std::vector<LoopLevel> &
    levels() const
    {
      return levels_;
    }
    /** Whether the coarsest mesh has so few points that a dense matrix will do; no, where the first mesh is no result of subdivisions. */
    bool
    ends_coarse() const
    {
      return levels_.back().n <= most_coarse_points;
    }
    /** The control point at each place of the finest level. */
    const std::vector<int> &
    order() const
    {
      return order_;
    }

  private:
    static constexpr int most_coarse_points = 42;

    std::vector<LoopLevel> levels_;
    std::vector<int>       order_;
  };
} // namespace tanktread

#endif
