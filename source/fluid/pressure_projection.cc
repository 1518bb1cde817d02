// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the pressure that belongs to loads on the velocities.

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/pressure_projection.h>
#include <tanktread/fluid/stokes_operator.h>

#include <algorithm>

namespace tanktread
{
  PressureProjection::PressureProjection(const TaylorHoodSpace &space, Multigrid<float> &multigrid)
    : space_(space)
    , multigrid_(multigrid)
    , instructions_(best_instruction_set())
    , load_(space.velocity->full_size())
    , divergence_(space.pressure->full_size())
  {
    // The symbol of B D^{-1} B^T over that of L_p is between 2/3 and 0.951 with the sums of rows alone: 1.236 is one over the middle.
    constexpr double row_sum = 125. / 64., middle = 1.236;
    for (const double mass : mass_diagonal(*space.velocity))
      inverse_mass_.push_back(middle / (row_sum * mass));

    std::fill(divergence_.begin(), divergence_.end(), 0.f);
    const std::vector<float> ones(divergence_.size(), 1.f);
    add_pressure_mass(cubes(space), ones.data(), divergence_.data());
    space.pressure->collect(divergence_.data());
    for (std::size_t i = 0; i < space.pressure->n_owned(); ++i)
      integrals_.push_back(divergence_[i] / space.mesh.box().volume());
  }


  void
  PressureProjection::add(const FluidVector &r_u, const double shift, const float *const r_p, float *const p) const
  {
    const NodeSpace &u = *space_.velocity, &pressures = *space_.pressure;
    u.load(r_u, load_.data());
    for (std::size_t i = 0; i < u.n_owned(); ++i)
      for (unsigned int c = 0; c < 4; ++c)
        load_[4 * i + c] *= inverse_mass_[i];
    u.update(load_.data());
    std::fill(divergence_.begin(), divergence_.end(), 0.f);
    add_divergence(instructions_, cubes(space_), load_.data(), divergence_.data());
    pressures.collect(divergence_.data());

    float *const b = multigrid_.right_hand_side();
    for (std::size_t i = 0; i < pressures.n_owned(); ++i)
      {
        b[4 * i]     = float(shift) * r_p[i] - divergence_[i];
        b[4 * i + 1] = b[4 * i + 2] = b[4 * i + 3] = 0.f;
      }
    multigrid_.v_cycle();
    const float *const solution = multigrid_.solution();
    float              mean     = 0.f;
    for (std::size_t i = 0; i < pressures.n_owned(); ++i)
      mean += integrals_[i] * solution[4 * i];
    mean = dealii::Utilities::MPI::sum(mean, space_.mesh.communicator());
    for (std::size_t i = 0; i < pressures.n_owned(); ++i)
      p[i] += solution[4 * i] - mean;
  }
} // namespace tanktread
