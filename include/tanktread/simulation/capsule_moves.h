// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what belongs to capsules goes to the ranks that hold them from now on.

#ifndef tanktread_simulation_capsule_moves_h
#define tanktread_simulation_capsule_moves_h

#include <tanktread/coupling/shell_layout.h>
#include <tanktread/simulation/run_memory.h>

#include <vector>

namespace tanktread
{
  /** All that a capsule's memory consists of, and back; the latter for the same capsule. */
  std::vector<double>
  packed(const CapsuleMemory &memory);
  CapsuleMemory
  unpacked(const std::vector<double> &numbers, const Capsule &capsule);

  /** A change of teams: sends things that belong to capsules from the teams that hold them to those that will. All members but the constructor are collective. */
  class CapsuleMoves
  {
  public:
    /** To be made before ShellLayout::assign(). @param team_of the teams to come, by the capsules' numbers, the same on all ranks. Keeps `layout` by reference. */
    CapsuleMoves(const ShellLayout &layout, std::vector<unsigned int> team_of);

    const std::vector<unsigned int> &
    team_of() const
    {
      return team_of_;
    }

    // Each takes things of the capsules that the rank's team holds and returns those of the capsules that it will hold, in the order of their numbers.
    std::vector<std::vector<double>>
    moved(const std::vector<std::vector<double>> &of_own) const;
    ShellFields
    moved(const ShellFields &of_own) const;
    std::vector<CapsuleState>
    moved(const std::vector<CapsuleState> &of_own) const;
    std::vector<CapsuleMemory>
    moved(const std::vector<CapsuleMemory> &of_own) const;

  private:
    const ShellLayout              &layout_;
    const std::vector<unsigned int> team_of_;
    std::vector<unsigned int>       own_, to_come_; // numbers
  };
} // namespace tanktread

#endif
