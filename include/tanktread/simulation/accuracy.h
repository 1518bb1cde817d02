// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Accuracy", which chooses the numerical parameters for a wanted error.

#ifndef tanktread_simulation_accuracy_h
#define tanktread_simulation_accuracy_h

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  struct Parameters;
  class ParameterSource;

  /** Section "Accuracy". */
  struct AccuracyParameters
  {
    double target_error = 0.; // relative to the largest D of the run; 0: nothing is chosen

    /** Declares section "Accuracy" in `prm`; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** Throws InputError for targets that are out of reach. */
    void
    check() const;
  };

  /** A parameter with the value that it gets. */
  struct Choice
  {
    std::string section, name, value;
  };

  /** What one cause adds to the error of D, relative to its largest value, by the model of doc/accuracy.md, "The dial". */
  struct ErrorShare
  {
    std::string cause;
    double      error;
    double      cost_of_half; // factor of the run's time if this error shall be half as large
  };

  /**
   * Values for the parameters that neither file nor command line has set, so that the error is expected below Accuracy/Target error: cells, control mesh, box,
   * time scheme, tolerances and stop. Empty without a target.
   */
  std::vector<Choice>
  accuracy_choices(const Parameters &parameters, const ParameterSource &source);

  /** The model's errors for the parameters as they are, whoever has set them; causes that it knows nothing of are missing. */
  std::vector<ErrorShare>
  expected_errors(const Parameters &parameters);

  /** What has been chosen and what it is expected to leave, in a few lines for the log. */
  std::string
  accuracy_text(const Parameters &parameters);

  /** Largest D that the model expects of a scene: that of the initial shape, or of small deformations (Barthes-Biesel), which saturates. */
  double
  expected_deformation(const Parameters &parameters);
} // namespace tanktread

#endif
