// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid's part of a snapshot.

#include <tanktread/simulation/snapshot_fluid.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    std::vector<State *>
    levels(RunParts run)
    {
      std::vector<State *> result = {&run.state};
      for (StepMemory::Level &level : run.memory.steps.previous)
        result.push_back(&level.state);
      return result;
    }


    /** Numbers at each node of the pressures: pressure and side of each level, then shell and viscous force, as often as some node has them. */
    std::size_t
    pressure_width(const SnapshotCounts &counts)
    {
      return 2 * (counts.n_previous + 1) + 5 * counts.n_viscous;
    }
  } // namespace


  void
  take_fluid(RunParts run, const SnapshotCounts &counts, Snapshot &snapshot)
  {
    const TaylorHoodSpace     &space = run.scene.fluid().space();
    const NodeSpace           &u = *space.velocity, &p = *space.pressure;
    const std::vector<State *> all = levels(run);
    snapshot.velocities.places     = places_of_nodes(space, u);
    snapshot.pressures.places      = places_of_nodes(space, p);
    for (unsigned int node = 0; node < u.n_owned(); ++node)
      for (const State *const state : all)
        for (unsigned int c = 0; c < 3; ++c)
          snapshot.velocities.values.push_back(state->fluid.block(velocity_block).local_element(3 * std::size_t(node) + c));
    const std::size_t    width  = pressure_width(counts);
    std::vector<double> &values = snapshot.pressures.values;
    values.assign(width * p.n_owned(), -1.);
    for (unsigned int node = 0; node < p.n_owned(); ++node)
      for (std::size_t k = 0; k < all.size(); ++k)
        {
          values[width * node + 2 * k]     = all[k]->fluid.block(pressure_block).local_element(node);
          values[width * node + 2 * k + 1] = all[k]->sides.empty() ? double(unknown_side) : all[k]->sides[node];
        }
    std::vector<unsigned int> n_here(p.n_owned(), 0);
    for (const auto &force : run.scene.coupling().jumps().viscous_forces().at_vertices)
      {
        double *const place = &values[width * force.node + 2 * all.size() + 5 * n_here[force.node]++];
        place[0]            = force.shell;
        std::copy(force.value.begin(), force.value.end(), place + 1);
      }
  }


  void
  restore_fluid(RunParts run, const SnapshotCounts &counts, const Snapshot &known, ShellJumps::ViscousForces &viscous)
  {
    const TaylorHoodSpace     &space = run.scene.fluid().space();
    const NodeSpace           &u = *space.velocity, &p = *space.pressure;
    const std::vector<State *> all          = levels(run);
    const MPI_Comm             communicator = run.scene.communicator();
    const std::size_t          width = pressure_width(counts), n = all.size();
    const std::vector<double>  velocities = values_at(places_of_nodes(space, u), known.velocities, 3 * n, communicator);
    const std::vector<double>  pressures  = values_at(places_of_nodes(space, p), known.pressures, width, communicator);
    for (std::size_t k = 0; k < n; ++k)
      {
        space.reinit(all[k]->fluid);
        for (unsigned int node = 0; node < u.n_owned(); ++node)
          for (unsigned int c = 0; c < 3; ++c)
            all[k]->fluid.block(velocity_block).local_element(3 * std::size_t(node) + c) = velocities[3 * (n * node + k) + c];
        if (counts.has_sides)
          all[k]->sides.assign(p.n_owned() + 1, unknown_side);
        for (unsigned int node = 0; node < p.n_owned(); ++node)
          {
            all[k]->fluid.block(pressure_block).local_element(node) = pressures[width * node + 2 * k];
            if (counts.has_sides)
              all[k]->sides[node] = int(pressures[width * node + 2 * k + 1]);
          }
      }
    for (unsigned int node = 0; node < p.n_owned(); ++node)
      for (unsigned int m = 0; m < counts.n_viscous; ++m)
        if (const double *const place = &pressures[width * node + 2 * n + 5 * m]; place[0] >= 0.)
          viscous.at_vertices.push_back({node, static_cast<unsigned int>(place[0]), {{place[1], place[2], place[3], place[4]}}});
  }
} // namespace tanktread
