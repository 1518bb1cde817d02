// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Accuracy", which chooses the numerical parameters for a wanted error.

#include <deal.II/base/parameter_handler.h>

#include <Eigen/Eigenvalues>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/number_text.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/simulation/accuracy.h>
#include <tanktread/simulation/parameters.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    // Parts of the target that each cause may have.
    constexpr double of_cells = 0.45, of_steps = 0.3, of_newton = 0.2, of_stop = 0.5, of_control_mesh = 0.55;

    constexpr double hardly_larger = 1.1; // than wanted: a cell for which there is 60 % of the target

    // The model: doc/accuracy.md, "The dial". Errors are relative to the largest D; h in a.
    constexpr double cells_factor = 0.045, cells_order = 3.;                   // one viscosity
    constexpr double contrast_factor = 0.035, contrast_order = 2.;             // two, up to lambda = 5; more beyond
    constexpr double stiff_exponent          = 0.7;                            // of lambda/5
    constexpr double control_mesh_at_level_1 = 0.011, control_mesh_gain = 20.; // a level
    constexpr double steps_factor       = 1.2;                                 // error of D over Time/Tolerance
    constexpr double newton_factor      = 0.1;                                 // over Solver/Newton tolerance
    constexpr double ungraded_far_cells = 1e-4, graded_far_cells = 2e-5;       // cells away from the shell, Fluid mesh/Grading = 0 and 3
    constexpr double faces_factor = 8.;                                        // over (a/l)^3


    bool
    has_contrast(const Parameters &parameters)
    {
      return parameters.scene.viscosity_ratio != 1.;
    }


    /** How much longer a nearly spherical drop of that viscosity ratio takes to relax than one of ratio 1 (Taylor): so much longer errors of steps add up. */
    double
    memory_of_shape(const Parameters &parameters)
    {
      const auto time = [](const double ratio) { return (19. * ratio + 16.) * (2. * ratio + 3.) / (40. * (ratio + 1.)); };
      return std::clamp(time(parameters.scene.viscosity_ratio) / time(1.), 1., 4.);
    }


    double
    factor_of_contrast(const Parameters &parameters)
    {
      return contrast_factor * std::pow(std::max(1., parameters.scene.viscosity_ratio / 5.), stiff_exponent);
    }


    /** Radii of the smallest and of the largest capsules, in a. */
    std::pair<double, double>
    sizes(const Parameters &parameters)
    {
      const auto is_smaller    = [](const KindParameters &a, const KindParameters &b) { return a.shape.size < b.shape.size; };
      const auto [least, most] = std::minmax_element(parameters.kinds.begin(), parameters.kinds.end(), is_smaller);
      return {least->shape.size, most->shape.size};
    }


    /** Whether Shell mesh/Level is read for a kind. */
    bool
    has_level(const Parameters &parameters)
    {
      return std::any_of(parameters.kinds.begin(), parameters.kinds.end(), [](const KindParameters &kind) { return kind.shape.shape != Shape::file; });
    }


    double
    cells_error(const Parameters &parameters, double h)
    {
      h /= sizes(parameters).first; // what cells have to be measured by
      const double uniform = cells_factor * std::pow(h, cells_order);
      return has_contrast(parameters) ? std::max(uniform, factor_of_contrast(parameters) * std::pow(h, contrast_order)) : uniform;
    }


    /** How long an initial shape is along its principal axes, in a, the shortest first. */
    Eigen::Vector3d
    initial_lengths(const KindParameters &kind)
    {
      const FittedShape     shape  = make_capsule(kind.shape, 2);
      const ControlPoints   x      = shape.control_points.rowwise() - shape.control_points.colwise().mean();
      const Eigen::Matrix3d axes   = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Eigen::Matrix3d(x.transpose() * x)).eigenvectors();
      const ControlPoints   along  = x * axes;
      Eigen::Vector3d       result = (along.colwise().maxCoeff() - along.colwise().minCoeff()).transpose();
      std::sort(result.data(), result.data() + 3);
      return result;
    }


    double
    control_mesh_error(const Parameters &parameters, const int level)
    {
      double rim = 1.; // flat shapes are curved more sharply
      for (const KindParameters &kind : parameters.kinds)
        {
          if (kind.shape.shape == Shape::file)
            continue;
          const Eigen::Vector3d length = initial_lengths(kind);
          rim                          = std::max(rim, std::pow(length[2] / length[0] / 1.5, 2.));
        }
      return rim * control_mesh_at_level_1 * std::pow(control_mesh_gain, 1 - level);
    }


    /** Side of the finest cells that have their part of the target, to three digits. */
    double
    wanted_cell(const Parameters &parameters)
    {
      const double error = of_cells * parameters.accuracy.target_error;
      double       h     = std::pow(error / cells_factor, 1. / cells_order);
      if (has_contrast(parameters))
        h = std::min(h, std::pow(error / factor_of_contrast(parameters), 1. / contrast_order));
      h *= sizes(parameters).first;
      const double unit = std::pow(10., std::floor(std::log10(h)) - 2.);
      return unit * std::floor(h / unit);
    }


    /** Largest distance of the initial shape's points from its centre, in a. */
    double
    initial_radius(const Parameters &parameters)
    {
      const FittedShape shape = make_capsule(parameters.kinds[0].shape, 2);
      return std::sqrt(shape.control_points.rowwise().squaredNorm().maxCoeff());
    }


    /** A box and its cells. */
    struct Cells
    {
      double side, coarsest, finest;
    };


    /** The smallest box in unbounded liquid that leaves one capsule enough room: three to five coarsest cells, which are a power of two times h. */
    Cells
    unbounded_box(const Parameters &parameters, const double h)
    {
      const double target  = parameters.accuracy.target_error;
      const double radii   = target >= 0.005 ? 5.5 : target >= 0.0005 ? 6.5 : 7.5;
      const double D       = expected_deformation(parameters);
      const double stretch = std::sqrt((1. + D) / (1. - std::min(D, 0.7)));
      const double needed  = radii * std::max({1., 0.8 * initial_radius(parameters), 0.7 * stretch});
      Cells        best{1e300, 0., h};
      for (const double n : {3., 4., 5.})
        {
          double coarsest = h;
          while (n * coarsest < needed)
            coarsest *= 2.;
          if (n * coarsest < best.side)
            best = {n * coarsest, coarsest, h};
        }
      return best;
    }


    /** Finest cell of the octree that `coarsest` makes in the box of `parameters`: the largest one that is hardly larger than h. */
    double
    octree_cell(const Parameters &parameters, const double coarsest, const double h)
    {
      const Box         box      = parameters.scene.box();
      const BoxDivision division = divide(box, coarsest);
      double            size     = box.side[0] / (division.n_rung_0[0] << division.coarsest_level);
      while (size > hardly_larger * h)
        size /= 2.;
      return size;
    }


    /**
     * Cells for a box that is given, whose octree has a size near h: coarsest ones, unless they are given too, of 1.8 a to 3.6 a, or a power of two times that in
     * boxes eight times as large. Near the shell 2:1 balance makes them smaller.
     */
    Cells
    given_box(const Parameters &parameters, const double h, const bool coarsest_is_set)
    {
      const double side = parameters.scene.box().side[0];
      Cells        best{side, parameters.fluid_mesh.coarsest_cell, octree_cell(parameters, parameters.fluid_mesh.coarsest_cell, h)};
      if (coarsest_is_set)
        return best;
      const Box box     = parameters.scene.box();
      double    largest = 3.6;
      while (8. * largest <= *std::min_element(box.side.begin(), box.side.end()))
        largest *= 2.;
      for (double n = std::ceil(side / largest); n <= 2. * side / largest; ++n)
        try
          {
            FluidMeshParameters mesh = parameters.fluid_mesh;
            mesh.coarsest_cell       = side / n;
            mesh.finest_cell         = std::min(mesh.finest_cell, mesh.coarsest_cell);
            mesh.check(box);
            const double finest = octree_cell(parameters, side / n, h), gain = std::log2(finest / best.finest);
            if (gain > 1e-9 || (gain > -1e-9 && side / n > best.coarsest)) // of octrees with the same finest cell that with the largest ones
              best = {side, side / n, finest};
          }
        catch (const InputError &)
          {
            // cubes of that size do not fill the box
          }
      return best;
    }


    /** One capsule that nothing carries away from the origin. */
    bool
    stays_in_the_middle(const Parameters &parameters)
    {
      const std::vector<double> &frame = parameters.scene.frame_velocity;
      const PlacementParameters &list  = parameters.kinds[0].placement;
      return parameters.kinds.size() == 1 && list.placement == Placement::list && list.centres.size() == 1 && list.places()[0].centre.norm() < 1e-12 &&
        frame == std::vector<double>(3, 0.);
    }


    bool
    may_be_unbounded(const Parameters &parameters, const ParameterSource &source)
    {
      for (const char *const name : {"Box side", "Box faces", "Channel half width"})
        if (source.is_set(std::string("Scene/") + name))
          return false;
      if (source.is_set("Scene/Boundary") && parameters.scene.boundary == Boundary::faces)
        return false;
      const SceneParameters &scene = parameters.scene;
      return scene.reynolds_number == 0. && scene.flow != Flow::plane_poiseuille && stays_in_the_middle(parameters);
    }


    /** Local error of the scheme per error of D, over that of BDF3, as measured for BDF2; infinite where the dial knows nothing of the steps. */
    double
    factor_of_scheme(const Parameters &parameters)
    {
      if (parameters.solver.coupling == TimeCoupling::explicit_euler || order(parameters.time.scheme) == 1)
        return std::numeric_limits<double>::infinity();
      return order(parameters.time.scheme) == 2 ? 4. : 1.;
    }
  } // namespace


  void
  AccuracyParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Accuracy");
    prm.add_parameter(
      "Target error",
      target_error,
      "Wanted error of D, relative to its largest value, and of theta/pi: parameters of mesh, box, time and solver that are not set are chosen for it. The log "
      "says which, and what each is expected to add to the error. 0: defaults.",
      dealii::Patterns::Double(0., 0.1));
    prm.leave_subsection();
  }


  void
  AccuracyParameters::check() const
  {
    if (target_error > 0. && target_error < 1e-6)
      {
        std::ostringstream message;
        message << "Accuracy/Target error is " << target_error << "; allowed: 0, or 1e-6 to 0.1";
        throw InputError(message.str());
      }
  }


  double
  expected_deformation(const Parameters &parameters)
  {
    double result = parameters.scene.flow == Flow::quiescent ? 0.02 : 0.005;
    for (const KindParameters &kind : parameters.kinds)
      {
        const Eigen::Vector3d length = initial_lengths(kind);
        result                       = std::max(result, (length[2] - length[0]) / (length[2] + length[0]));
        if (parameters.scene.flow == Flow::quiescent)
          continue;
        // Neo-Hookean sphere, flat reference, Ca = 3 G: D = (25/12) Ca / (1 + 33 khat), with its own radius.
        const ShellModuli moduli = parameters.moduli(kind);
        const double      R = kind.shape.size, G = R / moduli.surface_young_modulus, khat = moduli.bending_modulus / (moduli.surface_young_modulus * R * R);
        const double      small = 6.25 * G / (1. + 33. * khat);
        result                  = std::max(result, small / (1. + small));
      }
    return result;
  }


  std::vector<Choice>
  accuracy_choices(const Parameters &parameters, const ParameterSource &source)
  {
    const double        target = parameters.accuracy.target_error;
    std::vector<Choice> result;
    if (target == 0.)
      return result;
    const auto choose = [&](const std::string &section, const std::string &name, const std::string &value) {
      if (!source.is_set(section + "/" + name))
        result.push_back({section, name, value});
    };

    const bool   finest_is_set = source.is_set("Fluid mesh/Finest cell"), coarsest_is_set = source.is_set("Fluid mesh/Coarsest cell");
    const double h = finest_is_set ? parameters.fluid_mesh.finest_cell : wanted_cell(parameters);
    if (may_be_unbounded(parameters, source) && !coarsest_is_set)
      {
        const Cells cells = unbounded_box(parameters, h);
        choose("Scene", "Boundary", "unbounded");
        choose("Scene", "Box side", number_text(cells.side));
        choose("Fluid mesh", "Coarsest cell", number_text(cells.coarsest));
        choose("Fluid mesh", "Finest cell", number_text(1.0001 * h));
      }
    else if (!finest_is_set)
      {
        const Cells cells = given_box(parameters, h, coarsest_is_set);
        choose("Fluid mesh", "Coarsest cell", number_text(cells.coarsest));
        choose("Fluid mesh", "Finest cell", number_text(std::min(1.0001 * cells.finest, cells.coarsest)));
      }
    if (ungraded_far_cells > 0.5 * of_cells * target)
      choose("Fluid mesh", "Grading", "3");
    if (has_level(parameters))
      {
        // Where a membrane without bending stiffness is compressed it wrinkles, on a finer control mesh the more.
        const int finest = parameters.bends() ? 5 : 2;
        int       level  = 1;
        while (control_mesh_error(parameters, level) > of_control_mesh * target && level < finest)
          ++level;
        choose("Shell mesh", "Level", std::to_string(level));
      }

    const double D = expected_deformation(parameters);
    if (!source.is_set("Time/Step") && std::isfinite(factor_of_scheme(parameters)))
      {
        choose("Time", "Step", "1");
        choose("Time",
               "Tolerance",
               number_text(of_steps * target * D * sizes(parameters).first / (steps_factor * factor_of_scheme(parameters) * memory_of_shape(parameters))));
      }
    if (!source.is_set("Time/Steady tolerance") && parameters.scene.oscillation_frequency == 0. && stays_in_the_middle(parameters))
      choose("Time", "Limit tolerance", number_text(of_stop * target));
    const double newton = std::clamp(of_newton * target * D * sizes(parameters).first / (newton_factor * memory_of_shape(parameters)), 1e-7, 1e-2);
    choose("Solver", "Newton tolerance", number_text(newton));
    choose("Solver", "Volume tolerance", number_text(std::min(1e-3, 0.01 * newton)));
    return result;
  }


  std::vector<ErrorShare>
  expected_errors(const Parameters &parameters)
  {
    const double            D = expected_deformation(parameters), h = parameters.fluid_mesh.finest_cell;
    std::vector<ErrorShare> result;
    if (parameters.solver.interface == Interface::enriched)
      {
        const double order = cells_error(parameters, h) > cells_factor * std::pow(h / sizes(parameters).first, cells_order) ? contrast_order : cells_order;
        result.push_back({"cells", cells_error(parameters, h), std::pow(2., 2.3 / order)});
      }
    result.push_back({"cells away from the shell", parameters.fluid_mesh.grading < 3 ? ungraded_far_cells : graded_far_cells, 1.2});
    if (has_level(parameters))
      result.push_back({"control mesh", control_mesh_error(parameters, parameters.shell_mesh.level), 1.2});
    if (parameters.time.tolerance > 0. && std::isfinite(factor_of_scheme(parameters)))
      result.push_back({"steps",
                        steps_factor * factor_of_scheme(parameters) * memory_of_shape(parameters) * parameters.time.tolerance / (D * sizes(parameters).first),
                        std::pow(2., 1. / order(parameters.time.scheme))});
    result.push_back(
      {"Newton tolerance", newton_factor * memory_of_shape(parameters) * parameters.solver.newton_tolerance / (D * sizes(parameters).first), 1.05});
    if (parameters.scene.boundary == Boundary::faces)
      {
        const double side = *std::min_element(parameters.scene.box_side.begin(), parameters.scene.box_side.end());
        result.push_back({"box (against unbounded liquid)", faces_factor * std::pow(sizes(parameters).second / side, 3.), 1.2});
      }
    if (parameters.time.limit_tolerance > 0.)
      result.push_back({"stop", parameters.time.limit_tolerance, 1.05});
    return result;
  }
} // namespace tanktread
