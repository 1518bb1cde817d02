// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a run with the coarser companions that tell its errors.

#ifndef tanktread_simulation_study_h
#define tanktread_simulation_study_h

#include <tanktread/base/log.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/study_plan.h>
#include <tanktread/simulation/study_table.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace tanktread
{
  /**
   * The run of a parameter file and the companions that its section Study asks for, one after the other, in Output/Directory and the folders study/NAME of it; then
   * study.csv and study.txt with the error bars. A run whose folder holds its result is not done again, so that a study can go on where it was interrupted. All
   * members are collective.
   */
  class Study
  {
  public:
    /** Reads and checks the parameters of all companions. @param overrides those that `parameters` were read with. Throws InputError. */
    Study(const Parameters &parameters, const std::vector<std::string> &overrides, MPI_Comm communicator);

    /**
     * @throws what Simulation throws if the run itself fails; NumericalError at the end, with the error bars of the other causes written, if companions fail.
     */
    void
    run();

  private:
    /** Does a run or finds its result. Returns why it has failed, or nothing. */
    std::string
    do_run(std::size_t i);
    /** Numbers are compared at equal times: companions end where the run has, and do not stop by themselves. */
    void
    end_companions_with_the_run();
    void
    write_table(const StudyTable &table);

    MPI_Comm                communicator_;
    Log                     log_;
    StudyPlan               plan_;
    std::vector<Parameters> parameters_; // of each run
    double                  own_seconds_ = 0., companion_seconds_ = 0.;
  };
} // namespace tanktread

#endif
