// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a run with the coarser companions that tell its errors.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/output_file.h>
#include <tanktread/simulation/shared_parameters.h>
#include <tanktread/simulation/simulation.h>
#include <tanktread/simulation/study.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace tanktread
{
  namespace
  {
    std::string
    content(const std::string &file)
    {
      std::ifstream      stream(file);
      std::ostringstream text;
      text << stream.rdbuf();
      return text.str();
    }


    /** A parameter file without its section Study, which changes nothing of a run. */
    std::string
    without_study(const std::string &prm)
    {
      std::istringstream lines(prm);
      std::string        line, result;
      bool               in_study = false;
      while (std::getline(lines, line))
        {
          in_study = in_study || line == "subsection Study";
          if (!in_study)
            result += line + '\n';
          in_study = in_study && line != "end";
        }
      return result;
    }


    /** Whether the folder of a run holds the result of these parameters. */
    bool
    is_done(const Parameters &parameters)
    {
      const std::string &folder = parameters.output.directory;
      return finished_summary(folder) && without_study(content(folder + "/used_parameters.prm")) == without_study(parameters.used);
    }


    /** Of each series, its first two runs compared. */
    std::vector<CurveDifferences>
    curves_of_series(const StudyPlan &plan, const std::vector<Parameters> &parameters, const Summaries &summaries)
    {
      std::vector<CurveDifferences> result;
      for (const StudySeries &series : plan.series)
        if (series.runs.size() > 1 && summaries[series.runs[0]] && summaries[series.runs[1]])
          result.push_back(curve_differences_of(parameters[series.runs[0]].output.directory, parameters[series.runs[1]].output.directory));
        else
          result.emplace_back();
      return result;
    }
  } // namespace


  Study::Study(const Parameters &parameters, const std::vector<std::string> &overrides, const MPI_Comm communicator)
    : communicator_(communicator)
    , log_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , plan_(study_plan(parameters.study, parameters.scene.boundary == Boundary::unbounded))
  {
    for (const StudyRun &run : plan_.runs)
      {
        std::vector<std::string> of_run = overrides;
        if (run.coarser.count(Cause::target) == 0) // other companions differ from the run in their cause alone
          for (const Choice &choice : parameters.choices)
            of_run.push_back(choice.section + "/" + choice.name + "=" + choice.value);
        if (!run.coarser.empty())
          for (const std::string &change : changes(parameters, run))
            of_run.push_back(change);
        try
          {
            parameters_.push_back(run.coarser.empty() ? parameters : read_shared_parameters(parameters.file, of_run, communicator));
          }
        catch (const InputError &error)
          {
            throw InputError("The companion " + run.name() + " of section Study cannot be made:\n" + error.what());
          }
        if (run.coarser.count(Cause::target) == 0)
          parameters_.back().choices = parameters.choices;
        else if (parameters_.back().choices.empty())
          throw InputError("Study/Vary names target; allowed where something is left to it: all that Accuracy/Target error chooses is set");
      }
  }


  std::string
  Study::do_run(const std::size_t i)
  {
    const Parameters &parameters = parameters_[i];
    bool              done       = false;
    on_first_rank(communicator_, [&] { done = is_done(parameters); });
    if (dealii::Utilities::MPI::broadcast(communicator_, done, 0))
      {
        log_.line("\nStudy: " + parameters.output.directory + " holds the result of its parameters and is not computed again.");
        return "";
      }
    log_.line("\nStudy: " + (i == 0 ? "the run" : "companion " + plan_.runs[i].name()) + ", " + std::to_string(i + 1) + " of " +
              std::to_string(plan_.runs.size()) + ", in " + parameters.output.directory + ".");
    const auto   start = std::chrono::steady_clock::now();
    std::ostream no_screen(nullptr);
    try
      {
        Simulation(parameters, communicator_, i == 0 ? std::cout : no_screen).run();
      }
    catch (const NumericalError &error)
      {
        if (i == 0)
          throw;
        return plan_.runs[i].name() + ": " + error.what();
      }
    (i == 0 ? own_seconds_ : companion_seconds_) += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return "";
  }


  void
  Study::end_companions_with_the_run()
  {
    double end = 0.;
    on_first_rank(communicator_, [&] { end = end_of_run(parameters_[0].output.directory).value_or(0.); });
    end                               = dealii::Utilities::MPI::broadcast(communicator_, end, 0);
    std::vector<std::string> settings = {"Time/Steady tolerance=0", "Time/Limit tolerance=0"};
    if (end < parameters_[0].scene.end_time)
      {
        std::ostringstream time;
        time << "Scene/End time=" << std::setprecision(15) << end;
        settings.push_back(time.str());
      }
    for (std::size_t i = 1; i < parameters_.size(); ++i)
      parameters_[i] = with_settings(parameters_[i], settings);
  }


  void
  Study::write_table(const StudyTable &table)
  {
    const std::string &folder = parameters_[0].output.directory;
    on_first_rank(communicator_, [&] {
      replace_file(folder + "/study.csv", table.as_csv());
      replace_file(folder + "/study.txt", table.as_text());
    });
    log_.line("\nStudy: error bars by cause, in brackets observed orders; " + folder + "/study.csv\n" + table.as_text());
    if (own_seconds_ > 0.)
      {
        log_.line("The companions took " + std::to_string(std::lround(100. * companion_seconds_ / own_seconds_)) + " % of the time of the run.");
      }
  }


  void
  Study::run()
  {
    std::string failures;
    for (std::size_t i = 0; i < plan_.runs.size(); ++i)
      if (const std::string failure = do_run(i); !failure.empty())
        failures += "\n" + failure;
      else if (i == 0)
        end_companions_with_the_run();
    StudyTable table;
    on_first_rank(communicator_, [&] {
      Summaries summaries;
      for (const Parameters &parameters : parameters_)
        summaries.push_back(finished_summary(parameters.output.directory));
      table = study_table(plan_, summaries, parameters_[0], curves_of_series(plan_, parameters_, summaries));
    });
    write_table(table);
    if (!failures.empty())
      throw NumericalError("Companions of section Study have failed; what they would tell is missing from the error bars." + failures);
  }
} // namespace tanktread
