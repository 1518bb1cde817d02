// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: writing checkpoints of a run, and finding the one to go on from.

#ifndef tanktread_simulation_checkpoints_h
#define tanktread_simulation_checkpoints_h

#include <tanktread/base/checkpoint_folder.h>
#include <tanktread/base/log.h>
#include <tanktread/base/stop_request.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/results.h>
#include <tanktread/simulation/snapshot.h>

#include <chrono>
#include <optional>
#include <string>

namespace tanktread
{
  /** The checkpoints of one run. All members are collective. */
  class Checkpoints
  {
  public:
    /** Keeps `parameters` and `log` by reference. */
    Checkpoints(const Parameters &parameters, MPI_Comm communicator, Log &log);

    /** What a run is resumed from. */
    struct Found
    {
      std::string    name;
      double         time;
      unsigned int   step;
      Snapshot       snapshot; // what this rank has read
      OutputProgress progress; // on the first rank
      std::int64_t   log_size; // on the first rank
    };

    /**
     * The newest checkpoint that is whole; damaged ones are told of in the log and left alone. Nothing if there is none. Throws InputError, on all ranks, where a parameter has changed that may not,
     * see doc/restart.md.
     */
    std::optional<Found>
    find();

    /** Removes checkpoints of later steps, from which the run will not be resumed any more. */
    void
    forget_after(unsigned int step);

    /** Writes one. What prevents it (a full disk) is told in the log; then false, and the ones before stay. */
    bool
    write(RunParts run, const OutputProgress &progress);

    /** What is to be done now: asked for by signals to any rank, by a file `stop` in the folder of the run, or due by the clock. Removes that file. */
    Request
    wanted();

  private:
    /** Reads all that belongs to it. Throws InputError where it is damaged. */
    Found
    read(const std::string &name);
    /** Throws InputError that names them. */
    void
    check_parameters(const std::vector<Choice> &before) const;

    const Parameters                     &parameters_;
    const MPI_Comm                        communicator_;
    Log                                  &log_;
    const CheckpointFolder                folder_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
    std::vector<Choice>                   parameters_before_; // of the checkpoint that was read last, on the first rank
  };
} // namespace tanktread

#endif
