// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how much of a shell the enriched interface sees.

#include <tanktread/coupling/interface_quality.h>

namespace tanktread
{
  namespace
  {
    /** Areas of the shells of a colour on this rank: all of it, without jumps and folded, three numbers each by the shells' numbers. */
    void
    add_areas(const JumpEnrichment &colour, std::vector<double> &areas)
    {
      const VertexAverages &averages = colour.averages();
      std::vector<char>     has_jumps(averages.groups().size(), 0);
      for (const JumpEnrichment::CutCell &cut : colour.cut_cells())
        if (cut.group != VertexAverages::no_points)
          has_jumps[cut.group] = 1;
      for (std::size_t g = 0; g < has_jumps.size(); ++g)
        {
          Vector4 sum;
          double  area = 0.;
          for (unsigned int i = averages.groups()[g].begin; i < averages.groups()[g].end; ++i)
            {
              area += averages.area(i);
              sum += averages.area(i) * averages.normal(i);
            }
          double *const of_shell = &areas[3 * std::size_t(averages.shells()[averages.groups()[g].shell].number)];
          of_shell[0] += area;
          of_shell[1] += has_jumps[g] ? 0. : area;
          of_shell[2] += sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2] < 0.25 * area * area ? area : 0.;
        }
    }
  } // namespace


  std::vector<InterfaceQuality>
  interface_quality(const Coupling &coupling)
  {
    std::vector<InterfaceQuality>   result(coupling.layout().n_own());
    std::vector<double>             areas(3 * std::size_t(coupling.layout().n_capsules()), 0.);
    std::vector<ShellGuests::Block> blocks;
    if (coupling.jumps().are_none())
      return result;
    for (const JumpEnrichment &colour : coupling.jumps().colours())
      add_areas(colour, areas);
    for (const unsigned int c : coupling.guests().present())
      blocks.push_back({&areas[3 * std::size_t(c)], 3});
    coupling.guests().sum(blocks);
    for (unsigned int i = 0; i < result.size(); ++i)
      if (const double *const of_shell = &areas[3 * std::size_t(coupling.layout().own()[i])]; of_shell[0] > 0.)
        result[i] = {of_shell[1] / of_shell[0], of_shell[2] / of_shell[0]};
    return result;
  }
} // namespace tanktread
