// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: all parameters of a run, and reading them.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_folder.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/base/parameter_table.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/random_places.h>
#include <tanktread/simulation/scene_description.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace tanktread
{
  namespace
  {
    /** Reads the mesh file, if there is one, and throws InputError unless it is a closed surface. */
    void
    check_mesh_file(const CapsuleShapeParameters &capsule)
    {
      if (capsule.shape != Shape::file || capsule.file.empty())
        return;
      try
        {
          check_closed_surface(read_triangle_mesh(capsule.file), "Mesh file '" + capsule.file + "'");
        }
      catch (const InputError &error)
        {
          throw InputError(std::string("Capsule/Mesh file: ") + error.what());
        }
    }

    /** What the dial looks at. */
    bool
    scene_is_sound(const Parameters &parameters)
    {
      try
        {
          parameters.accuracy.check();
          parameters.scene.check();
          parameters.capsule.check();
          parameters.placement.check();
          check_mesh_file(parameters.capsule);
          parameters.fluid_mesh.check(parameters.scene.box());
          return true;
        }
      catch (const InputError &)
        {
          return false;
        }
    }

    void
    check_solver(const SceneParameters &scene, const SolverParameters &solver)
    {
      std::ostringstream message;
      if (scene.reynolds_number > 0. && solver.coupling == TimeCoupling::explicit_euler)
        message << "Solver/Coupling is explicit; allowed with Scene/Reynolds number > 0: implicit";
      else if (scene.reynolds_number > 0. && solver.method == StokesMethod::assembled)
        message << "Solver/Method is assembled; allowed with Scene/Reynolds number = " << scene.reynolds_number << ": matrix-free";
      else if (scene.viscosity_ratio != 1. && solver.method == StokesMethod::assembled)
        message << "Solver/Method is assembled; allowed with Scene/Viscosity ratio = " << scene.viscosity_ratio << ": matrix-free";
      if (!message.str().empty())
        throw InputError(message.str());
    }

    void
    check_shell_mesh(const ShellMeshParameters &mesh, const ShellParameters &shell)
    {
      if (mesh.even == EvenControlMesh::always && !shell.place_is_free())
        throw InputError(std::string("Shell mesh/Even control mesh is always; allowed where ") +
                         (shell.reference == ReferenceCurvature::initial ? "Capsule/Reference curvature is initial" : "the shell has a membrane") +
                         ", so that the place of the material matters: automatic or never.");
    }

    void
    check_study(const Parameters &parameters)
    {
      parameters.study.check(parameters.capsule.shape == Shape::file ? -1 : int(parameters.shell_mesh.level),
                             parameters.time.steady_tolerance > 0. || parameters.time.limit_tolerance > 0.,
                             parameters.scene.boundary == Boundary::unbounded,
                             parameters.accuracy.target_error > 0.);
    }

    void
    set(dealii::ParameterHandler &prm, const std::string &section, const std::string &name, const std::string &value)
    {
      prm.enter_subsection(section);
      prm.set(name, value);
      prm.leave_subsection();
    }

    /** The names of files that depend on that of the parameter file: a relative mesh file lies in its folder, the default output folder is named after it. */
    void
    complete_file_names(dealii::ParameterHandler &prm, const Parameters &parameters)
    {
      const std::filesystem::path file = std::filesystem::absolute(parameters.file);
      if (!parameters.capsule.file.empty())
        set(prm, "Capsule", "Mesh file", (file.parent_path() / parameters.capsule.file).lexically_normal().string());
      if (!parameters.placement.file.empty())
        set(prm, "Capsule", "Places file", (file.parent_path() / parameters.placement.file).lexically_normal().string());
      if (parameters.output.directory.empty())
        set(prm, "Output", "Directory", "output/" + file.stem().string());
    }

    /** Random places do not depend on the control mesh: the shape's points on a coarse one are enough. */
    std::vector<Place>
    random_places(const Parameters &parameters)
    {
      const PlacementParameters &placement = parameters.placement;
      const Box                  box       = parameters.scene.box();
      const double               face_gap  = parameters.scene.boundary == Boundary::unbounded ? UnboundedLiquid::least_distance : 0.;
      try
        {
          return random_places(
            {placement.number_in(box.volume()), placement.seed, placement.least_gap, std::max(placement.least_gap, face_gap), placement.turned},
            make_capsule(parameters.capsule, 2),
            box);
        }
      catch (const InputError &error)
        {
          throw InputError(std::string(placement.number > 0 ? "Capsule/Number: " : "Capsule/Volume fraction: ") + error.what());
        }
    }

    /** Makes a list of places from a file or at random. */
    void
    place_capsules(dealii::ParameterHandler &prm, const Parameters &parameters, const ParameterSource &source)
    {
      if (parameters.placement.placement == Placement::list)
        return;
      try
        {
          const auto [centres, rotations] =
            as_lists(parameters.placement.placement == Placement::file ? read_places(parameters.placement.file) : random_places(parameters));
          set(prm, "Capsule", "Placement", "list");
          set(prm, "Capsule", "Centres", centres);
          set(prm, "Capsule", "Rotations", rotations);
        }
      catch (const InputError &error)
        {
          throw InputError(source.locate(error.what()));
        }
    }
  } // namespace

  void
  ShellMeshParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Shell mesh");
    prm.add_parameter("Level",
                      level,
                      "Subdivisions of the icosahedron that give the control mesh: 10 * 4^level + 2 control points. Unused for a mesh file.",
                      dealii::Patterns::Integer(0, 6));
    prm.add_parameter("Quadrature", quadrature, "Quadrature points a face of the control mesh.", dealii::Patterns::Selection("1|3|6|7|12"));
    add_enum_parameter(
      prm,
      "Even control mesh",
      even,
      {{"automatic", EvenControlMesh::automatic}, {"always", EvenControlMesh::always}, {"never", EvenControlMesh::never}},
      "Whether control points move along the shell other than the material, so that they stay evenly spread; the surface moves the same. always: allowed where the "
      "place of the material costs no energy (no membrane, Reference curvature flat or value); automatic: there with Bending form moment-only, whose forces pull "
      "the material together. Steps are then at most 0.1 mu a^2 R / kappa_B, R the smallest radius of curvature.");
    prm.leave_subsection();
  }

  void
  Parameters::add_parameters(dealii::ParameterHandler &prm)
  {
    accuracy.add_parameters(prm);
    scene.add_parameters(prm);
    capsule.add_parameters(prm);
    placement.add_parameters(prm);
    shell.add_parameters(prm);
    shell_mesh.add_parameters(prm);
    fluid_mesh.add_parameters(prm);
    time.add_parameters(prm);
    solver.add_parameters(prm);
    output.add_parameters(prm);
    study.add_parameters(prm);
  }

  void
  Parameters::check(const ParameterSource &source) const
  {
    std::string errors;
    const auto  collect = [&](const auto &check) {
      try
        {
          check();
        }
      catch (const InputError &error)
        {
          errors += (errors.empty() ? "" : "\n") + source.locate(error.what());
        }
    };
    collect([&] { accuracy.check(); });
    collect([&] { scene.check(); });
    collect([&] { capsule.check(); });
    collect([&] { placement.check(); });
    collect([&] { check_mesh_file(capsule); });
    collect([&] { shell.check(); });
    collect([&] { check_shell_mesh(shell_mesh, shell); });
    collect([&] { check_solver(scene, solver); });
    collect([&] { fluid_mesh.check(scene.box()); });
    collect([&] { output.check(); });
    collect([&] { check_study(*this); });
    collect([&] { check_output_folder(output.directory); });
    if (!errors.empty())
      throw InputError(errors);
    try
      {
        check_scene(*this); // makes shapes of what is all right so far
      }
    catch (const InputError &error)
      {
        throw InputError(source.locate(error.what()));
      }
  }

  bool
  Parameters::control_mesh_stays_even() const
  {
    switch (shell_mesh.even)
      {
        case EvenControlMesh::always:
          return true;
        case EvenControlMesh::never:
          return false;
        case EvenControlMesh::automatic:
          break;
      }
    return shell.place_is_free() && shell.form == BendingForm::moment_only && scene.bending_modulus() > 0.;
  }

  Parameters
  read_parameters(const std::string &file, const std::vector<std::string> &overrides)
  {
    Parameters               parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    const ParameterSource source = read_parameter_file(prm, file, overrides);
    parameters.file              = file;
    complete_file_names(prm, parameters);
    if (scene_is_sound(parameters)) // otherwise check() says what is wrong with it
      parameters.choices = accuracy_choices(parameters, source);
    for (const Choice &choice : parameters.choices)
      set(prm, choice.section, choice.name, choice.value);
    if (scene_is_sound(parameters))
      place_capsules(prm, parameters, source);
    parameters.check(source);
    parameters.used = parameters_as_prm(prm);
    return parameters;
  }

  Parameters
  with_settings(const Parameters &parameters, const std::vector<std::string> &settings)
  {
    Parameters               result;
    dealii::ParameterHandler prm;
    result.add_parameters(prm);
    const ParameterSource source = read_parameter_text(prm, parameters.used, parameters.file, settings);
    result.file                  = parameters.file;
    result.choices               = parameters.choices;
    result.check(source);
    result.used = parameters_as_prm(prm);
    return result;
  }

  std::string
  default_parameters(const bool as_markdown)
  {
    Parameters               parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    return as_markdown ? parameters_as_markdown(prm) : parameters_as_prm(prm);
  }
} // namespace tanktread
