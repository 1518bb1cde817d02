// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run observes, remembers and writes.

#include <deal.II/base/mpi.h>

#include <tanktread/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tanktread
{
  void
  Simulation::remember(std::vector<CapsuleObservables> &capsules)
  {
    // Control points that move along the shell do discrete work of their own.
    const bool points_stay = !parameters_.control_mesh_stays_even();
    for (std::size_t c = 0; c < capsules.size(); ++c)
      {
        CapsuleObservables  &o = capsules[c];
        const ControlPoints &x = state_.capsules[c].x;
        if (memory_.capsules.size() == c)
          memory_.capsules.push_back({PhaseAngles(scene_.capsule(c).topology(), x, o.ellipsoid, o.theta_over_pi), {}, {}});
        const bool     has_energy = points_stay && scene_.description().kind(scene_.layout().own()[c]).has_energy();
        CapsuleMemory &memory     = memory_.capsules[c];
        memory.ellipsoid          = o.ellipsoid;
        memory.phase.update(x, o.ellipsoid, o.theta_over_pi);
        o.alpha            = memory.phase.alpha();
        o.delta            = memory.phase.delta();
        o.theta_continuous = memory.phase.theta();
        memory.motion.push_back({memory_.time,
                                 o.ellipsoid.taylor_parameter,
                                 o.theta_continuous,
                                 o.alpha,
                                 o.delta,
                                 o.ellipsoid.L,
                                 o.ellipsoid.B,
                                 o.ellipsoid.W,
                                 o.rheology.intrinsic_viscosity,
                                 o.rheology.normal_difference_1,
                                 o.rheology.normal_difference_2,
                                 has_energy ? o.energy.membrane + o.energy.bending : MotionSample::unknown,
                                 o.power});
        o.energy_residual = last_energy_residual(memory.motion);
      }
  }


  void
  Simulation::log_step(const StepObservables &step, const Results::History &history)
  {
    const Row         columns = history_row({}, {});
    const std::size_t n       = columns.size();
    const auto        of      = [&](const std::string &name, const std::size_t c) {
      const auto column = std::find_if(columns.begin(), columns.end(), [&](const auto &entry) { return entry.first == name; });
      return history[n * c + (column - columns.begin())];
    };
    double volume_error = 0.;
    for (std::size_t c = 0; c < scene_.capsules().size(); ++c)
      if (const double error = of("volume_error", c); !(std::abs(error) <= std::abs(volume_error)))
        volume_error = error;
    const double remaining = memory_.n_steps == 0 ? -1. : step.wall_time * (parameters_.scene.end_time - memory_.time) / memory_.time;
    log_.step({memory_.n_steps, step.time, step.step, step.newton_iterations, step.linear_iterations, of("D_xz", 0), of("theta", 0), volume_error, remaining});
  }


  Simulation::Observed
  Simulation::observe_capsules()
  {
    const Timings::Scope scope(scene_.timings(), "Output");
    Observed             result;
    result.velocities = scene_.level().shell_velocity(state_);
    result.capsules   = observe(scene_, state_, result.velocities);
    remember(result.capsules);
    resolution_.measure(state_, result.capsules);
    return result;
  }


  void
  Simulation::record(const StepResult &step, const Observed &observed, const bool last)
  {
    const Timings::Scope                   scope(scene_.timings(), "Output");
    const std::vector<CapsuleObservables> &capsules = observed.capsules;
    StepObservables                        o;
    o.time                         = memory_.time;
    o.step                         = step.length;
    o.dissipation                  = scene_.level().dissipation(state_);
    o.local_error                  = step.local_error;
    o.energy_rise                  = step.energy_rise;
    o.newton_iterations            = step.newton_iterations;
    o.linear_iterations            = step.linear_iterations;
    o.n_cells                      = scene_.fluid().mesh().triangulation().n_global_active_cells();
    o.wall_time                    = scene_.timings().elapsed();
    const Results::History history = Results::history(scene_.layout(), o, capsules);
    if (is_due(memory_.next_history, parameters_.output.history_interval) || last)
      results_->add_history(o, history, observe_suspension(scene_, state_, capsules));
    const double interval = parameters_.output.field_interval;
    const bool   fields   = memory_.n_steps == 0 || last || (interval > 0. && is_due(memory_.next_fields, interval));
    add_contours(step.length, fields);
    if (fields)
      results_->add_fields(memory_.time, scene_, state_, observed.velocities);
    log_step(o, history);
    resolution_.check(state_, o, capsules);
  }


  void
  Simulation::add_contours(const double length, const bool but_now)
  {
    for (const double time : parameters_.output.contour_times)
      if (time > memory_.time - length + rounding() && time <= memory_.time + rounding() && !(but_now && time > memory_.time - rounding()))
        results_->add_contours(time, stepper_.position(time));
  }


  void
  Simulation::summarise(const std::string &outcome)
  {
    std::vector<MotionSummary>                        summaries;
    std::vector<std::pair<unsigned int, std::string>> texts;
    for (std::size_t i = 0; i < memory_.capsules.size(); ++i)
      {
        summaries.push_back(motion_summary(memory_.capsules[i].motion, outcome == "steady"));
        if (scene_.layout().leads())
          texts.emplace_back(scene_.layout().own()[i], motion_text(summaries.back()));
      }
    std::map<unsigned int, std::string> in_order;
    for (const auto &of_rank : dealii::Utilities::MPI::gather(communicator_, texts))
      in_order.insert(of_rank.begin(), of_rank.end());
    for (const auto &[c, text] : in_order)
      log_.line("\n" + (scene_.capsules().size() > 1 ? "Capsule " + std::to_string(c + 1) + ". " : "") + text);
    resolution_.finish();
    results_->write_summary(outcome, summaries, worst_figures(memory_.warnings));
  }
} // namespace tanktread
