// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kinks of the velocity and the jumps of the pressure at all shells.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/shell_jumps.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tanktread
{
  ShellJumps::ShellJumps(const TaylorHoodSpace &space, const ViscosityContrast &contrast, const unsigned int n_shells)
    : space_(space)
    , contrast_(contrast)
    , n_shells_(n_shells)
  {
    if (are_none())
      return;
    vertices_ = std::make_shared<NodeSpace>(ScalarSpace(space.mesh, 1, false), 4);
    if (vertices_->n_owned() != space.pressure->n_owned() || vertices_->first_owned() != space.pressure->first_owned())
      throw std::logic_error("ShellJumps: the pressure's vertices are numbered in another way than those of the forces.");
    locator_  = std::make_shared<CellLocator>(space.mesh);
    pressure_ = std::make_unique<PressureWithoutMean>(space);
    pressures_.resize(space.pressure->full_size());
  }


  void
  ShellJumps::move(const std::vector<ShellTransfer> &transfers,
                   const std::vector<unsigned int>  &numbers,
                   const std::vector<ShellBox>      &boxes,
                   const PointInterpolation         &points)
  {
    if (are_none())
      return;
    set_colours(boxes, points);
    std::vector<std::vector<LocatedShell>> shells(colours_.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      shells[colour_of_[numbers[i]]].push_back({&transfers[i].shell(), transfers[i].range(), transfers[i].first(), numbers[i]});
    n_coarse_cut_cells_ = 0;
    for (std::size_t k = 0; k < colours_.size(); ++k)
      {
        colours_[k].move(std::move(shells[k]), points);
        n_coarse_cut_cells_ += colours_[k].n_coarse_cut_cells();
      }
    n_coarse_cut_cells_ = dealii::Utilities::MPI::sum(n_coarse_cut_cells_, space_.mesh.communicator());
    pairs_.reinit(space_, colours_, contrast_.ratio);
    set_sides();
    if (contrast_.ratio != 1.)
      give_viscous_forces();
  }


  void
  ShellJumps::set_colours(const std::vector<ShellBox> &boxes, const PointInterpolation &points)
  {
    const MPI_Comm communicator = space_.mesh.communicator();
    const double   h            = space_.mesh.cell_size(space_.mesh.finest_level());
    double         largest      = h;
    for (const unsigned int cell : points.cells())
      largest = std::max(largest, space_.velocity->cell_sizes()[cell]);
    largest                        = dealii::Utilities::MPI::max(largest, communicator);
    constexpr double      rounding = 1. + 1e-6;
    const double          margin   = rounding * 2. * std::max(3. * h, 2. * largest);
    std::vector<ShellBox> occupied = boxes;
    // The viscous forces are still where the shells were.
    for (std::size_t c = 0; c < viscous_boxes_.size(); ++c)
      occupied[c] = joined(boxes[c], viscous_boxes_[c]);
    colour_of_ = shell_colours(occupied, space_.mesh.box(), margin);
    // Positions may differ by rounding from rank to rank.
    MPI_Bcast(colour_of_.data(), int(colour_of_.size()), MPI_UNSIGNED, 0, communicator);
    boxes_                       = boxes;
    const unsigned int n_colours = *std::max_element(colour_of_.begin(), colour_of_.end()) + 1;
    while (colours_.size() > n_colours)
      colours_.pop_back();
    while (colours_.size() < n_colours)
      colours_.emplace_back(space_, vertices_, locator_, contrast_);
    duals_.resize(n_colours);
    for (VertexArray &dual : duals_)
      dual.resize(vertices_->full_size());
  }


  void
  ShellJumps::set_viscous_forces(ViscousForces forces)
  {
    viscous_forces_ = std::move(forces.at_vertices);
    viscous_boxes_  = std::move(forces.boxes);
  }


  void
  ShellJumps::give_viscous_forces()
  {
    std::vector<std::vector<JumpEnrichment::ViscousForce>> of_colour(colours_.size());
    for (const JumpEnrichment::ViscousForce &force : viscous_forces_)
      of_colour[colour_of_[force.shell]].push_back(force);
    for (std::size_t k = 0; k < colours_.size(); ++k)
      colours_[k].set_viscous_forces(of_colour[k]);
  }


  void
  ShellJumps::set_sides()
  {
    sides_.assign(space_.pressure->n_owned() + 1, unknown_side); // and one, so that a rank without cells does not take them for none
    for (const JumpEnrichment &colour : colours_)
      for (const NearVertex &vertex : colour.near_vertices())
        {
          int &side = sides_[vertex.node];
          if (!vertex.inside)
            side = std::max<int>(side, outside_all);
          else if (side < 0 || int(vertex.shell) < side) // shells that overlap, before their step is rejected: whatever their colours
            side = vertex.shell;
        }
  }


  void
  ShellJumps::extend(ExtendedForces &forces) const
  {
    forces.at_vertices.resize(colours_.size());
    for (std::size_t k = 0; k < colours_.size(); ++k)
      colours_[k].averages().extend(forces.at_points, forces.at_vertices[k]);
    forces.whole = false;
  }


  void
  ShellJumps::complete(ExtendedForces &forces) const
  {
    for (std::size_t k = 0; k < colours_.size(); ++k)
      colours_[k].complete(forces.at_vertices[k]);
    forces.whole = contrast_.ratio != 1.;
  }


  void
  ShellJumps::add_load(const ExtendedForces &forces, const double factor, FluidBlockVector &load) const
  {
    if (are_none())
      return;
    std::fill(pressures_.begin(), pressures_.end(), 0.);
    FluidVector &load_u = load.block(velocity_block);
    for (std::size_t k = 0; k < colours_.size(); ++k)
      colours_[k].add_load(forces.at_vertices[k], factor, load_u.begin(), pressures_.data());
    load_u.compress(dealii::VectorOperation::add);
    pressure_->add_load(pressures_, load);
  }


  void
  ShellJumps::add_velocities(const FluidBlockVector &fields, const ExtendedForces *const forces, std::vector<double> &values) const
  {
    if (are_none())
      return;
    pressure_->load(fields, pressures_);
    const FluidVector &u = fields.block(velocity_block);
    u.update_ghost_values();
    for (std::size_t k = 0; k < colours_.size(); ++k)
      {
        std::fill(duals_[k].begin(), duals_[k].end(), 0.);
        colours_[k].add_field_response(u.begin(), pressures_.data(), duals_[k]);
        if (forces != nullptr)
          colours_[k].add_self_response(forces->at_points, forces->at_vertices[k], forces->whole, duals_[k], values);
      }
    u.zero_out_ghost_values();
    if (forces != nullptr)
      pairs_.add_response(forces->at_points, forces->at_vertices, duals_, values);
    for (std::size_t k = 0; k < colours_.size(); ++k)
      colours_[k].averages().add_transposed(duals_[k], values);
  }


  void
  ShellJumps::carry_pressure(const ExtendedForces &forces, VertexSides &sides, FluidBlockVector &fields) const
  {
    if (!sides.empty())
      for (std::size_t k = 0; k < colours_.size(); ++k)
        colours_[k].carry_pressure(forces.at_vertices[k], sides, fields);
    sides = sides_;
  }


  void
  ShellJumps::update_viscous_forces(const std::vector<double> &gradients, const std::vector<double> &laplacians, const ExtendedForces &forces)
  {
    viscous_boxes_ = boxes_;
    viscous_forces_.clear();
    for (std::size_t k = 0; k < colours_.size(); ++k)
      {
        colours_[k].update_viscous_forces(gradients, laplacians, forces.at_vertices[k], tractions_);
        colours_[k].append_viscous_forces(viscous_forces_);
      }
  }


  void
  ShellJumps::add_viscous_change(const std::vector<double> &gradients, ExtendedForces &forces) const
  {
    for (std::size_t k = 0; k < colours_.size(); ++k)
      {
        colours_[k].viscous_forces(gradients, forces.at_vertices[k], tractions_, duals_[k]);
        for (std::size_t i = 0; i < duals_[k].size(); ++i)
          forces.at_vertices[k][i] += duals_[k][i];
      }
  }


  double
  ShellJumps::undisturbed_work(const ExtendedForces &forces) const
  {
    double result = 0.;
    for (std::size_t k = 0; k < colours_.size(); ++k)
      result += colours_[k].undisturbed_work(forces.at_vertices[k]);
    return dealii::Utilities::MPI::sum(result, space_.mesh.communicator());
  }
} // namespace tanktread
