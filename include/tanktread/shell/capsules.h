// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the capsules of a scene, told by their numbers, and the kinds that they are of.

#ifndef tanktread_shell_capsules_h
#define tanktread_shell_capsules_h

#include <tanktread/shell/capsule.h>

#include <memory>
#include <vector>

namespace tanktread
{
  /** What each capsule of a scene is. Capsules are numbered from 0 and keep their number wherever they go; those of one kind share one object. */
  class Capsules
  {
  public:
    /** @param kind_of number of the kind of each capsule. Throws std::logic_error if there is no such kind. */
    Capsules(std::vector<std::unique_ptr<const Capsule>> kinds, std::vector<unsigned int> kind_of);

    /** How many capsules there are in the scene. */
    unsigned int
    size() const
    {
      return kind_of_.size();
    }
    /** The kind of capsule c. */
    const Capsule &
    operator[](const unsigned int c) const
    {
      return *kinds_[kind_of_[c]];
    }
    unsigned int
    kind_of(const unsigned int c) const
    {
      return kind_of_[c];
    }
    unsigned int
    n_kinds() const
    {
      return kinds_.size();
    }
    const Capsule &
    kind(const unsigned int k) const
    {
      return *kinds_[k];
    }
    /** Volume of all capsules together. */
    double
    volume() const;
    /** Control points of all capsules together. */
    std::size_t
    n_control_points() const;

  private:
    std::vector<std::unique_ptr<const Capsule>> kinds_;
    std::vector<unsigned int>                   kind_of_;
  };
} // namespace tanktread

#endif
