// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#ifndef tanktread_simulation_results_h
#define tanktread_simulation_results_h

#include <tanktread/base/csv_writer.h>
#include <tanktread/coupling/shell_layout.h>
#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/observables.h>
#include <tanktread/simulation/surface_vtu.h>
#include <tanktread/surface/limit_picture.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tanktread
{
  /** How far the files of a run have got, on the first rank; nothing on the others. */
  struct OutputProgress
  {
    std::vector<std::int64_t>                   tables; // bytes of history*.csv, contours*.csv, suspension.csv
    unsigned int                                n_fields = 0;
    std::vector<std::pair<double, std::string>> shell_files, fluid_files; // with their times
  };

  /**
   * history.csv (one row a step), contours.csv (cuts parallel to the plane y = 0 through the middle of the capsule at each field output and when
   * asked for: time, x, z), both with _1, ..., _N in their names where there are N capsules; of more than `most_files` capsules one file of each with the column `capsule`, a row a capsule. suspension.csv (all
   * capsules together), shell_NNNN.vtu and fluid_NNNNN.pvtu with shell.pvd and
   * fluid.pvd, summary.csv at the end. Each rank writes its piece of the fluid, and of the shells (shell_NNNN.pvtu) where several ranks hold some; the first rank writes the rest.
   */
  class Results
  {
  public:
    static constexpr unsigned int most_files = 16;

    /**
     * The folder must exist. What cannot be written on a rank throws OutputError on all. Collective, as are all members. Keeps `layout` by reference.
     *
     * @param surface_subdivisions of the faces of control meshes in the files of the shells. @param progress of a run that goes on, whose files are cut off where they were then; InputError where they are
     * others.
     */
    Results(const std::string &folder, const ShellLayout &layout, unsigned int surface_subdivisions, const OutputProgress *progress = nullptr);

    OutputProgress
    progress() const;

    /** One number for each capsule of the scene and each column of history_row(), by capsules; the same on all ranks. */
    using History = std::vector<double>;

    /** @param capsules the rank's own ones. */
    static History
    history(const ShellLayout &layout, const StepObservables &step, const std::vector<CapsuleObservables> &capsules);

    void
    add_history(const StepObservables &step, const History &history, const SuspensionObservables &suspension);

    /** Writes shells, contours and fluid. `velocities`: of the control points of the rank's own capsules. */
    void
    add_fields(double time, Scene &scene, const State &state, const ShellFields &velocities);

    /** The cuts of the rank's own shells with control points x alone. */
    void
    add_contours(double time, const ShellFields &x);

    /**
     * summary.csv: lines "quantity,value", the first of them `outcome` with the word "done", "steady" or "failed"; with several capsules the quantities of each
     * have its number at their end. @param capsules the rank's own ones. @param of_run what there is once, whatever the number of capsules.
     */
    void
    write_summary(const std::string &outcome, const std::vector<MotionSummary> &capsules, const Row &of_run) const;

    /** The last good state of a run that failed: failed_shell.vtu or .pvtu. Returns the file's name. */
    std::string
    write_failed(const State &state) const;

  private:
    void
    set_pictures(unsigned int surface_subdivisions);
    /** Opens the tables by `table`(file, columns). On the first rank. */
    template <typename Function>
    void
    open_tables(const Function &table);
    /** Writes `stem`.vtu, or pieces and `stem`.pvtu, in the folder. Returns the name without the folder. */
    std::string
    write_shells(const std::string &stem, const State &state, const ShellFields &velocities) const;

    std::string                             folder_;
    const ShellLayout                      &layout_;
    MPI_Comm                                communicator_;
    unsigned int                            n_capsules_, n_fields_ = 0;
    std::vector<std::unique_ptr<CsvWriter>> histories_, contours_;                // on the first rank only; of each capsule, or one of all
    std::unique_ptr<CsvWriter>              suspension_;                          // likewise
    std::vector<LimitPicture>               surface_pictures_, contour_pictures_; // of the kinds of capsules
    PvdFile                                 shell_series_, fluid_series_;
  };
} // namespace tanktread

#endif
