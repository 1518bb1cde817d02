// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: all parameters of a run, and reading them.

#ifndef tanktread_simulation_parameters_h
#define tanktread_simulation_parameters_h

#include <tanktread/fluid/fluid_mesh_parameters.h>
#include <tanktread/simulation/accuracy.h>
#include <tanktread/simulation/kind_parameters.h>
#include <tanktread/simulation/output_parameters.h>
#include <tanktread/simulation/scene_parameters.h>
#include <tanktread/simulation/study_parameters.h>
#include <tanktread/simulation/time_stepping.h>
#include <tanktread/solver/solver_parameters.h>

#include <string>
#include <vector>

namespace tanktread
{
  class ParameterSource;

  /** Whether the control points leave the material to stay evenly spread, see EvenMesh. */
  enum class EvenControlMesh
  {
    automatic, // where forces pull the material along the shell and nothing holds it
    always,    // wherever its place costs no energy, which has to be so
    never
  };

  /** Section "Shell mesh". */
  struct ShellMeshParameters
  {
    unsigned int level      = 3; // 10 * 4^level + 2 control points
    unsigned int quadrature = 3; // points a face

    EvenControlMesh even = EvenControlMesh::automatic;

    /** Declares section "Shell mesh" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);
  };

  /** Everything that a parameter file can say. Members start with the defaults. */
  struct Parameters
  {
    AccuracyParameters          accuracy;
    SceneParameters             scene;
    std::vector<KindParameters> kinds; // of capsules
    ShellMeshParameters         shell_mesh;
    FluidMeshParameters         fluid_mesh;
    TimeParameters              time;
    SolverParameters            solver;
    OutputParameters            output;
    StudyParameters             study;

    /** @param n_kinds of capsules. */
    explicit Parameters(std::size_t n_kinds = 1);

    /** Whether the control points are moved along the shells, which then is so for all kinds. */
    bool
    control_mesh_stays_even() const;

    /** E h and kappa_B of a kind, in the units of the scene. */
    ShellModuli
    moduli(const KindParameters &kind) const;

    /** Over all kinds. */
    std::size_t
    n_capsules() const;

    bool
    bends() const;

    bool
    has_mesh_file() const;

    std::vector<Choice> choices; // made for Accuracy/Target error, and set

    std::string file; // name of the parameter file
    std::string used; // all parameters with the values used, as a parameter file that can be read again

    std::vector<Choice> values; // the same, one by one

    /** Declares all sections in `prm`, those of `kinds` among them; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /**
     * Checks each section, what they mean together, the mesh file and the output folder; nothing is written.
     * @param errors known before, one a line.
     * @throws InputError with them and with one line for each section that is wrong, beginning with the place in `source` where the parameter was set.
     */
    void
    check(const ParameterSource &source, std::string errors = {}) const;
  };

  /**
   * Reads `file`, applies `overrides` ("Section/Parameter=value") and checks the result. The name of a mesh file is taken relative to the folder of `file`,
   * Output/Directory relative to the working directory; when it is empty it becomes output/<name of `file` without extension>.
   * @throws InputError with one line for each error.
   */
  Parameters
  read_parameters(const std::string &file, const std::vector<std::string> &overrides = {});

  /** Gives the parameters of `prm` these values. */
  void
  set_values(dealii::ParameterHandler &prm, const std::vector<Choice> &values);

  /** The same with some of them changed ("Section/Parameter=value"); reads no parameter file. @throws InputError as read_parameters(). */
  Parameters
  with_settings(const Parameters &parameters, const std::vector<std::string> &settings);

  /** All parameters with their defaults, as a parameter file or as Markdown tables. */
  std::string
  default_parameters(bool as_markdown);
} // namespace tanktread

#endif
