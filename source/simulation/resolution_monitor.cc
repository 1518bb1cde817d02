// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: measures in each step how well a run is resolved, and warns.

#include <deal.II/base/mpi.h>

#include <tanktread/simulation/resolution_monitor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tanktread
{
  namespace
  {
    ConcernFigures
    unknown_figures()
    {
      ConcernFigures result;
      result.fill(std::numeric_limits<double>::quiet_NaN());
      return result;
    }

    /** The largest of the capsules of all ranks; not a number where it is known of none. Collective. */
    double
    worst_of_all(const double of_own, const ShellLayout &layout)
    {
      const double result = layout.max(std::isnan(of_own) ? -std::numeric_limits<double>::max() : of_own);
      return result == -std::numeric_limits<double>::max() ? std::numeric_limits<double>::quiet_NaN() : result;
    }

    double &
    of(ConcernFigures &figures, const Concern concern)
    {
      return figures[static_cast<std::size_t>(concern)];
    }
  } // namespace


  ResolutionMonitor::ResolutionMonitor(const Parameters &parameters, Scene &scene, WarningMemory &memory, Log &log)
    : scene_(scene)
    , memory_(memory)
    , log_(log)
  {
    context_.control_points = std::numeric_limits<unsigned int>::max();
    for (unsigned int k = 0; k < scene.capsules().n_kinds(); ++k)
      {
        const Capsule &kind = scene.capsules().kind(k);
        mesh_qualities_.emplace_back(kind.topology());
        context_.initial_triangle = std::min(context_.initial_triangle, worst_triangle(kind.topology().faces, kind.initial()));
        context_.control_points   = std::min(context_.control_points, kind.n_control_points());
      }
    const FluidMesh &mesh = scene.fluid().mesh();
    context_.finest_cell  = mesh.cell_size(mesh.finest_level());
    context_.bends        = false;
    for (const KindParameters &kind : parameters.kinds)
      {
        const bool bends       = parameters.moduli(kind).bending_modulus > 0. || kind.shell.thickness > 0.;
        context_.bends         = context_.bends || bends;
        context_.moments_alone = context_.moments_alone || (bends && kind.shell.form == BendingForm::moment_only && !parameters.control_mesh_stays_even());
      }
    context_.is_explicit     = parameters.solver.coupling == TimeCoupling::explicit_euler;
    context_.order           = order(parameters.time.scheme);
    context_.step            = parameters.time.step;
    context_.steps_are_fixed = parameters.time.tolerance == 0.;
    context_.at_rest         = scene.description().liquids.flow.amplitude.is_zero();
    context_.two_viscosities = scene.description().liquids.viscosity_ratio != 1.;
  }


  void
  ResolutionMonitor::measure(const State &state, std::vector<CapsuleObservables> &capsules) const
  {
    const Timings::Scope                scope(scene_.timings(), "- resolution");
    const ShellConfigurations          &shells     = scene_.level().shells(state);
    const std::vector<InterfaceQuality> interfaces = interface_quality(scene_.coupling());
    for (std::size_t c = 0; c < capsules.size(); ++c)
      {
        capsules[c].shape     = mesh_qualities_[scene_.capsules().kind_of(scene_.layout().own()[c])](state.capsules[c].x);
        capsules[c].self_gap  = smallest_self_gap(*shells[c], scene_.level().finest_cell());
        capsules[c].interface = interfaces[c];
      }
  }


  void
  ResolutionMonitor::check(const State &state, const StepObservables &step, const std::vector<CapsuleObservables> &capsules)
  {
    const Timings::Scope scope(scene_.timings(), "- resolution");
    context_.finest_cell     = scene_.level().finest_cell(); // which may follow films
    ConcernFigures figures   = unknown_figures();
    double         left_over = 0., of_shells = 0.;
    for (const CapsuleObservables &o : capsules)
      {
        of(figures, Concern::triangle)      = std::fmin(of(figures, Concern::triangle), o.shape.worst_triangle);
        of(figures, Concern::curvature)     = std::fmin(of(figures, Concern::curvature), o.shape.smallest_radius);
        of(figures, Concern::wrinkles)      = std::fmax(of(figures, Concern::wrinkles), o.shape.detail_ratio);
        of(figures, Concern::without_jumps) = std::fmax(of(figures, Concern::without_jumps), o.interface.without_jumps);
        of(figures, Concern::folds)         = std::fmax(of(figures, Concern::folds), o.interface.folded);
        of(figures, Concern::self_gap)      = std::fmin(of(figures, Concern::self_gap), o.self_gap);
        left_over += std::abs(o.energy_residual);
        of_shells += std::abs(o.power);
      }
    const ShellLayout &layout = scene_.layout();
    for (const Concern least : {Concern::triangle, Concern::curvature, Concern::self_gap})
      of(figures, least) = -worst_of_all(-of(figures, least), layout);
    for (const Concern most : {Concern::wrinkles, Concern::without_jumps, Concern::folds})
      of(figures, most) = worst_of_all(of(figures, most), layout);
    left_over                 = layout.sum(left_over);
    const double power        = std::abs(step.dissipation) + layout.sum(of_shells);
    of(figures, Concern::gap) = scene_.gap(state).gap;
    if (dealii::Utilities::MPI::sum(scene_.coupling().jumps().pairs().n_cells(), scene_.communicator()) > 0)
      of(figures, Concern::shared_cells) = of(figures, Concern::gap) / context_.finest_cell;
    if (!scene_.description().liquids.unbounded) // there the faces are no walls
      of(figures, Concern::wall) = scene_.distance_from_faces(state);
    memory_.energy.add_step(step.step, left_over, power);
    of(figures, Concern::energy) = memory_.energy.defect();
    memory_.steps.add_step(step.step, step.local_error);
    of(figures, Concern::steps) = memory_.steps.sum;
    of(figures, Concern::rise)  = std::max(step.energy_rise, 0.); // or not a number
    if (const std::string text = warning_of_few_points(context_); step.step == 0. && !text.empty())
      log_.line(text);
    for (const std::string &text : update_warnings(memory_, step.time, figures, context_))
      log_.line(text);
  }


  void
  ResolutionMonitor::finish() const
  {
    for (const std::string &text : {warning_of_unknown_steps(memory_, context_), warnings_in_short(memory_, context_)})
      if (!text.empty())
        log_.line("\n" + text);
  }
} // namespace tanktread
