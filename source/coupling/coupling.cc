// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of the fluid's velocity to the shells and spreading of the shells' forces to the fluid, each the other's adjoint.

#include <deal.II/base/mpi.h>

#include <tanktread/coupling/coupling.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace tanktread
{
  Coupling::Coupling(const Capsule &capsule, const unsigned int n_capsules, const Interface interface)
    : capsule_(capsule)
    , interface_(interface)
  {
    if (interface == Interface::enriched && capsule.coupling_surface().derivatives() != Derivatives::second)
      throw std::logic_error("The enriched interface needs second derivatives of the coupling's surface.");
    for (unsigned int c = 0; c < n_capsules; ++c)
      transfers_.emplace_back(capsule, c * capsule.coupling_surface().n_points());
  }


  void
  Coupling::attach(const TaylorHoodSpace &space)
  {
    space_         = &space;
    interpolation_ = std::make_unique<PointInterpolation>(space);
    jumps_         = std::make_unique<ShellJumps>(space, contrast_, interface_ == Interface::enriched ? n_capsules() : 0);
    moved_         = false;
  }


  std::vector<dealii::Point<3>>
  Coupling::points(const ShellConfigurations &shells) const
  {
    std::vector<dealii::Point<3>> result;
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].append_points(*shells[c], result);
    return result;
  }


  void
  Coupling::move(const ShellConfigurations &shells)
  {
    points_.clear();
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].append_points(*shells[c], points_);
    moved_ = false;
    interpolation_->reinit(points_);
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].move(shells[c], *interpolation_);
    normal_forces_.resize(3 * interpolation_->local_points().size());
    for (const ShellTransfer &transfer : transfers_)
      transfer.set_point_forces(transfer.shell().normal_field(), normal_forces_);
    std::vector<unsigned int> numbers(n_capsules());
    std::vector<ShellBox>     boxes;
    std::iota(numbers.begin(), numbers.end(), 0);
    for (const auto &shell : shells)
      boxes.push_back(shell_box(shell->points()));
    jumps_->move(transfers_, numbers, boxes, *interpolation_);
    moved_ = true;
  }


  double
  Coupling::distance(const ShellConfigurations &shells) const
  {
    if (!moved_)
      return std::numeric_limits<double>::infinity();
    double result = 0.;
    for (unsigned int c = 0; c < n_capsules(); ++c)
      if (shells[c] != transfers_[c].shell_pointer())
        result = std::max(result, (shells[c]->x() - transfers_[c].shell().x()).rowwise().norm().maxCoeff());
    return result;
  }


  Viscosity
  Coupling::viscosity(const ShellConfigurations &shells) const
  {
    return ShellViscosity(*space_)(shells, contrast_.ratio);
  }


  void
  Coupling::set_point_forces(const ShellFields &g, std::vector<double> &forces) const
  {
    forces.resize(3 * interpolation_->local_points().size());
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].set_point_forces(g[c], forces);
  }


  void
  Coupling::extend(const ShellFields &g, ExtendedForces &forces) const
  {
    set_point_forces(g, forces.at_points);
    forces.normal_parts.assign(n_capsules(), 0.);
    if (jumps_->are_none())
      return;
    for (unsigned int c = 0; c < n_capsules(); ++c)
      {
        const ShellConfiguration &shell = transfers_[c].shell();
        forces.normal_parts[c]          = shell.volume_gradient().cwiseProduct(g[c]).sum() / shell.normal_square(); // m . f = v . g
        for (std::size_t i = 3 * std::size_t(transfers_[c].range().begin); i < 3 * std::size_t(transfers_[c].range().end); ++i)
          forces.at_points[i] -= forces.normal_parts[c] * normal_forces_[i];
      }
    jumps_->extend(forces);
  }


  void
  Coupling::extend_whole(const ShellFields &g, ExtendedForces &forces) const
  {
    extend(g, forces);
    if (!jumps_->are_none())
      jumps_->complete(forces);
  }


  void
  Coupling::extend_change(const FluidBlockVector &change, const ShellFields &g, ExtendedForces &forces) const
  {
    extend(g, forces);
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
    std::vector<double> flux(n_capsules(), 0.);
    for (unsigned int c = 0; c < n_capsules(); ++c)
      for (std::size_t i = 3 * std::size_t(transfers_[c].range().begin); i < 3 * std::size_t(transfers_[c].range().end); ++i)
        {
          flux[c] += normal_forces_[i] * further_values_[i];
          values_[i] += further_values_[i];
        }
    MPI_Allreduce(MPI_IN_PLACE, flux.data(), int(flux.size()), MPI_DOUBLE, MPI_SUM, space_->mesh.communicator());
    ShellFields result = sum_moments(values_);
    for (unsigned int c = 0; c < n_capsules(); ++c)
      result[c] -= flux[c] / transfers_[c].shell().normal_square() * transfers_[c].shell().volume_gradient();
    return result;
  }


  ShellFields
  Coupling::sum_moments(const std::vector<double> &values) const
  {
    const Eigen::Index n = capsule_.n_control_points();
    sums_.assign(3 * std::size_t(n) * n_capsules(), 0.);
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].add_moments(values, &sums_[3 * std::size_t(n) * c]);
    MPI_Allreduce(MPI_IN_PLACE, sums_.data(), int(sums_.size()), MPI_DOUBLE, MPI_SUM, space_->mesh.communicator());
    ShellFields result;
    for (unsigned int c = 0; c < n_capsules(); ++c)
      result.push_back(Eigen::Map<const ControlPoints>(&sums_[3 * std::size_t(n) * c], n, 3));
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
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].add_quadratic_velocity(flow, *shells[c], values_);
    const ShellFields quadratic = density(sum_moments(values_));
    for (unsigned int c = 0; c < n_capsules(); ++c)
      result[c] += quadratic[c];
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


  std::vector<VelocityGradients>
  Coupling::velocity_gradients(const FluidBlockVector &u) const
  {
    interpolation_->gradients(u, moments_);
    std::vector<VelocityGradients> result;
    for (const ShellTransfer &transfer : transfers_)
      result.push_back(transfer.gradients(moments_));
    return result;
  }


  ShellFields
  Coupling::density(const ShellFields &f) const
  {
    ShellFields result;
    for (const ControlPoints &field : f)
      result.push_back(capsule_.density(field));
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
    spread(1., forces, std::vector<double>(n_capsules(), 0.), load);
  }


  void
  Coupling::spread(const double factor, const ExtendedForces &f, const std::vector<double> &pressure_jumps, FluidBlockVector &load) const
  {
    values_.resize(f.at_points.size());
    for (unsigned int c = 0; c < n_capsules(); ++c)
      {
        const double normal_part = f.normal_parts[c] + pressure_jumps[c];
        for (std::size_t i = 3 * std::size_t(transfers_[c].range().begin); i < 3 * std::size_t(transfers_[c].range().end); ++i)
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
    for (unsigned int c = 0; c < n_capsules(); ++c)
      transfers_[c].set_point_moments(g[c], g0[c], dx[c], values_, moments_);
    interpolation_->add_load(values_, moments_, load);
  }


  void
  Coupling::gradient_matrix(const unsigned int c, const VelocityGradients &gradients, SparseMatrix &result) const
  {
    const AssemblyPattern &pattern = capsule_.coupling_surface().pattern();
    if (result.nonZeros() == pattern.n_block_entries())
      result.coeffs().setZero();
    else
      result = pattern.block_matrix();
    transfers_[c].add_gradient_matrix(gradients, result);
    MPI_Allreduce(MPI_IN_PLACE, result.valuePtr(), int(result.nonZeros()), MPI_DOUBLE, MPI_SUM, space_->mesh.communicator());
  }


  TriangleQuadrature
  coupling_quadrature(const TriangleMesh &topology, const ControlPoints &x, const Interface interface, const double h)
  {
    const SubdivisionSurface surface(topology, triangle_quadrature(1), Derivatives::first);
    const double             spacing = interface == Interface::enriched ? 0.3 * h : 0.5 * h;
    const double             wanted  = area_weights(surface, x).maxCoeff() / (spacing * spacing);
    unsigned int             n = 0, n_per_triangle = 3;
    for (unsigned int n_points = 3; n_points < wanted; n_points *= 2)
      {
        n += n_per_triangle == 6;
        n_per_triangle = 9 - n_per_triangle;
      }
    return triangle_quadrature(n_per_triangle, n);
  }


  CapsuleQuadrature
  capsule_quadrature(const FittedShape &shape, const unsigned int mechanics, const Interface interface, const double h, const double viscosity_ratio)
  {
    return {triangle_quadrature(mechanics),
            coupling_quadrature(shape.topology, shape.control_points, interface, h),
            interface == Interface::enriched || viscosity_ratio != 1. ? Derivatives::second : Derivatives::first};
  }
} // namespace tanktread
