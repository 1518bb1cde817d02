// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what belongs to capsules goes to the ranks that hold them from now on.

#include <deal.II/base/mpi.h>

#include <tanktread/simulation/capsule_moves.h>

#include <algorithm>
#include <map>
#include <utility>

namespace tanktread
{
  namespace
  {
    constexpr std::size_t n_numbers_of_sample = sizeof(MotionSample) / sizeof(double);
    static_assert(sizeof(MotionSample) == n_numbers_of_sample * sizeof(double), "A sample is numbers alone.");
  } // namespace


  std::vector<double>
  packed(const CapsuleMemory &memory)
  {
    const InertiaEllipsoid     &e     = memory.ellipsoid;
    const std::array<double, 4> phase = memory.phase.numbers();
    std::vector<double>         result(phase.begin(), phase.end());
    result.insert(result.end(), {e.L, e.B, e.W, e.taylor_parameter, e.inclination, e.centroid[0], e.centroid[1], e.centroid[2]});
    for (const MotionSample &sample : memory.motion)
      {
        const double *const numbers = &sample.time;
        result.insert(result.end(), numbers, numbers + n_numbers_of_sample);
      }
    return result;
  }


  CapsuleMemory
  unpacked(const std::vector<double> &numbers, const Capsule &capsule)
  {
    const double *next = numbers.data();
    CapsuleMemory result{PhaseAngles(capsule.topology(), {{next[0], next[1], next[2], next[3]}}), {}, {}};
    next += 4;
    result.ellipsoid = {next[0], next[1], next[2], next[3], next[4], Eigen::Vector3d(next[5], next[6], next[7])};
    for (next += 8; next < numbers.data() + numbers.size(); next += n_numbers_of_sample)
      {
        MotionSample sample{};
        std::copy_n(next, n_numbers_of_sample, &sample.time);
        result.motion.push_back(sample);
      }
    return result;
  }


  CapsuleMoves::CapsuleMoves(const ShellLayout &layout, std::vector<unsigned int> team_of)
    : layout_(layout)
    , team_of_(std::move(team_of))
    , own_(layout.own())
  {
    for (unsigned int c = 0; c < team_of_.size(); ++c)
      if (team_of_[c] == layout.team_of_rank(layout.rank()))
        to_come_.push_back(c);
  }


  std::vector<std::vector<double>>
  CapsuleMoves::moved(const std::vector<std::vector<double>> &of_own) const
  {
    std::map<unsigned int, std::vector<std::vector<double>>> sent; // for each rank, in the order of numbers
    std::map<unsigned int, std::vector<double>>              here;
    const unsigned int                                       team = layout_.team_of_rank(layout_.rank());
    for (unsigned int i = 0; i < own_.size(); ++i)
      if (const unsigned int next = team_of_[own_[i]]; next == team)
        here[own_[i]] = of_own[i];
      else if (layout_.leads())
        for (unsigned int rank = layout_.leader(next); rank < layout_.n_ranks() && layout_.team_of_rank(rank) == next; ++rank)
          {
            sent[rank].push_back({double(own_[i])});
            sent[rank].push_back(of_own[i]);
          }
    for (const auto &[rank, things] : dealii::Utilities::MPI::some_to_some(layout_.communicator(), sent))
      for (std::size_t k = 0; k < things.size(); k += 2)
        here[static_cast<unsigned int>(things[k][0])] = things[k + 1];
    std::vector<std::vector<double>> result;
    for (const unsigned int c : to_come_)
      result.push_back(std::move(here.at(c)));
    return result;
  }


  ShellFields
  CapsuleMoves::moved(const ShellFields &of_own) const
  {
    std::vector<std::vector<double>> numbers;
    for (const ControlPoints &field : of_own)
      numbers.emplace_back(field.data(), field.data() + field.size());
    ShellFields result;
    for (const std::vector<double> &field : moved(numbers))
      result.push_back(Eigen::Map<const ControlPoints>(field.data(), field.size() / 3, 3));
    return result;
  }


  std::vector<CapsuleState>
  CapsuleMoves::moved(const std::vector<CapsuleState> &of_own) const
  {
    std::vector<std::vector<double>> numbers;
    for (const CapsuleState &capsule : of_own)
      {
        numbers.push_back({capsule.pressure_jump, capsule.volume_shift});
        numbers.back().insert(numbers.back().end(), capsule.x.data(), capsule.x.data() + capsule.x.size());
        numbers.back().insert(numbers.back().end(), capsule.force.data(), capsule.force.data() + capsule.force.size());
      }
    std::vector<CapsuleState> result;
    for (const std::vector<double> &values : moved(numbers))
      {
        const Eigen::Index n = Eigen::Index(values.size() - 2) / 6;
        CapsuleState       capsule;
        capsule.pressure_jump = values[0];
        capsule.volume_shift  = values[1];
        capsule.x             = Eigen::Map<const ControlPoints>(&values[2], n, 3);
        capsule.force         = Eigen::Map<const ControlPoints>(&values[2 + 3 * n], n, 3);
        result.push_back(std::move(capsule));
      }
    return result;
  }


  std::vector<CapsuleMemory>
  CapsuleMoves::moved(const std::vector<CapsuleMemory> &of_own) const
  {
    std::vector<std::vector<double>> numbers;
    for (const CapsuleMemory &memory : of_own)
      numbers.push_back(packed(memory));
    const std::vector<std::vector<double>> of_next = moved(numbers);
    std::vector<CapsuleMemory>             result;
    for (std::size_t i = 0; i < of_next.size(); ++i)
      result.push_back(unpacked(of_next[i], layout_.capsules()[to_come_[i]]));
    return result;
  }
} // namespace tanktread
