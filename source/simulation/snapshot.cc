// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: all that the rest of a run follows from, in bytes.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/simulation/capsule_moves.h>
#include <tanktread/simulation/snapshot.h>
#include <tanktread/simulation/snapshot_fluid.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    // One function for either direction: what is written is what is read.
    template <typename Archive, typename Function>
    std::string
    written(const Function &function)
    {
      std::ostringstream stream;
      Archive            archive(stream, boost::archive::no_header);
      function(archive);
      return stream.str();
    }


    template <typename Function>
    void
    read(const std::string &bytes, const Function &function)
    {
      std::istringstream              stream(bytes);
      boost::archive::binary_iarchive archive(stream, boost::archive::no_header);
      function(archive);
    }


    template <typename Archive>
    void
    exchange(Archive &archive, ControlPoints &x)
    {
      std::vector<double> numbers(x.data(), x.data() + x.size());
      archive            &numbers;
      x = Eigen::Map<const ControlPoints>(numbers.data(), Eigen::Index(numbers.size()) / 3, 3);
    }


    /** Numbers that are the same on all ranks. */
    template <typename Archive>
    void
    exchange_common(Archive &archive, RunParts run, std::vector<double> &times, std::vector<unsigned int> &team_of, std::vector<std::array<double, 6>> &boxes)
    {
      RunMemory    &memory  = run.memory;
      StepMemory   &steps   = memory.steps;
      SolverMemory &solver  = run.scene.memory();
      int           tangent = int(solver.tangent);
      double        elapsed = run.scene.timings().elapsed();
      archive &memory.time &memory.n_steps &memory.n_quiet_steps &memory.n_known_steps &memory.next_fields &memory.next_history &memory.next_checkpoint;
      archive &steps.energy.last &steps.energy.scale &steps.next_length &steps.shortest;
      archive &solver.worn_out &solver.iterations_per_decade &solver.n_renewals &tangent &elapsed;
      for (ConcernMemory &concern : memory.warnings.concerns)
        archive &concern.worst &concern.time_of_worst &concern.since;
      EnergyMemory &energy = memory.warnings.energy;
      archive &energy.left_over &energy.passed &energy.last_power &energy.n_steps &memory.warnings.steps.sum;
      archive &times &team_of                                                     &boxes;
      if (Archive::is_loading::value)
        {
          solver.tangent = Tangent(tangent);
          run.scene.timings().add_before(elapsed);
        }
    }


    /** What belongs to one capsule. */
    struct CapsuleParts
    {
      CapsuleState               now;
      std::vector<CapsuleState>  previous;
      std::vector<ControlPoints> history, mesh;
      ControlPoints              points, viscosity, preconditioner;
      std::vector<double>        memory; // packed()

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        const auto states = [&](CapsuleState &state) {
          exchange(archive, state.x);
          exchange(archive, state.force);
          archive &state.pressure_jump &state.volume_shift;
        };
        states(now);
        for (CapsuleState &state : previous)
          states(state);
        for (std::vector<ControlPoints> *const sets : {&history, &mesh})
          for (ControlPoints &x : *sets)
            exchange(archive, x);
        for (ControlPoints *const x : {&points, &viscosity, &preconditioner})
          exchange(archive, *x);
        archive &memory;
      }
    };


    SnapshotCounts
    counts(RunParts run)
    {
      const ShellLayout &layout = run.scene.layout();
      SnapshotCounts     result;
      result.n_ranks       = layout.n_ranks();
      result.n_capsules    = layout.n_capsules();
      result.n_previous    = run.memory.steps.previous.size();
      result.n_history     = run.memory.steps.history.levels().size();
      result.n_mesh_sets   = run.scene.mesh_shells().size();
      result.finest_level  = run.scene.fluid().mesh().finest_level();
      result.has_viscosity = layout.max(run.scene.memory().viscosity_x.size()) > 0.;
      result.has_memory    = layout.max(run.memory.capsules.size()) > 0.;
      result.has_sides     = layout.max(run.state.sides.size()) > 0.;
      std::map<unsigned int, unsigned int> at_vertex;
      double                               largest = 0.;
      for (const auto &force : run.scene.coupling().jumps().viscous_forces().at_vertices)
        largest = std::max<double>(largest, ++at_vertex[force.node]);
      result.n_viscous = static_cast<unsigned int>(layout.max(largest));
      return result;
    }


    CapsuleParts
    parts_of_capsule(RunParts run, const SnapshotCounts &counts, const unsigned int i)
    {
      CapsuleParts result;
      result.now = run.state.capsules[i];
      for (const StepMemory::Level &level : run.memory.steps.previous)
        result.previous.push_back(level.state.capsules[i]);
      for (const StepHistory::Level &level : run.memory.steps.history.levels())
        result.history.push_back(level.x[i]);
      for (const ShellFields &x : run.scene.mesh_shells())
        result.mesh.push_back(x[i]);
      result.points = run.scene.coupling().shells()[i]->x();
      if (counts.has_viscosity)
        {
          result.viscosity      = run.scene.memory().viscosity_x[i];
          result.preconditioner = run.scene.level().preconditioner_x()[i];
        }
      if (counts.has_memory)
        result.memory = packed(run.memory.capsules[i]);
      return result;
    }


    /** The rank's own capsules of all that the ranks have read. */
    std::vector<CapsuleParts>
    own_capsules(RunParts run, const SnapshotCounts &counts, const std::map<unsigned int, std::string> &known)
    {
      const ShellLayout                                          &layout = run.scene.layout();
      std::map<unsigned int, std::map<unsigned int, std::string>> sent;
      for (const auto &[c, bytes] : known)
        for (unsigned int rank = 0; rank < layout.n_ranks(); ++rank)
          if (layout.team_of_rank(rank) == layout.team_of(c))
            sent[rank][c] = bytes;
      std::map<unsigned int, std::string> here;
      for (const auto &[rank, capsules] : dealii::Utilities::MPI::some_to_some(layout.communicator(), sent))
        here.insert(capsules.begin(), capsules.end());
      std::vector<CapsuleParts> result;
      on_all_ranks(layout.communicator(), [&] {
        for (const unsigned int c : layout.own())
          {
            const auto found = here.find(c);
            if (found == here.end())
              throw InputError("it has no capsule " + std::to_string(c + 1));
            CapsuleParts parts;
            parts.previous.resize(counts.n_previous);
            parts.history.resize(counts.n_history);
            parts.mesh.resize(counts.n_mesh_sets);
            read(found->second, [&](auto &archive) { archive &parts; });
            result.push_back(std::move(parts));
          }
      });
      return result;
    }


    void
    restore_capsules(RunParts run, const SnapshotCounts &counts, const std::vector<double> &times, const std::vector<CapsuleParts> &capsules)
    {
      const ShellLayout &layout = run.scene.layout();
      StepMemory        &steps  = run.memory.steps;
      const auto         fields = [&](const auto &part) {
        ShellFields result;
        for (const CapsuleParts &capsule : capsules)
          result.push_back(part(capsule));
        return result;
      };
      run.state = State();
      steps.previous = std::deque<StepMemory::Level>(counts.n_previous);
      run.memory.capsules.clear();
      for (unsigned int i = 0; i < capsules.size(); ++i)
        {
          run.state.capsules.push_back(capsules[i].now);
          for (unsigned int k = 0; k < counts.n_previous; ++k)
            steps.previous[k].state.capsules.push_back(capsules[i].previous[k]);
          if (counts.has_memory)
            run.memory.capsules.push_back(unpacked(capsules[i].memory, layout.capsule(i)));
        }
      std::deque<StepHistory::Level> history;
      for (unsigned int k = 0; k < counts.n_previous; ++k)
        steps.previous[k].time = times[k];
      for (unsigned int k = 0; k < counts.n_history; ++k)
        history.push_back({times[counts.n_previous + k], fields([k](const CapsuleParts &capsule) { return capsule.history[k]; })});
      steps.history.set_levels(std::move(history));
      std::vector<ShellFields> mesh;
      for (unsigned int k = 0; k < counts.n_mesh_sets; ++k)
        mesh.push_back(fields([k](const CapsuleParts &capsule) { return capsule.mesh[k]; }));
      run.scene.restore_mesh(std::move(mesh), counts.finest_level);
    }
  } // namespace


  Snapshot
  take_snapshot(RunParts run)
  {
    run.scene.memory().tau     = 0.;
    SnapshotCounts      all    = counts(run);
    const ShellLayout  &layout = run.scene.layout();
    std::vector<double> times;
    for (const StepMemory::Level &level : run.memory.steps.previous)
      times.push_back(level.time);
    for (const StepHistory::Level &level : run.memory.steps.history.levels())
      times.push_back(level.time);
    std::vector<unsigned int> team_of;
    for (unsigned int c = 0; c < layout.n_capsules(); ++c)
      team_of.push_back(layout.team_of(c));
    std::vector<std::array<double, 6>> boxes;
    for (const ShellBox &box : run.scene.coupling().jumps().viscous_forces().boxes)
      boxes.push_back({{box.lower[0], box.lower[1], box.lower[2], box.upper[0], box.upper[1], box.upper[2]}});
    Snapshot result;
    result.common = written<boost::archive::binary_oarchive>([&](auto &archive) {
      archive &all;
      exchange_common(archive, run, times, team_of, boxes);
    });
    for (unsigned int i = 0; layout.leads() && i < layout.n_own(); ++i)
      {
        CapsuleParts parts               = parts_of_capsule(run, all, i);
        result.capsules[layout.own()[i]] = written<boost::archive::binary_oarchive>([&](auto &archive) { archive &parts; });
      }
    take_fluid(run, all, result);
    return result;
  }


  void
  restore(RunParts run, Snapshot known)
  {
    SnapshotCounts                     all;
    std::vector<double>                times;
    std::vector<unsigned int>          team_of;
    std::vector<std::array<double, 6>> boxes;
    read(known.common, [&](auto &archive) {
      archive &all;
      exchange_common(archive, run, times, team_of, boxes);
    });
    const ShellLayout &layout = run.scene.layout();
    if (all.n_capsules != layout.n_capsules())
      throw InputError("it is of " + std::to_string(all.n_capsules) + " capsules; allowed: the " + std::to_string(layout.n_capsules()) + " of the scene");
    if (all.n_ranks == layout.n_ranks())
      run.scene.reassign(team_of);
    const std::vector<CapsuleParts> capsules = own_capsules(run, all, known.capsules);
    restore_capsules(run, all, times, capsules);

    ShellJumps::ViscousForces viscous;
    for (const std::array<double, 6> &box : boxes)
      viscous.boxes.push_back({{{box[0], box[1], box[2]}}, {{box[3], box[4], box[5]}}});
    restore_fluid(run, all, known, viscous);
    if (!viscous.boxes.empty())
      run.scene.coupling().set_viscous_forces(std::move(viscous));
    ShellFields         viscosity, preconditioner;
    ShellConfigurations points;
    for (unsigned int i = 0; i < capsules.size(); ++i)
      {
        points.push_back(std::make_shared<ShellConfiguration>(layout.capsule(i), capsules[i].points));
        if (all.has_viscosity)
          {
            viscosity.push_back(capsules[i].viscosity);
            preconditioner.push_back(capsules[i].preconditioner);
          }
      }
    run.scene.coupling().move(points);
    run.scene.level().restore_viscosities(preconditioner, viscosity);
    run.scene.level().begin_at_rest(run.memory.time);
  }


  std::string
  bytes_of(const Snapshot &snapshot)
  {
    return written<boost::archive::binary_oarchive>([&](auto &archive) {
      archive &snapshot.common &snapshot.capsules &snapshot.velocities.places &snapshot.velocities.values &snapshot.pressures.places &snapshot.pressures.values;
    });
  }


  Snapshot
  snapshot_of(const std::string &bytes)
  {
    Snapshot result;
    try
      {
        read(bytes, [&](auto &archive) {
          archive &result.common &result.capsules &result.velocities.places &result.velocities.values &result.pressures.places &result.pressures.values;
        });
      }
    catch (const boost::archive::archive_exception &error)
      {
        throw InputError(std::string("its contents cannot be understood (") + error.what() + ")");
      }
    return result;
  }
} // namespace tanktread
