// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: all parameters of a run, and reading them.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/output_folder.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/base/parameter_table.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/place_capsules.h>
#include <tanktread/simulation/scene_description.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** Reads the mesh file of each kind that has one. Returns a line for each that is no closed surface. */
    std::string
    read_mesh_files(std::vector<KindParameters> &kinds, const ParameterSource &source)
    {
      std::string errors;
      for (KindParameters &kind : kinds)
        try
          {
            if (kind.shape.shape == Shape::file && !kind.shape.file.empty())
              kind.shape.mesh = std::make_shared<const TriangleMesh>(read_closed_surface(kind.shape.file));
          }
        catch (const InputError &error)
          {
            errors += (errors.empty() ? "" : "\n") + source.locate(kind.section + "/Mesh file: " + error.what());
          }
      return errors;
    }

    /** What the dial looks at. */
    bool
    scene_is_sound(const Parameters &parameters)
    {
      try
        {
          parameters.accuracy.check();
          parameters.scene.check();
          for (const KindParameters &kind : parameters.kinds)
            kind.check();
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
    check_shell_mesh(const Parameters &parameters)
    {
      const bool is_even = parameters.control_mesh_stays_even();
      for (const KindParameters &kind : parameters.kinds)
        {
          const ShellParameters &shell = kind.shell;
          if (parameters.shell_mesh.even == EvenControlMesh::always && !shell.place_is_free())
            throw InputError("Shell mesh/Even control mesh is always; allowed where " +
                             (shell.reference == ReferenceCurvature::initial ? kind.section + "/Reference curvature is initial" : "the shell has a membrane") +
                             ", so that the place of the material matters: automatic or never.");
          if (is_even && !shell.place_is_free())
            throw InputError(
              "Shell mesh/Even control mesh is automatic, which moves the control points of capsules without a membrane and with Bending form moment-only along their shells; allowed where " +
              kind.section + " is another kind, whose points have to stay: never.");
        }
    }

    void
    check_study(const Parameters &parameters)
    {
      parameters.study.check(parameters.has_mesh_file() ? -1 : int(parameters.shell_mesh.level),
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
      for (const KindParameters &kind : parameters.kinds)
        {
          if (!kind.shape.file.empty())
            set(prm, kind.section, "Mesh file", (file.parent_path() / kind.shape.file).lexically_normal().string());
          if (!kind.placement.file.empty())
            set(prm, kind.section, "Places file", (file.parent_path() / kind.placement.file).lexically_normal().string());
        }
      if (parameters.output.directory.empty())
        set(prm, "Output", "Directory", "output/" + file.stem().string());
    }

    void
    note_values(const dealii::ParameterHandler &prm, Parameters &parameters)
    {
      parameters.used = parameters_as_prm(prm);
      parameters.values.clear();
      for (const ParameterInfo &parameter : parameter_table(prm))
        parameters.values.push_back({parameter.section, parameter.name, parameter.value});
    }

    /** Every line behind a "# ". */
    std::string
    commented(const std::string &text)
    {
      std::istringstream lines(text);
      std::string        result;
      for (std::string line; std::getline(lines, line);)
        result += "# " + line + "\n";
      return result;
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

  Parameters::Parameters(const std::size_t n_kinds)
  {
    for (unsigned int k = 0; k < n_kinds; ++k)
      kinds.emplace_back(k);
  }

  void
  Parameters::add_parameters(dealii::ParameterHandler &prm)
  {
    accuracy.add_parameters(prm);
    scene.add_parameters(prm);
    for (KindParameters &kind : kinds)
      kind.add_parameters(prm);
    shell_mesh.add_parameters(prm);
    fluid_mesh.add_parameters(prm);
    time.add_parameters(prm);
    solver.add_parameters(prm);
    output.add_parameters(prm);
    study.add_parameters(prm);
  }

  void
  Parameters::check(const ParameterSource &source, std::string errors) const
  {
    const auto collect = [&](const auto &check) {
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
    for (const KindParameters &kind : kinds)
      collect([&] { kind.check(); });
    collect([&] { check_shell_mesh(*this); });
    collect([&] { check_solver(scene, solver); });
    collect([&] { fluid_mesh.check(scene.box()); });
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
    const auto has_such_forces = [this](const KindParameters &kind) {
      return kind.shell.place_is_free() && kind.shell.form == BendingForm::moment_only && moduli(kind).bending_modulus > 0.;
    };
    switch (shell_mesh.even)
      {
        case EvenControlMesh::always:
          return true;
        case EvenControlMesh::never:
          return false;
        case EvenControlMesh::automatic:
          break;
      }
    return std::any_of(kinds.begin(), kinds.end(), has_such_forces);
  }

  ShellModuli
  Parameters::moduli(const KindParameters &kind) const
  {
    return {scene.surface_young_modulus() * kind.young_modulus_factor, scene.bending_modulus() * kind.bending_modulus_factor};
  }

  std::size_t
  Parameters::n_capsules() const
  {
    std::size_t result = 0;
    for (const KindParameters &kind : kinds)
      result += kind.placement.centres.size();
    return result;
  }

  bool
  Parameters::bends() const
  {
    return std::any_of(kinds.begin(), kinds.end(), [this](const KindParameters &kind) { return moduli(kind).bending_modulus > 0.; });
  }

  bool
  Parameters::has_mesh_file() const
  {
    return std::any_of(kinds.begin(), kinds.end(), [](const KindParameters &kind) { return kind.shape.shape == Shape::file; });
  }

  Parameters
  read_parameters(const std::string &file, const std::vector<std::string> &overrides)
  {
    const std::string        text = text_of_parameter_file(file);
    Parameters               parameters(number_of_kinds(text, file, overrides));
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    ParameterSource source = read_parameter_text(prm, text, file, overrides);
    inherit_from_first_kind(prm, parameters.kinds.size(), source);
    parameters.file = file;
    complete_file_names(prm, parameters);
    const std::string unreadable = read_mesh_files(parameters.kinds, source);
    const bool        is_sound   = unreadable.empty() && scene_is_sound(parameters);
    if (is_sound) // otherwise check() says what is wrong with it
      parameters.choices = accuracy_choices(parameters, source);
    for (const Choice &choice : parameters.choices)
      set(prm, choice.section, choice.name, choice.value);
    if (is_sound && scene_is_sound(parameters))
      place_capsules(prm, parameters, source);
    parameters.check(source, unreadable);
    note_values(prm, parameters);
    return parameters;
  }

  void
  set_values(dealii::ParameterHandler &prm, const std::vector<Choice> &values)
  {
    for (const Choice &value : values)
      set(prm, value.section, value.name, value.value);
  }

  Parameters
  with_settings(const Parameters &parameters, const std::vector<std::string> &settings)
  {
    Parameters               result(parameters.kinds.size());
    dealii::ParameterHandler prm;
    result.add_parameters(prm);
    set_values(prm, parameters.values);
    const ParameterSource source = read_parameter_text(prm, "", parameters.file, settings);
    result.file                  = parameters.file;
    result.choices               = parameters.choices;
    for (std::size_t k = 0; k < result.kinds.size(); ++k)
      if (result.kinds[k].shape.file == parameters.kinds[k].shape.file)
        result.kinds[k].shape.mesh = parameters.kinds[k].shape.mesh;
    result.check(source);
    note_values(prm, result);
    return result;
  }

  std::string
  default_parameters(const bool as_markdown)
  {
    Parameters               parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    // What sections of further kinds have beside; they are not to be read unless they are wanted.
    KindParameters           further(1);
    dealii::ParameterHandler further_prm;
    further.add_further_parameters(further_prm);
    const std::string about =
      "Further kinds of capsules: sections Capsule 2, Capsule 3, ..., in which what is not set is as in Capsule, but for their places. Beside the parameters of Capsule these have";
    if (as_markdown)
      return parameters_as_markdown(prm) + "\n" + about + "\n\n" + parameters_as_markdown(further_prm);
    return parameters_as_prm(prm) + "\n# " + about + "\n" + commented(parameters_as_prm(further_prm));
  }
} // namespace tanktread
