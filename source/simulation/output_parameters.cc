// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: where results go and how often.

#include <tanktread/simulation/output_parameters.h>

#include <deal.II/base/parameter_handler.h>

namespace tanktread
{
  void
  OutputParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Output");
    prm.add_parameter("Directory",
                      directory,
                      "Folder of the results, made if missing, in the folder in which the program is started; empty: output/<name of the parameter file>. "
                      "A former run in it is moved to <Directory>.previous.",
                      dealii::Patterns::DirectoryName());
    prm.add_parameter("History interval", history_interval, "Time between rows of history.csv; 0: a row each step.", Double(0.));
    prm.add_parameter("Field interval", field_interval, "Time between VTU files of fluid and shell; 0: only the first and the last.", Double(0.));
    prm.add_parameter(
      "Surface subdivisions",
      surface_subdivisions,
      "How often each face of the control mesh is divided into four in the files of the shell. Their points lie on the smooth surface, with its "
      "normals; each subdivision makes the files four times larger.",
      dealii::Patterns::Integer(0, 5));
    prm.add_parameter("Contour times",
                      contour_times,
                      "Times at which the cut of the shell with the plane y = 0 is written, besides those of the fields; the steps need not meet them.",
                      dealii::Patterns::List(Double(0.)));
    prm.add_parameter("Checkpoint interval",
                      checkpoint_interval,
                      "Time between checkpoints, from which --resume goes on with a run; the last two are kept. 0: none but those below and those asked for (doc/restart.md).",
                      Double(0.));
    prm.add_parameter("Checkpoint wall interval", checkpoint_wall_interval, "The same in seconds of the clock; 0: none.", Double(0.));
    prm.leave_subsection();
  }
} // namespace tanktread
