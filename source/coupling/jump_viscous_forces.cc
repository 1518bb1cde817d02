// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what another viscosity inside adds to the forces that make kinks and jumps.

#include <tanktread/coupling/jump_enrichment.h>

#include <algorithm>

namespace tanktread
{
  void
  JumpEnrichment::set_mean_gradients(const PointInterpolation &points)
  {
    static const NodeDistances   uncut{}; // a cell with no node on the other side has no psi
    std::vector<const CutCell *> cut_cell(averages_.groups().size(), nullptr);
    for (const CutCell &cut : cut_cells_)
      if (cut.group != VertexAverages::no_points)
        cut_cell[cut.group] = &cut;
    mean_gradients_.resize(averages_.n_points());
    for (unsigned int k = 0; k < averages_.groups().size(); ++k)
      {
        const VertexAverages::Group &group = averages_.groups()[k];
        const LocatedShell          &shell = averages_.shells()[group.shell];
        const NodeDistances         &nodes = cut_cell[k] != nullptr ? cut_cell[k]->nodes : uncut;
        const NodeAmplitudes         q     = node_amplitudes(nodes, contrast_.ratio);
        for (unsigned int i = group.begin; i < group.end; ++i)
          mean_gradients_[i] = MeanGradient(nodes,
                                            q,
                                            averages_.unit_position(i),
                                            space_.velocity->cell_sizes()[group.cell],
                                            shell.shell->patches()[points.local_points()[averages_.point(i)] - shell.first]);
      }
  }


  void
  JumpEnrichment::complete(VertexArray &forces) const
  {
    for (std::size_t i = 0; i < viscous_forces_.size(); ++i)
      forces[i] += viscous_forces_[i];
  }


  template <typename Mean>
  void
  JumpEnrichment::extend_viscous_forces(const std::vector<double> &gradients,
                                        const VertexArray         &forces,
                                        const Mean                &mean,
                                        std::vector<double>       &tractions,
                                        VertexArray               &g) const
  {
    tractions.resize(gradients.size() / 3); // those of other shells are not read
    for (const VertexAverages::Group &group : averages_.groups())
      {
        const VertexForces F = averages_.at_cell(forces, group.cell);
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            const std::size_t     r      = averages_.point(i);
            const Eigen::Matrix3d G      = mean(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&gradients[9 * r]), i, r, F);
            const Vector4        &normal = averages_.normal(i);
            const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
            const Eigen::Vector3d traction = (1. - contrast_.ratio) * averages_.area(i) * (G * n + G.transpose() * n);
            std::copy_n(traction.data(), 3, &tractions[3 * r]);
          }
      }
    averages_.extend(tractions, g);
  }


  void
  JumpEnrichment::viscous_forces(const std::vector<double> &gradients, const VertexArray &forces, std::vector<double> &tractions, VertexArray &g) const
  {
    const auto mean = [&](const Eigen::Matrix3d &G, const unsigned int i, std::size_t, const VertexForces &F) {
      return mean_gradients_[i].without_second_jump(G, F);
    };
    extend_viscous_forces(gradients, forces, mean, tractions, g);
  }


  void
  JumpEnrichment::update_viscous_forces(const std::vector<double> &gradients,
                                        const std::vector<double> &laplacians,
                                        const VertexArray         &forces,
                                        std::vector<double>       &tractions)
  {
    const auto mean = [&](const Eigen::Matrix3d &G, const unsigned int i, const std::size_t r, const VertexForces &F) {
      return mean_gradients_[i](G, Eigen::Vector3d(&laplacians[3 * r]), F, contrast_.ratio);
    };
    extend_viscous_forces(gradients, forces, mean, tractions, viscous_forces_);
  }


  void
  JumpEnrichment::append_viscous_forces(std::vector<ViscousForce> &forces) const
  {
    for (const VertexAverages::SeeingVertex &vertex : averages_.seeing_vertices())
      {
        forces.push_back({vertex.node, vertex.shell, {}});
        std::copy_n(&viscous_forces_[4 * std::size_t(vertex.node)], 4, forces.back().value.data());
      }
  }


  void
  JumpEnrichment::set_viscous_forces(const std::vector<ViscousForce> &forces)
  {
    std::fill(viscous_forces_.begin(), viscous_forces_.end(), 0.);
    for (const ViscousForce &force : forces)
      std::copy_n(force.value.data(), 4, &viscous_forces_[4 * std::size_t(force.node)]);
    averages_.vertices().update(viscous_forces_.data());
  }
} // namespace tanktread
