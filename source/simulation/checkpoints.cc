// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: writing checkpoints of a run, and finding the one to go on from.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/version.h>
#include <tanktread/simulation/checkpoints.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    constexpr const char *run_piece = "run.bin";

    /** What the first rank writes beside its snapshot. */
    struct RunPiece
    {
      std::vector<std::array<std::string, 3>> parameters; // section, name, value
      OutputProgress                          progress;
      std::int64_t                            log_size = 0;

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &parameters &progress.tables &progress.n_fields &progress.shell_files &progress.fluid_files &log_size;
      }
    };


    std::string
    snapshot_piece(const unsigned int rank)
    {
      return "rank_" + std::to_string(rank) + ".bin";
    }


    /** The parameters, and sums of the meshes that come from files. */
    std::vector<std::array<std::string, 3>>
    values_of(const Parameters &parameters)
    {
      std::vector<std::array<std::string, 3>> result;
      for (const Choice &choice : parameters.values)
        result.push_back({{choice.section, choice.name, choice.value}});
      for (const KindParameters &kind : parameters.kinds)
        if (kind.shape.mesh)
          {
            std::string bytes;
            for (const Eigen::Vector3d &x : kind.shape.mesh->vertices)
              bytes.append(reinterpret_cast<const char *>(x.data()), 3 * sizeof(double));
            for (const auto &face : kind.shape.mesh->faces)
              bytes.append(reinterpret_cast<const char *>(face.data()), sizeof(face));
            result.push_back({{kind.section, "Mesh file", "contents with the checksum " + std::to_string(checksum(bytes))}});
          }
      return result;
    }


    /** What a resumed run may do in another way. */
    bool
    may_change(const Choice &choice)
    {
      static const std::set<std::pair<std::string, std::string>> names = {{"Scene", "End time"},
                                                                          {"Time", "Step"},
                                                                          {"Time", "Tolerance"},
                                                                          {"Time", "Steady tolerance"},
                                                                          {"Time", "Limit tolerance"},
                                                                          {"Solver", "Newton tolerance"},
                                                                          {"Solver", "Linear tolerance"},
                                                                          {"Solver", "Volume tolerance"}};
      return choice.section == "Output" || names.count({choice.section, choice.name}) > 0;
    }


    void
    append(const PlacedValues &more, PlacedValues &all)
    {
      all.places.insert(all.places.end(), more.places.begin(), more.places.end());
      all.values.insert(all.values.end(), more.values.begin(), more.values.end());
    }


    unsigned int
    this_rank(const MPI_Comm communicator)
    {
      return dealii::Utilities::MPI::this_mpi_process(communicator);
    }
  } // namespace


  Checkpoints::Checkpoints(const Parameters &parameters, const MPI_Comm communicator, Log &log)
    : parameters_(parameters)
    , communicator_(communicator)
    , log_(log)
    , folder_(parameters.output.directory)
  {}


  void
  Checkpoints::check_parameters(const std::vector<Choice> &before) const
  {
    std::map<std::pair<std::string, std::string>, std::vector<std::string>> then, now;
    for (const Choice &choice : before)
      if (!may_change(choice))
        then[{choice.section, choice.name}].push_back(choice.value);
    for (const auto &[section, name, value] : values_of(parameters_))
      if (!may_change({section, name, value}))
        now[{section, name}].push_back(value);
    std::string errors;
    const auto  words = [](const auto &all, const auto &name) {
      const auto found = all.find(name);
      return found == all.end() ? std::string("not there") : found->second.back();
    };
    std::set<std::pair<std::string, std::string>> names;
    for (const auto *const all : {&then, &now})
      for (const auto &entry : *all)
        names.insert(entry.first);
    for (const auto &name : names)
      if (then[name] != now[name])
        errors += "\n  " + name.first + "/" + name.second + ": got " + words(now, name) + "; allowed: " + words(then, name);
    if (!errors.empty())
      throw InputError(
        "--resume: the run in \"" + parameters_.output.directory +
        "\" was started with other parameters; a resumed one may change Output, Scene/End time, Time/Step and the tolerances of Time and Solver." + errors);
  }


  Checkpoints::Found
  Checkpoints::read(const std::string &name)
  {
    Found              found{name, 0., 0, {}, {}, 0};
    const unsigned int rank = this_rank(communicator_), n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator_);
    std::string        text;
    on_first_rank(communicator_, [&] { text = manifest_text(folder_.manifest(name)); });
    const CheckpointManifest manifest = read_manifest(dealii::Utilities::MPI::broadcast(communicator_, text));
    found.time                        = manifest.time;
    found.step                        = manifest.step;
    on_all_ranks(communicator_, [&] {
      for (std::size_t i = 0; i < manifest.pieces.size(); ++i)
        {
          const CheckpointPiece &piece = manifest.pieces[i];
          if (piece.name == run_piece && rank == 0)
            {
              RunPiece                        run;
              std::istringstream              stream(folder_.read(name, piece));
              boost::archive::binary_iarchive archive(stream, boost::archive::no_header);
              archive                        &run;
              for (const auto &[section, parameter, value] : run.parameters)
                parameters_before_.push_back({section, parameter, value});
              found.progress = run.progress;
              found.log_size = run.log_size;
            }
          else if (piece.name != run_piece && i % n_ranks == rank)
            {
              Snapshot snapshot     = snapshot_of(folder_.read(name, piece));
              found.snapshot.common = snapshot.common;
              found.snapshot.capsules.insert(std::make_move_iterator(snapshot.capsules.begin()), std::make_move_iterator(snapshot.capsules.end()));
              append(snapshot.velocities, found.snapshot.velocities);
              append(snapshot.pressures, found.snapshot.pressures);
            }
        }
    });
    // Piece 0 is the first rank's.
    found.snapshot.common = dealii::Utilities::MPI::broadcast(communicator_, found.snapshot.common);
    return found;
  }


  std::optional<Checkpoints::Found>
  Checkpoints::find()
  {
    std::vector<std::string> names;
    on_first_rank(communicator_, [&] { names = folder_.names(); });
    names = dealii::Utilities::MPI::broadcast(communicator_, names);
    std::optional<Found> result;
    for (std::size_t i = 0; i < names.size() && !result; ++i)
      try
        {
          parameters_before_.clear();
          result = read(names[i]);
        }
      catch (const InputError &error)
        {
          log_.line("WARNING: the checkpoint " + folder_.path() + "/" + names[i] + " cannot be used: " + error.what() +
                    (i + 1 < names.size() ? ". The one before it is tried." : "."));
        }
    if (result)
      on_first_rank(communicator_, [&] { check_parameters(parameters_before_); });
    return result;
  }


  void
  Checkpoints::forget_after(const unsigned int step)
  {
    on_first_rank(communicator_, [&] { folder_.forget_after(step); });
  }


  bool
  Checkpoints::write(RunParts run, const OutputProgress &progress)
  {
    const Timings::Scope scope(run.scene.timings(), "Checkpoints");
    const Snapshot       snapshot = take_snapshot(run);
    CheckpointManifest   manifest{program_version(), run.memory.n_steps, run.memory.time, {}};
    try
      {
        on_first_rank(communicator_, [&] { folder_.begin(manifest.step); });
        std::vector<CheckpointPiece> own;
        on_all_ranks(communicator_, [&] {
          const unsigned int rank = this_rank(communicator_);
          own.push_back(folder_.add(manifest.step, snapshot_piece(rank), bytes_of(snapshot)));
          if (rank > 0)
            return;
          RunPiece                        piece{values_of(parameters_), progress, log_.written()};
          std::ostringstream              stream;
          boost::archive::binary_oarchive archive(stream, boost::archive::no_header);
          archive                        &piece;
          own.push_back(folder_.add(manifest.step, run_piece, stream.str()));
        });
        std::vector<std::pair<std::string, std::pair<std::uint64_t, std::uint32_t>>> sent;
        for (const CheckpointPiece &piece : own)
          sent.push_back({piece.name, {piece.size, piece.sum}});
        for (const auto &of_rank : dealii::Utilities::MPI::gather(communicator_, sent))
          for (const auto &[name, rest] : of_rank)
            manifest.pieces.push_back({name, rest.first, rest.second});
        on_first_rank(communicator_, [&] { folder_.finish(manifest); });
      }
    catch (const OutputError &error)
      {
        log_.line(std::string("WARNING: no checkpoint at this step, the ones before are kept: ") + error.what());
        on_first_rank(communicator_, [&] { folder_.abandon(manifest.step); });
        last_ = std::chrono::steady_clock::now();
        return false;
      }
    last_ = std::chrono::steady_clock::now();
    return true;
  }


  Request
  Checkpoints::wanted()
  {
    int request = int(take_request());
    if (this_rank(communicator_) == 0)
      {
        const double    interval = parameters_.output.checkpoint_wall_interval;
        std::error_code ignored;
        if (interval > 0. && std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() > interval)
          request = std::max(request, int(Request::checkpoint));
        if (std::filesystem::remove(parameters_.output.directory + "/stop", ignored))
          request = int(Request::stop);
      }
    return Request(dealii::Utilities::MPI::max(request, communicator_));
  }
} // namespace tanktread
