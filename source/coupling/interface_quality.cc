// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how much of a shell the enriched interface sees.

#include <tanktread/coupling/interface_quality.h>

#include <array>
#include <vector>

namespace tanktread
{
  InterfaceQuality
  interface_quality(const JumpEnrichment &shell, const MPI_Comm communicator)
  {
    const VertexAverages &averages = shell.averages();
    std::vector<char>     has_jumps(averages.groups().size(), 0);
    for (const JumpEnrichment::CutCell &cut : shell.cut_cells())
      if (cut.group != VertexAverages::no_points)
        has_jumps[cut.group] = 1;
    std::vector<double> areas(3, 0.); // all, without jumps, folded
    for (std::size_t g = 0; g < has_jumps.size(); ++g)
      {
        Vector4 sum;
        double  area = 0.;
        for (unsigned int i = averages.groups()[g].begin; i < averages.groups()[g].end; ++i)
          {
            area += averages.area(i);
            sum += averages.area(i) * averages.normal(i);
          }
        areas[0] += area;
        areas[1] += has_jumps[g] ? 0. : area;
        areas[2] += sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2] < 0.25 * area * area ? area : 0.;
      }
    dealii::Utilities::MPI::sum(areas, communicator, areas);
    return areas[0] > 0. ? InterfaceQuality{areas[1] / areas[0], areas[2] / areas[0]} : InterfaceQuality();
  }
} // namespace tanktread
