// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what the forces of one shell do to another one inside the cells that both are in.

#include <tanktread/coupling/shell_pairs.h>

#include <unordered_map>
#include <unordered_set>

namespace tanktread
{
  namespace
  {
    /** A cut cell's nodes with what its forms are made of. */
    struct CutSide
    {
      CutSide(const NodeDistances &nodes, const double h, const double viscosity_ratio)
        : nodes(nodes)
        , q(node_amplitudes(nodes, viscosity_ratio))
      {
        std::array<double, 27> scaled;
        for (unsigned int a = 0; a < 27; ++a)
          scaled[a] = nodes.phi[a] / h;
        in = inside_matrices(scaled);
      }

      const NodeDistances &nodes;
      NodeAmplitudes       q;
      PartialCellMatrices  in;
    };


    /** Integral of a product of two jumps (chi_c - i_c)(chi_d - i_d) with something whose integrals over both insides and all of the cell are given. */
    double
    product(const bool i_c, const bool i_d, const double inside_c, const double inside_d, const double whole)
    {
      return (i_c && i_d ? whole : 0.) - (i_d ? inside_c : 0.) - (i_c ? inside_d : 0.);
    }


    /** With the viscosity 1 + (lambda - 1)(chi_c + chi_d). */
    std::array<std::array<double, 8>, 8>
    laplace_products(const CutSide &c, const CutSide &d, const double lambda)
    {
      const PartialCellMatrices           &whole  = whole_cell_matrices();
      std::array<std::array<double, 8>, 8> result = {};
      for (unsigned int a = 0; a < 27; ++a)
        {
          std::array<double, 8> row = {};
          for (unsigned int b = 0; b < 27; ++b)
            {
              const bool   i_c = c.nodes.inside[a], i_d = d.nodes.inside[b];
              const double entry = product(i_c, i_d, (i_c ? 1. : lambda) * c.in.laplace[a][b], (i_d ? 1. : lambda) * d.in.laplace[a][b], whole.laplace[a][b]);
              for (unsigned int w = 0; w < 8; ++w)
                row[w] += entry * d.q[b][w];
            }
          for (unsigned int v = 0; v < 8; ++v)
            for (unsigned int w = 0; w < 8; ++w)
              result[v][w] += c.q[a][v] * row[w];
        }
      return result;
    }


    /** [v][j]: (eta_d,j, grad psi_c,v) */
    std::array<std::array<std::array<float, 4>, 8>, 8>
    mixed_products(const CutSide &c, const CutSide &d)
    {
      const PartialCellMatrices                         &whole  = whole_cell_matrices();
      std::array<std::array<std::array<float, 4>, 8>, 8> result = {};
      for (unsigned int j = 0; j < 8; ++j)
        for (unsigned int k = 0; k < 3; ++k)
          {
            std::array<double, 8> row = {};
            for (unsigned int a = 0; a < 27; ++a)
              {
                const unsigned int i = 27 * k + a;
                const double       entry =
                  product(c.nodes.inside[a], d.nodes.inside[node_of_vertex(j)], c.in.divergence[j][i], d.in.divergence[j][i], whole.divergence[j][i]);
                for (unsigned int v = 0; v < 8; ++v)
                  row[v] += entry * c.q[a][v];
              }
            for (unsigned int v = 0; v < 8; ++v)
              result[v][j][k] = row[v];
          }
      return result;
    }
  } // namespace


  void
  ShellPairs::reinit(const TaylorHoodSpace &space, const std::vector<JumpEnrichment> &colours, const double viscosity_ratio)
  {
    space_           = &space;
    colours_         = &colours;
    viscosity_ratio_ = viscosity_ratio;
    points_.clear();
    cells_.clear();
    if (colours.size() < 2)
      return;
    // Of each cell, by colours: who has points there, and who cuts it.
    std::unordered_map<unsigned int, std::vector<std::pair<unsigned int, unsigned int>>>                    groups;
    std::unordered_map<unsigned int, std::vector<std::pair<unsigned int, const JumpEnrichment::CutCell *>>> cutters;
    for (unsigned int k = 0; k < colours.size(); ++k)
      for (unsigned int g = 0; g < colours[k].averages().groups().size(); ++g)
        groups[colours[k].averages().groups()[g].cell].emplace_back(k, g);
    for (unsigned int k = 0; k < colours.size(); ++k)
      for (const JumpEnrichment::CutCell &cut : colours[k].cut_cells())
        {
          auto &others = cutters[cut.cell];
          for (const auto &[other, other_cut] : others)
            add_cell(other, k, *other_cut, cut);
          others.emplace_back(k, &cut);
          if (const auto found = groups.find(cut.cell); found != groups.end())
            for (const auto &[other, group] : found->second)
              if (other != k)
                add_points(k, other, group, cut);
        }
  }


  unsigned int
  ShellPairs::n_cells() const
  {
    std::unordered_set<unsigned int> result;
    for (const SharedPoints &shared : points_)
      result.insert(shared.cell);
    for (const SharedCell &shared : cells_)
      result.insert(shared.cell);
    return result.size();
  }


  void
  ShellPairs::add_points(const unsigned int own, const unsigned int other, const unsigned int group, const JumpEnrichment::CutCell &cut)
  {
    const VertexAverages &averages = (*colours_)[other].averages();
    const NodeAmplitudes  q        = node_amplitudes(cut.nodes, viscosity_ratio_);
    SharedPoints          shared{own, other, cut.cell, group, {}};
    for (unsigned int i = averages.groups()[group].begin; i < averages.groups()[group].end; ++i)
      shared.psi.push_back(psi_outside(cut.nodes, q, averages.unit_position(i)));
    points_.push_back(std::move(shared));
  }


  void
  ShellPairs::add_cell(const unsigned int first, const unsigned int second, const JumpEnrichment::CutCell &cut_first, const JumpEnrichment::CutCell &cut_second)
  {
    const double  h = space_->velocity->cell_sizes()[cut_first.cell];
    const CutSide c(cut_first.nodes, h, viscosity_ratio_), d(cut_second.nodes, h, viscosity_ratio_);
    cells_.push_back({first, second, cut_first.cell, laplace_products(c, d, viscosity_ratio_), mixed_products(c, d), mixed_products(d, c)});
  }


  void
  ShellPairs::add_response(const std::vector<double>      &at_points,
                           const std::vector<VertexArray> &forces,
                           std::vector<VertexArray>       &duals,
                           std::vector<double>            &values) const
  {
    for (const SharedPoints &shared : points_)
      {
        const VertexAverages        &own = (*colours_)[shared.own].averages(), &other = (*colours_)[shared.other].averages();
        const VertexAverages::Group &group = other.groups()[shared.group];
        const VertexForces           f     = own.at_cell(forces[shared.own], shared.cell);
        VertexForces                 r;
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            const std::size_t            point = other.point(i);
            const Vector4                force(&at_points[3 * point]);
            Vector4                      value(&values[3 * point]);
            const std::array<double, 8> &psi = shared.psi[i - group.begin];
            for (unsigned int v = 0; v < 8; ++v)
              {
                value += psi[v] * f[v];
                r[v] += psi[v] * force;
              }
            value.store(&values[3 * point]);
          }
        own.add_to_cell(shared.cell, r, duals[shared.own]);
      }
    for (const SharedCell &shared : cells_)
      {
        const VertexAverages &first = (*colours_)[shared.first].averages(), &second = (*colours_)[shared.second].averages();
        const double          h   = space_->velocity->cell_sizes()[shared.cell];
        const VertexForces    f_1 = first.at_cell(forces[shared.first], shared.cell), f_2 = second.at_cell(forces[shared.second], shared.cell);
        VertexForces          r_1, r_2;
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int w = 0; w < 8; ++w)
            {
              const Vector4 of_second = vector4(shared.mixed_first_second[v][w]), of_first = vector4(shared.mixed_second_first[v][w]);
              r_1[v] += -h * shared.laplace[v][w] * tangential(f_2[w]) + -h * h * f_2[w][3] * of_second;
              r_2[v] += -h * shared.laplace[w][v] * tangential(f_1[w]) + -h * h * f_1[w][3] * of_first;
              r_2[w] += Vector4(0., 0., 0., -h * h * sum3(of_second.times(f_1[v])));
              r_1[w] += Vector4(0., 0., 0., -h * h * sum3(of_first.times(f_2[v])));
            }
        first.add_to_cell(shared.cell, r_1, duals[shared.first]);
        second.add_to_cell(shared.cell, r_2, duals[shared.second]);
      }
  }
} // namespace tanktread
