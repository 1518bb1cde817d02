// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kinks of the velocity and the jumps of the pressure at all shells.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/shell_jumps.h>

#include <algorithm>

namespace tanktread
{
  ShellJumps::ShellJumps(const TaylorHoodSpace &space, const ViscosityContrast &contrast, const unsigned int n_shells)
    : space_(space)
    , viscosity_ratio_(contrast.ratio)
    , duals_(n_shells)
  {
    if (n_shells == 0)
      return;
    const auto vertices = std::make_shared<NodeSpace>(ScalarSpace(space.mesh, 1, false), 4);
    for (unsigned int c = 0; c < n_shells; ++c)
      shells_.emplace_back(space, vertices, contrast);
    pressure_ = std::make_unique<PressureWithoutMean>(space);
    for (VertexArray &dual : duals_)
      dual.resize(vertices->full_size());
    pressures_.resize(space.pressure->full_size());
  }


  void
  ShellJumps::move(const std::vector<ShellTransfer> &transfers, const PointInterpolation &points)
  {
    n_coarse_cut_cells_ = 0;
    for (std::size_t c = 0; c < shells_.size(); ++c)
      {
        shells_[c].move(transfers[c].shell(), points, transfers[c].range(), transfers[c].first());
        n_coarse_cut_cells_ += shells_[c].n_coarse_cut_cells();
      }
    if (shells_.empty())
      return;
    n_coarse_cut_cells_ = dealii::Utilities::MPI::sum(n_coarse_cut_cells_, space_.mesh.communicator());
    pairs_.reinit(space_, shells_, viscosity_ratio_);
  }


  void
  ShellJumps::extend(ExtendedForces &forces) const
  {
    forces.at_vertices.resize(shells_.size());
    for (std::size_t c = 0; c < shells_.size(); ++c)
      shells_[c].averages().extend(forces.at_points, forces.at_vertices[c]);
    forces.whole = false;
  }


  void
  ShellJumps::complete(ExtendedForces &forces) const
  {
    for (std::size_t c = 0; c < shells_.size(); ++c)
      shells_[c].complete(forces.at_vertices[c]);
    forces.whole = viscosity_ratio_ != 1.;
  }


  void
  ShellJumps::add_load(const ExtendedForces &forces, const double factor, FluidBlockVector &load) const
  {
    if (shells_.empty())
      return;
    std::fill(pressures_.begin(), pressures_.end(), 0.);
    FluidVector &load_u = load.block(velocity_block);
    for (std::size_t c = 0; c < shells_.size(); ++c)
      shells_[c].add_load(forces.at_vertices[c], factor, load_u.begin(), pressures_.data());
    load_u.compress(dealii::VectorOperation::add);
    pressure_->add_load(pressures_, load);
  }


  void
  ShellJumps::add_velocities(const FluidBlockVector &fields, const ExtendedForces *const forces, std::vector<double> &values) const
  {
    if (shells_.empty())
      return;
    pressure_->load(fields, pressures_);
    const FluidVector &u = fields.block(velocity_block);
    u.update_ghost_values();
    for (std::size_t c = 0; c < shells_.size(); ++c)
      {
        std::fill(duals_[c].begin(), duals_[c].end(), 0.);
        shells_[c].add_field_response(u.begin(), pressures_.data(), duals_[c]);
        if (forces != nullptr)
          shells_[c].add_self_response(forces->at_points, forces->at_vertices[c], forces->whole, duals_[c], values);
      }
    u.zero_out_ghost_values();
    if (forces != nullptr)
      pairs_.add_response(forces->at_points, forces->at_vertices, duals_, values);
    for (std::size_t c = 0; c < shells_.size(); ++c)
      shells_[c].averages().add_transposed(duals_[c], values);
  }


  void
  ShellJumps::carry_pressure(const unsigned int c, const ExtendedForces &forces, VertexSides &sides, FluidBlockVector &fields) const
  {
    shells_[c].carry_pressure(forces.at_vertices[c], sides, fields);
  }


  void
  ShellJumps::update_viscous_forces(const std::vector<double> &gradients, const std::vector<double> &laplacians, const ExtendedForces &forces)
  {
    for (std::size_t c = 0; c < shells_.size(); ++c)
      shells_[c].update_viscous_forces(gradients, laplacians, forces.at_vertices[c]);
  }


  void
  ShellJumps::add_viscous_change(const std::vector<double> &gradients, ExtendedForces &forces) const
  {
    for (std::size_t c = 0; c < shells_.size(); ++c)
      {
        shells_[c].viscous_forces(gradients, forces.at_vertices[c], duals_[c]);
        for (std::size_t i = 0; i < duals_[c].size(); ++i)
          forces.at_vertices[c][i] += duals_[c][i];
      }
  }


  double
  ShellJumps::undisturbed_work(const ExtendedForces &forces) const
  {
    double result = 0.;
    for (std::size_t c = 0; c < shells_.size(); ++c)
      result += shells_[c].undisturbed_work(forces.at_vertices[c]);
    return dealii::Utilities::MPI::sum(result, space_.mesh.communicator());
  }
} // namespace tanktread
