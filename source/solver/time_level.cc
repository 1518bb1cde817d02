// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the nonlinear system of a time level: what is wrong with a state, and what a state means.

#include <tanktread/base/mpi_errors.h>
#include <tanktread/solver/time_level.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    /**
     * Integral of 2 eps : eps of the undisturbed flow over the inside of a shell, by the divergence theorem for each degree of the polynomial about the shell's
     * middle.
     */
    double
    undisturbed_dissipation(const UndisturbedFlow &flow, const ShellConfiguration &shell)
    {
      const SubdivisionSurface  &surface = shell.capsule().surface();
      const Eigen::RowVector3d   centre  = shell.x().colwise().mean();
      const ControlPoints        X       = (surface.S() * shell.x()).rowwise() - centre;
      const ControlPoints        n       = normals(surface, shell.x());
      const Eigen::VectorXd      areas   = area_weights(surface, shell.x());
      const dealii::Tensor<2, 3> G       = flow.gradient({centre[0], centre[1], centre[2]});
      const dealii::Tensor<2, 3> twice_0 = G + transpose(G);
      double                     result  = 0.;
      for (Eigen::Index q = 0; q < X.rows(); ++q)
        {
          const dealii::Tensor<2, 3> H       = flow.quadratic * dealii::Tensor<1, 3>({X(q, 0), X(q, 1), X(q, 2)});
          const dealii::Tensor<2, 3> twice_1 = H + transpose(H);
          const double density = scalar_product(twice_0, twice_0) / 3. + 2. * scalar_product(twice_0, twice_1) / 4. + scalar_product(twice_1, twice_1) / 5.;
          result += 0.5 * density * areas[q] * X.row(q).dot(n.row(q));
        }
      return result;
    }


    /** Of the shells from such positions, infinite if there are none. Collective. */
    double
    distance(const State &state, const ShellFields &x, const ShellLayout &layout)
    {
      double result = x.empty() && !state.capsules.empty() ? std::numeric_limits<double>::infinity() : 0.;
      for (std::size_t c = 0; c < x.size(); ++c)
        result = std::max(result, (state.capsules[c].x - x[c]).rowwise().norm().maxCoeff());
      return layout.max(result);
    }
  } // namespace


  TimeLevel::TimeLevel(const Liquids &liquids, const DistributedShell &elasticity, Coupling &coupling, SolverMemory &memory, Timings &timings)
    : liquids_(liquids)
    , elasticity_(elasticity)
    , coupling_(coupling)
    , memory_(memory)
    , timings_(timings)
    , flow_(liquids.flow.at(0.))
  {
    coupling.set_viscosity_contrast({liquids.viscosity_ratio, flow_});
    if (has_viscosities() && liquids.flow.frequency != 0.)
      throw std::logic_error("TimeLevel: another viscosity inside is for steady flows.");
    if (has_inertia() && liquids.unbounded)
      throw std::logic_error("TimeLevel: inertia is not for unbounded liquid.");
  }


  void
  TimeLevel::attach(Fluid &fluid)
  {
    fluid_ = &fluid;
    coupling_.attach(fluid.space());
    memory_.viscosity_x.clear();
    preconditioner_x_.clear();
    if (has_inertia())
      inertia_ = std::make_unique<Inertia>(fluid.space(), liquids_.reynolds_number, flow_);
    if (liquids_.unbounded)
      unbounded_ = std::make_unique<UnboundedLiquid>(fluid.space(), coupling_.layout(), liquids_.viscosity_ratio);
  }


  void
  TimeLevel::reassign()
  {
    shells_.clear();
    memory_.viscosity_x.clear();
    preconditioner_x_.clear();
  }


  void
  TimeLevel::begin(const TimeStep &step)
  {
    flow_ = liquids_.flow.at(step.time);
    if (!inertia_)
      return;
    if (step.uhat == nullptr)
      throw std::logic_error("TimeLevel: a step with inertia needs uhat.");
    inertia_->set_flow(flow_);
    inertia_->begin_step(*step.uhat, step.tau);
    fluid_->set_shift(inertia_->mass());
  }


  void
  TimeLevel::begin_at_rest(const double time)
  {
    flow_ = liquids_.flow.at(time);
    fluid_->set_shift(0.);
  }


  const ShellConfigurations &
  TimeLevel::shells(const State &state)
  {
    shells_.resize(state.capsules.size());
    for (std::size_t c = 0; c < shells_.size(); ++c)
      if (const ControlPoints &x = state.capsules[c].x; !shells_[c] || &shells_[c]->capsule() != &coupling_.layout().capsule(c) || shells_[c]->x() != x)
        shells_[c] = std::make_shared<ShellConfiguration>(coupling_.layout().capsule(c), x);
    return shells_;
  }


  void
  TimeLevel::set_viscosity(const State &state)
  {
    if (!has_viscosities() || viscosity_distance(state) == 0.)
      return;
    const Timings::Scope scope(timings_, "Viscosity");
    memory_.viscosity_x           = positions(state);
    const bool for_preconditioner = distance(state, preconditioner_x_, coupling_.layout()) > 0.25 * finest_cell();
    if (for_preconditioner)
      preconditioner_x_ = memory_.viscosity_x;
    fluid_->set_viscosity(coupling_.viscosity(shells(state)), for_preconditioner);
    if (unbounded_)
      unbounded_->set_viscosity(*fluid_->viscosity());
    undisturbed_load_.reinit(fluid_->space().velocity->partitioner());
    fluid_->viscosity()->add_excess_stress(fluid_->space(), flow_, undisturbed_load_);
  }


  void
  TimeLevel::restore_viscosities(const ShellFields &preconditioner_x, const ShellFields &viscosity_x)
  {
    for (const ShellFields &x : {preconditioner_x, viscosity_x})
      {
        State there;
        for (const ControlPoints &of_shell : x)
          {
            there.capsules.emplace_back();
            there.capsules.back().x = of_shell;
          }
        if (coupling_.layout().max(double(x.size())) > 0.)
          set_viscosity(there);
      }
  }


  double
  TimeLevel::viscosity_distance(const State &state) const
  {
    return has_viscosities() ? distance(state, memory_.viscosity_x, coupling_.layout()) : 0.;
  }


  void
  TimeLevel::update_jumps(const State &state)
  {
    coupling_.update_viscous_forces(state.fluid, coupling_.density(forces(state)));
  }


  Residual
  TimeLevel::residual(State &state, const TimeStep &step, const Points points)
  {
    const Timings::Scope scope(timings_, "Residual");
    const double         tau = step.tau;
    Residual             r;
    r.capsules.resize(state.capsules.size());
    const ShellFields elastic = elasticity_.forces(positions(state));
    for (std::size_t c = 0; c < state.capsules.size(); ++c)
      r.capsules[c].force = state.capsules[c].force - elastic[c];
    const ShellConfigurations shells = this->shells(state);
    on_all_ranks(coupling_.layout().communicator(), [&] {
      for (std::size_t c = 0; c < shells.size(); ++c)
        {
          r.capsules[c].volume = shells[c]->volume() - shells[c]->capsule().volume();
          shells[c]->normal_field(); // computed here, where all ranks learn of shells that are degenerate
        }
    });
    if (points == Points::follow)
      move_points(state);

    std::vector<double> pressure_jumps;
    for (const CapsuleState &capsule : state.capsules)
      pressure_jumps.push_back(capsule.pressure_jump);
    ExtendedForces extended;
    coupling_.extend_whole(coupling_.density(forces(state)), extended, pressure_jumps);
    ShellFields       velocities  = coupling_.interpolate(state.fluid, extended);
    const ShellFields undisturbed = coupling_.undisturbed_velocity(flow_, shells);
    for (std::size_t c = 0; c < shells.size(); ++c)
      velocities[c] += undisturbed[c];
    fluid_->space().reinit(r.fluid);
    if (unbounded_)
      {
        unbounded_->set(state, shells, velocities);
        unbounded_->faces().vmult(r.fluid, state.fluid);
      }
    else
      fluid_->stokes().vmult(r.fluid, state.fluid);
    if (has_viscosities())
      r.fluid.block(velocity_block) += undisturbed_load_;
    if (inertia_ && tau > 0.)
      inertia_->add_residual(state.fluid, r.fluid);
    coupling_.spread(-1., extended, r.fluid);
    const ShellFields of_missing_loads = shell_velocity_of(r.fluid);
    for (std::size_t c = 0; c < shells.size(); ++c)
      {
        r.capsules[c].velocity = of_missing_loads[c];
        r.capsules[c].flux     = shells[c]->volume_gradient().cwiseProduct(velocities[c]).sum();
        r.capsules[c].x        = state.capsules[c].x - step.xhat[c] - tau * velocities[c] - state.capsules[c].volume_shift * shells[c]->normal_field();
      }
    return r;
  }


  void
  TimeLevel::move_points(State &state)
  {
    coupling_.move(shells(state));
    carry_pressure(state);
  }


  void
  TimeLevel::carry_pressure(State &state) const
  {
    coupling_.carry_pressure(forces(state), state.sides, state.fluid);
  }


  ShellFields
  TimeLevel::shell_velocity(const State &state)
  {
    ExtendedForces extended;
    coupling_.extend_whole(coupling_.density(forces(state)), extended);
    ShellFields       result      = coupling_.interpolate(state.fluid, extended);
    const ShellFields undisturbed = coupling_.undisturbed_velocity(flow_, shells(state));
    for (std::size_t c = 0; c < result.size(); ++c)
      result[c] += undisturbed[c];
    return result;
  }


  FluidBlockVector
  TimeLevel::whole_fields(const State &state)
  {
    if (!unbounded_)
      return state.fluid;
    FluidBlockVector result;
    whole_space().reinit(result);
    unbounded_->set(state, shells(state), shell_velocity(state));
    unbounded_->faces().extend(state.fluid, result);
    return result;
  }


  ShellFields
  TimeLevel::shell_velocity_of(const FluidBlockVector &load) const
  {
    FluidBlockVector flow;
    fluid_->space().reinit(flow);
    fluid_->preconditioner().vmult(flow, load);
    return coupling_.interpolate(flow);
  }


  FluidBlockVector
  TimeLevel::loads(const State &state)
  {
    FluidBlockVector result;
    fluid_->space().reinit(result);
    coupling_.spread(forces(state), result);
    ShellFields pressures;
    for (const auto &shell : shells(state))
      pressures.push_back(shell->volume_gradient());
    coupling_.spread(pressures, result);
    if (has_viscosities())
      result.block(velocity_block) += undisturbed_load_;
    return result;
  }


  void
  TimeLevel::set_forces(State &state) const
  {
    const ShellFields f = elasticity_.forces(positions(state));
    for (std::size_t c = 0; c < f.size(); ++c)
      state.capsules[c].force = f[c];
  }


  double
  TimeLevel::dissipation(const State &state)
  {
    ExtendedForces    extended;
    const ShellFields F = forces(state);
    const ShellFields g = coupling_.density(F);
    coupling_.extend_whole(g, extended);
    const ShellFields disturbance = coupling_.interpolate(state.fluid, extended);
    double            of_shells   = 0.;
    for (std::size_t c = 0; c < F.size(); ++c)
      of_shells += F[c].cwiseProduct(disturbance[c]).sum();
    if (has_viscosities())
      for (const auto &shell : shells(state))
        of_shells += (liquids_.viscosity_ratio - 1.) * undisturbed_dissipation(flow_, *shell);
    double result = coupling_.layout().sum(of_shells) - inertial_power(state);
    if (has_viscosities())
      result += undisturbed_load_ * state.fluid.block(velocity_block) + coupling_.undisturbed_work(g);
    return result;
  }


  double
  TimeLevel::inertial_power(const State &state) const
  {
    return inertia_ && inertia_->mass() > 0. ? inertia_->power(state.fluid) : 0.;
  }
} // namespace tanktread
