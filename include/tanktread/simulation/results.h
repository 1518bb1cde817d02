// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#ifndef tanktread_simulation_results_h
#define tanktread_simulation_results_h

#include <tanktread/base/csv_writer.h>
#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/observables.h>
#include <tanktread/simulation/surface_vtu.h>
#include <tanktread/surface/limit_picture.h>

#include <memory>
#include <string>
#include <vector>

namespace tanktread
{
  /**
   * history.csv (one row a step), contours.csv (cuts parallel to the plane y = 0 through the middle of the capsule at each field output and when
   * asked for: time, x, z), both with _1, ..., _N in their names where there are N capsules; suspension.csv (all capsules together), shell_NNNN.vtu and
   * fluid_NNNNN.pvtu with shell.pvd and
   * fluid.pvd, summary.csv at the end. The first rank writes all but the pieces of the fluid.
   */
  class Results
  {
  public:
    /**
     * The folder must exist. What cannot be written on the first rank throws OutputError on all. Collective, as are all members.
     *
     * @param topology control mesh of the capsules. @param surface_subdivisions of its faces in the files of the shells.
     */
    Results(const std::string &folder, const TriangleMesh &topology, unsigned int n_capsules, unsigned int surface_subdivisions, MPI_Comm communicator);

    void
    add_history(const StepObservables &step, const std::vector<CapsuleObservables> &capsules, const SuspensionObservables &suspension);

    /** Writes shells, contours and fluid. `velocities`: of the control points. */
    void
    add_fields(double time, Scene &scene, const State &state, const ShellFields &velocities);

    /** The cuts of the shells with control points x alone. */
    void
    add_contours(double time, const ShellFields &x);

    /**
     * summary.csv: lines "quantity,value", the first of them `outcome` with the word "done", "steady" or "failed"; with several capsules the quantities of each
     * have its number at their end. @param of_run what there is once, whatever the number of capsules.
     */
    void
    write_summary(const std::string &outcome, const std::vector<MotionSummary> &capsules, const Row &of_run) const;

    /** The last good state of a run that failed: failed_shell.vtu. Returns the file's name. */
    std::string
    write_failed(Scene &scene, const State &state) const;

  private:
    void
    write_shells(const std::string &file, const Capsule &capsule, const State &state, const ShellFields &velocities) const;
    void
    write_contours(double time, const ShellFields &x);

    std::string                             folder_;
    MPI_Comm                                communicator_;
    unsigned int                            n_capsules_, n_fields_ = 0;
    std::vector<std::unique_ptr<CsvWriter>> histories_, contours_; // on the first rank only
    std::unique_ptr<CsvWriter>              suspension_;           // likewise
    std::unique_ptr<LimitPicture>           surface_picture_, contour_picture_;
    PvdFile                                 shell_series_, fluid_series_;
  };
} // namespace tanktread

#endif
