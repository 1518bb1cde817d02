// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shells and spreading of the shells' forces to the fluid, each the other's adjoint.

#include <deal.II/base/mpi.h>

#include <tanktread/base/mpi_errors.h>
#include <tanktread/coupling/coupling.h>
#include <tanktread/coupling/shell_neighbours.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace tanktread
{
  Coupling::Coupling(const ShellLayout &layout, const Interface interface)
    : layout_(layout)
    , interface_(interface)
    , guests_(layout)
  {
    for (unsigned int k = 0; k < layout.capsules().n_kinds(); ++k)
      if (interface == Interface::enriched && layout.capsules().kind(k).coupling_surface().derivatives() != Derivatives::second)
        throw std::logic_error("The enriched interface needs second derivatives of the coupling's surface.");
  }


  void
  Coupling::attach(const TaylorHoodSpace &space)
  {
    space_         = &space;
    interpolation_ = std::make_unique<PointInterpolation>(space);
    jumps_         = std::make_unique<ShellJumps>(space, contrast_, interface_ == Interface::enriched ? layout_.n_capsules() : 0);
    reassign();
  }


  void
  Coupling::reassign()
  {
    guests_.clear();
    shells_.clear();
    transfers_.clear();
    moved_ = false;
  }


  std::vector<dealii::Point<3>>
  Coupling::points(const ShellConfigurations &shells)
  {
    std::vector<dealii::Point<3>> result;
    for (const auto &shell : shells)
      for (Eigen::Index q = 0; q < shell->points().rows(); ++q)
        result.emplace_back(shell->points()(q, 0), shell->points()(q, 1), shell->points()(q, 2));
    return result;
  }


  void
  Coupling::move(const ShellConfigurations &shells)
  {
    moved_ = false;
    evaluate(shells);
    ShellConfigurations known;
    for (const ShellTransfer &transfer : transfers_)
      known.push_back(transfer.shell_pointer());
    guests_.find(space_->mesh, shells);
    const ShellConfigurations present = present_shells(shells, guests_, known);
    evaluate(present);
    shells_ = shells;
    transfers_.clear();
    std::size_t n_points = 0, n_all = 0;
    for (const auto &shell : present)
      {
        transfers_.emplace_back(shell->capsule(), n_points);
        n_points += shell->points().rows();
      }
    for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
      n_all += layout_.capsules()[c].coupling_surface().n_points();
    interpolation_->reinit(points(present), n_all);
    for (unsigned int p = 0; p < present.size(); ++p)
      transfers_[p].move(present[p], *interpolation_);
    normal_forces_.resize(3 * interpolation_->local_points().size());
    for (const ShellTransfer &transfer : transfers_)
      transfer.set_point_forces(transfer.shell().normal_field(), normal_forces_);
    if (!jumps_->are_none())
      jumps_->move(transfers_, guests_.present(), boxes_of_all(layout_, shells), *interpolation_);
    moved_ = true;
  }


  double
  Coupling::distance(const ShellConfigurations &shells) const
  {
    if (!moved_)
      return std::numeric_limits<double>::infinity();
    double result = 0.;
    for (unsigned int i = 0; i < shells.size(); ++i)
      if (shells[i] != shells_[i])
        result = std::max(result, (shells[i]->x() - shells_[i]->x()).rowwise().norm().maxCoeff());
    return layout_.max(result);
  }


  Viscosity
  Coupling::viscosity(const ShellConfigurations &shells) const
  {
    // Those about cells that are far from them too: what lies inside has another viscosity.
    const ShellConfigurations about = shells_about_cells(layout_, shells, space_->mesh).shells;
    on_all_ranks(layout_.communicator(), [&] {
      for (const auto &shell : about)
        shell->patches();
    });
    return ShellViscosity(*space_)(about, contrast_.ratio);
  }


  void
  Coupling::extend(const ShellFields &g, ExtendedForces &forces, const std::vector<double> &pressure_jumps) const
  {
    NumbersOfCapsules numbers(guests_.present().size(), {{0., 0.}}); // normal part and pressure jump
    for (unsigned int i = 0; i < g.size(); ++i)
      {
        auto &[normal_part, pressure_jump] = numbers[guests_.place_of_own(i)];
        if (!jumps_->are_none())
          normal_part = shells_[i]->volume_gradient().cwiseProduct(g[i]).sum() / shells_[i]->normal_square(); // m . f = v . g
        if (!pressure_jumps.empty())
          pressure_jump = pressure_jumps[i];
      }
    set_point_forces(g, forces.at_points, &numbers);
    forces.normal_parts.clear();
    forces.pressure_jumps.clear();
    for (const auto &[normal_part, pressure_jump] : numbers)
      {
        forces.normal_parts.push_back(normal_part);
        forces.pressure_jumps.push_back(pressure_jump);
      }
    if (jumps_->are_none())
      return;
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      for (std::size_t i = 3 * std::size_t(transfers_[p].range().begin); i < 3 * std::size_t(transfers_[p].range().end); ++i)
        forces.at_points[i] -= forces.normal_parts[p] * normal_forces_[i];
    jumps_->extend(forces);
  }


  void
  Coupling::extend_whole(const ShellFields &g, ExtendedForces &forces, const std::vector<double> &pressure_jumps) const
  {
    extend(g, forces, pressure_jumps);
    if (!jumps_->are_none())
      jumps_->complete(forces);
  }


  void
  Coupling::extend_change(const FluidBlockVector &change, const ShellFields &g, ExtendedForces &forces, const std::vector<double> &pressure_jumps) const
  {
    extend(g, forces, pressure_jumps);
    if (jumps_->are_none() || contrast_.ratio == 1.)
      return;
    interpolation_->gradients(change, moments_);
    jumps_->add_viscous_change(moments_, forces);
  }


  void
  Coupling::update_viscous_forces(const FluidBlockVector &fields, const ShellFields &g)
  {
    if (jumps_->are_none() || contrast_.ratio == 1.)
      return;
    ExtendedForces forces;
    extend_whole(g, forces);
    interpolation_->gradients(fields, moments_);
    interpolation_->laplacians(fields, values_);
    const dealii::Tensor<1, 3> undisturbed_laplacian = contrast_.flow.laplacian();
    for (std::size_t i = 0; i < values_.size(); ++i)
      values_[i] += undisturbed_laplacian[i % 3];
    for (const ShellTransfer &transfer : transfers_)
      {
        const VelocityGradients undisturbed = transfer.gradients(contrast_.flow, transfer.shell());
        for (Eigen::Index i = 0; i < undisturbed.size(); ++i)
          moments_[9 * std::size_t(transfer.range().begin) + i] += undisturbed.data()[i];
      }
    // The contribution changes the gradients itself, a little: it is made to agree with itself.
    constexpr unsigned int n_repetitions = 3;
    for (unsigned int i = 0; i < n_repetitions; ++i)
      {
        if (i > 0)
          {
            jumps_->extend(forces);
            jumps_->complete(forces);
          }
        jumps_->update_viscous_forces(moments_, values_, forces);
      }
  }


  double
  Coupling::undisturbed_work(const ShellFields &g) const
  {
    if (jumps_->are_none() || contrast_.ratio == 1.)
      return 0.;
    ExtendedForces forces;
    extend_whole(g, forces);
    return jumps_->undisturbed_work(forces);
  }


  ShellFields
  Coupling::velocity_moments(const FluidBlockVector &fields) const
  {
    return all_moments(fields, nullptr);
  }


  ShellFields
  Coupling::velocity_moments(const FluidBlockVector &fields, const ExtendedForces &f) const
  {
    return all_moments(fields, &f);
  }


  ShellFields
  Coupling::all_moments(const FluidBlockVector &fields, const ExtendedForces *const f) const
  {
    interpolation_->values(fields, values_);
    if (jumps_->are_none())
      return sum_moments(values_);

    further_values_.assign(values_.size(), 0.);
    jumps_->add_velocities(fields, f, further_values_);
    // The transpose of P takes the multiple of v away that makes the further moments orthogonal to m = M^{-1} v.
    std::vector<double> flux(transfers_.size(), 0.);
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      for (std::size_t i = 3 * std::size_t(transfers_[p].range().begin); i < 3 * std::size_t(transfers_[p].range().end); ++i)
        {
          flux[p] += normal_forces_[i] * further_values_[i];
          values_[i] += further_values_[i];
        }
    ShellFields result = sum_moments(values_, &flux);
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] -= flux[guests_.place_of_own(i)] / shells_[i]->normal_square() * shells_[i]->volume_gradient();
    return result;
  }


  ShellFields
  Coupling::interpolate(const FluidBlockVector &fields) const
  {
    return density(velocity_moments(fields));
  }


  ShellFields
  Coupling::interpolate(const FluidBlockVector &fields, const ShellFields &f) const
  {
    ExtendedForces forces;
    extend(density(f), forces);
    return interpolate(fields, forces);
  }


  ShellFields
  Coupling::interpolate(const FluidBlockVector &fields, const ExtendedForces &f) const
  {
    return density(velocity_moments(fields, f));
  }


  ShellFields
  Coupling::undisturbed_velocity(const UndisturbedFlow &flow, const ShellConfigurations &shells) const
  {
    Eigen::Matrix3d    gradient;
    Eigen::RowVector3d constant;
    for (unsigned int c = 0; c < 3; ++c)
      {
        constant[c] = flow.constant[c];
        for (unsigned int d = 0; d < 3; ++d)
          gradient(c, d) = flow.linear[c][d];
      }
    ShellFields result;
    for (const auto &shell : shells)
      result.push_back((shell->x() * gradient.transpose()).rowwise() + constant);
    if (flow.quadratic.norm_square() == 0.)
      return result;
    values_.assign(3 * interpolation_->local_points().size(), 0.);
    const ShellConfigurations present = present_shells(shells, guests_, {});
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      transfers_[p].add_quadratic_velocity(flow, *present[p], values_);
    const ShellFields quadratic = density(sum_moments(values_));
    for (unsigned int i = 0; i < shells.size(); ++i)
      result[i] += quadratic[i];
    return result;
  }


  void
  Coupling::carry_pressure(const ShellFields &f, VertexSides &sides, FluidBlockVector &fields) const
  {
    if (jumps_->are_none() || !moved_)
      return;
    ExtendedForces forces;
    extend_whole(density(f), forces);
    jumps_->carry_pressure(forces, sides, fields);
  }


  ShellFields
  Coupling::density(const ShellFields &f) const
  {
    ShellFields result;
    for (unsigned int i = 0; i < f.size(); ++i)
      result.push_back(layout_.capsule(i).density(f[i]));
    return result;
  }


  void
  Coupling::spread_plainly(const ShellFields &g, FluidBlockVector &load) const
  {
    set_point_forces(g, values_);
    interpolation_->add_load(values_, {}, load);
  }


  void
  Coupling::spread(const ShellFields &f, FluidBlockVector &load) const
  {
    ExtendedForces forces;
    extend(density(f), forces);
    spread(1., forces, load);
  }


  void
  Coupling::spread(const double factor, const ExtendedForces &f, FluidBlockVector &load) const
  {
    values_.resize(f.at_points.size());
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      {
        const double normal_part = f.normal_parts[p] + f.pressure_jumps[p];
        for (std::size_t i = 3 * std::size_t(transfers_[p].range().begin); i < 3 * std::size_t(transfers_[p].range().end); ++i)
          values_[i] = factor * (f.at_points[i] + normal_part * normal_forces_[i]);
      }
    interpolation_->add_load(values_, {}, load);
    jumps_->add_load(f, factor, load);
  }


  void
  Coupling::spread_with_motion(const ShellFields &g, const ShellFields &dx, const ShellFields &g0, FluidBlockVector &load) const
  {
    if (!knows_motion())
      throw std::logic_error("The enriched interface does not know how its load changes when the points move.");
    const std::size_t n = interpolation_->local_points().size();
    values_.resize(3 * n);
    moments_.resize(9 * n);
    const ShellFields &g_present = at_guests(g, fields_), &dx_present = at_guests(dx, motions_), &g0_present = at_guests(g0, loads_);
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      transfers_[p].set_point_moments(g_present[p], g0_present[p], dx_present[p], values_, moments_);
    interpolation_->add_load(values_, moments_, load);
  }


  std::vector<SparseMatrix>
  Coupling::gradient_matrices(const ShellConfigurations &shells, const UndisturbedFlow &flow, const FluidBlockVector *const u) const
  {
    if (u != nullptr)
      interpolation_->gradients(*u, moments_);
    const ShellConfigurations       present = present_shells(shells, guests_, {});
    std::vector<SparseMatrix>       matrices;
    std::vector<ShellGuests::Block> blocks;
    for (unsigned int p = 0; p < transfers_.size(); ++p)
      {
        const ShellTransfer  &transfer  = transfers_[p];
        VelocityGradients     gradients = transfer.gradients(flow, *present[p]);
        const Eigen::Matrix3d G         = gradient_at_middle(flow, present[p]->x());
        if (u != nullptr)
          gradients += transfer.gradients(moments_);
        for (unsigned int component = 0; component < 9; ++component)
          gradients.col(component).array() -= G(component / 3, component % 3);
        matrices.push_back(transfer.capsule().coupling_surface().pattern().block_matrix());
        transfer.add_gradient_matrix(gradients, matrices.back());
      }
    for (SparseMatrix &matrix : matrices)
      blocks.push_back({matrix.valuePtr(), std::size_t(matrix.nonZeros())});
    guests_.sum(blocks);
    std::vector<SparseMatrix> result;
    for (unsigned int i = 0; i < shells.size(); ++i)
      result.push_back(std::move(matrices[guests_.place_of_own(i)]));
    return result;
  }
} // namespace tanktread
